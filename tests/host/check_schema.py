"""Checks Wale's JSON Schema with an independent validator.

    check_schema.py SCHEMA SCENES_FOLDER

Every *.json in the folder must be valid; each of the bad variations below must not be. Exits 1 with a line per fault.
"""
import copy
import json
import pathlib
import re
import sys

import jsonschema

schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
faults = []


def without_comments(text):
    # Comments in the bundled scenes stand alone on their lines.
    return re.sub(r"^\s*//.*$", "", text, flags=re.MULTILINE)


scenes = sorted(pathlib.Path(sys.argv[2]).glob("*.json"))
if not scenes:
    faults.append("no scenes found")
for path in scenes:
    for error in validator.iter_errors(json.loads(without_comments(path.read_text()))):
        faults.append(f"{path.name}: {list(error.absolute_path)}: {error.message[:200]}")

fabric = {"mesh": {"generator": "swatch"}, "pattern": {"builtin": "stockinette"}, "uv_metres": True}
good = {
    "wale": 1,
    "units": "mm",
    "camera": {"position": [0, 0, 1]},
    "materials": {"m": {"type": "ply", "color": "#ff0000"}},
    "fabrics": [fabric],
    "lights": [{"type": "environment", "radiance": 1}],
}
if not validator.is_valid(good):
    faults.append("the plain good scene is refused")

bad = {
    "no version": lambda s: s.pop("wale"),
    "unknown key": lambda s: s.update(kamera={}),
    "unknown nested key": lambda s: s["camera"].update(fovv=3),
    "orthographic fov": lambda s: s["camera"].update(type="orthographic", fov=3),
    "colour above 1": lambda s: s["materials"]["m"].update(color=[2, 0, 0]),
    "hex colour": lambda s: s["materials"]["m"].update(color="#ff00"),
    "no scale": lambda s: s["fabrics"][0].pop("uv_metres"),
    "two scales": lambda s: s["fabrics"][0].update(repeats=[1, 1]),
    "false uv_metres": lambda s: s["fabrics"][0].update(uv_metres=False),
    "plies": lambda s: s["fabrics"][0].update(yarn={"plies": 9}),
    "twist": lambda s: s["fabrics"][0].update(yarn={"twist_pitch": 1}),
    "generator": lambda s: s["fabrics"][0].update(mesh={"generator": "cube"}),
    "file and radiance": lambda s: s["lights"][0].update(file="a.exr"),
    "lanes": lambda s: s.update(integrator={"lanes": 3}),
    "film size": lambda s: s.update(film={"size": [0, 1]}),
}
for name, change in bad.items():
    scene = copy.deepcopy(good)
    change(scene)
    if validator.is_valid(scene):
        faults.append(f"accepted: {name}")

print("\n".join(faults))
sys.exit(1 if faults else 0)
