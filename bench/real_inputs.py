#!/usr/bin/env python3
"""Renders the real inputs named in bench/results/real_inputs.md: a knitted sock and a cow, measured tiles, a photographed
sky. Usage: WALE_REAL_DATA=folder bench/real_inputs.py OUT_FOLDER [--spp N] [--size WxH] [NAME ...]"""
import argparse
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def scene(data, mesh, tile, camera, light, scale, color, plies=3):
    tiles = data / "yarn-patterns" / "madypg"
    lights = {
        "venice": [{"type": "environment", "file": str(data / "envmaps/pmndrs/venice.exr"), "up": [0, 1, 0]}],
        # A small area light as in a photograph: in front (beside the camera) or behind the cloth.
        "front": [{"type": "quad", "position": camera["front"], "look_at": camera["look_at"], "width": 0.08,
                   "height": 0.08, "radiance": 400}],
        "back": [{"type": "quad", "position": camera["back"], "look_at": camera["look_at"], "width": 0.08,
                  "height": 0.08, "radiance": 600}],
    }[light]
    return {
        "wale": 1,
        "camera": {"position": camera["position"], "look_at": camera["look_at"], "up": [0, 1, 0], "fov": camera["fov"]},
        "film": {"size": [768, 768], "exposure": camera.get("exposure", 0)},
        "materials": {"yarn": {"type": "ply", "preset": "wool", "color": color}},
        "fabrics": [{"name": "cloth", "mesh": {"file": str(data / mesh)}, "pattern": {"file": str(tiles / tile)},
                     "yarn": {"plies": plies}, "material": "yarn", **scale}],
        "lights": lights,
    }


def scenes(data):
    sock = {"position": [-0.146, -0.05, 0.75], "look_at": [-0.146, -0.112, -0.017], "fov": 23,
            "front": [-0.45, 0.25, 0.6], "back": [0.25, 0.2, -0.55]}
    spot = {"position": [-2.4, 1.2, -3.0], "look_at": [0, 0.1, 0.1], "fov": 32, "front": [-3, 3, -2.5],
            "back": [2, 1, 3]}
    fine = {"gauge": {"wales": 50}}
    out = {}
    for tile, color in (("cartridge_belt_rib", [0.97, 0.93, 0.85]), ("stockinette", [0.90, 0.93, 0.97])):
        for light in ("venice", "front", "back"):
            out[f"sock_{tile}_{light}"] = scene(data, "meshes/madypg/sock_cloth.obj", tile + ".pyp", sock, light, fine, color)
    out["spot_venice"] = scene(data, "meshes/spot/spot_triangulated.obj", "stockinette.pyp", spot, "venice",
                               {"repeats": [40, 80]}, [0.97, 0.90, 0.80])
    return out


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("names", nargs="*")
    parser.add_argument("--spp", default="64")
    parser.add_argument("--size", default="768x768")
    args = parser.parse_args()
    data = os.environ.get("WALE_REAL_DATA")
    if not data:
        sys.exit("WALE_REAL_DATA is not set: it names the folder of real inputs")
    folder = pathlib.Path(args.folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, description in scenes(pathlib.Path(data)).items():
        if args.names and name not in args.names:
            continue
        file = folder / f"{name}.json"
        file.write_text(json.dumps(description, indent=1))
        subprocess.run([str(ROOT / "wale"), "render", str(file), "-o", str(folder / f"{name}.png"), "--spp", args.spp,
                        "--size", args.size, "--stats", str(folder / f"{name}.stats.json")], check=True)


main()
