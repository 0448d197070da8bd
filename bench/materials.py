#!/usr/bin/env python3
"""A sheet of materials: close-up (one stitch), middle and far, each lit from the front and from behind.

    pip install pillow
    python3 bench/materials.py OUT [--wale build/wale] [--spp 64] [--pixels 256] [--detail maps]
"""
import argparse
import json
import os
import subprocess

from PIL import Image

COLOURS = {"wool": [0.62, 0.20, 0.16], "cotton": [0.82, 0.80, 0.74], "silk": [0.25, 0.35, 0.62], "polyester": [0.30, 0.60, 0.42]}
VIEWS = {"stitch": 2.6, "middle": 14, "far": 80}


def scene(preset, height, front, detail):
    z = 1 if front else -1
    size = max(12.0, 1.3 * height)
    return {
        "wale": 1, "units": "mm",
        "camera": {"type": "orthographic", "position": [0, 0, 300], "look_at": [0.3, 0.2, 0], "up": [0, 1, 0], "height": height},
        "film": {"size": [256, 256]},
        "materials": {"yarn": {"type": "ply", "preset": preset, "color": COLOURS[preset]}},
        "fabrics": [{"mesh": {"generator": "swatch", "width": size, "height": size, "nu": 4, "nv": 4},
                     "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 40},
                     "yarn": {"plies": 3, "twist_pitch": 8, "thickness": 1.1}, "material": "yarn", "detail": detail}],
        "lights": [{"type": "quad", "position": [-160, 200, 260 * z], "look_at": [0, 0, 0], "width": 120, "height": 120,
                    "radiance": 14},
                   {"type": "environment", "radiance": 0.15 if front else 0.05}],
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("out")
    parser.add_argument("--wale", default="build/wale")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--pixels", type=int, default=256)
    parser.add_argument("--detail", default="maps")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    n = args.pixels
    sheet = Image.new("RGB", (n * 2 * len(VIEWS), n * len(COLOURS)))
    for row, preset in enumerate(COLOURS):
        for column, (view, height) in enumerate(VIEWS.items()):
            for side, front in enumerate((True, False)):
                name = os.path.join(args.out, f"{preset}_{view}_{'front' if front else 'back'}")
                with open(name + ".json", "w", encoding="utf-8") as file:
                    json.dump(scene(preset, height, front, args.detail), file)
                subprocess.run([args.wale, "render", name + ".json", "-o", name + ".png", "--spp", str(args.spp), "--quiet",
                                "--set", f"film.size=[{n},{n}]"], check=True)
                sheet.paste(Image.open(name + ".png"), (n * (2 * column + side), n * row))
    sheet.save(os.path.join(args.out, "materials.png"))


if __name__ == "__main__":
    main()
