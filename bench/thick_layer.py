#!/usr/bin/env python3
"""What a thick stack of stockinette shows of the colour asked for (docs/appearance.md, artists' parameters).

    python3 bench/thick_layer.py OUT [--wale build/wale] [--layers 24] [--spp 64]

The stack lies in an environment of radiance 1, on a black ground and, once more, on nothing (white behind): its
reflectance in diffuse light lies between the two pictures' means. Needs oiiotool.
"""
import argparse
import json
import os
import re
import subprocess


def mean(args, name, preset, colour, ground):
    layers = [{"name": f"layer{i}", "mesh": {"generator": "swatch", "width": 24, "height": 24, "nu": 4, "nv": 4},
               "transform": {"translate": [0.7 * i, 0.4 * i, -1.1 * i]}, "pattern": {"builtin": "stockinette"},
               "gauge": {"wales": 40}, "material": "yarn", "detail": "none"} for i in range(args.layers)]
    scene = {"wale": 1, "units": "mm",
             "camera": {"type": "orthographic", "position": [0, 0, 100], "look_at": [0, 0, 0], "up": [0, 1, 0], "height": 4.296},
             "film": {"size": [28, 24], "filter": "box"},
             "materials": {"yarn": {"type": "ply", "preset": preset, "color": colour},
                           "black": {"type": "diffuse", "color": [0, 0, 0]}},
             "fabrics": layers, "lights": [{"type": "environment", "radiance": 1}]}
    if ground:
        scene["objects"] = [{"type": "ground", "up": [0, 0, 1], "height": -1.1 * args.layers - 1, "extent": 30, "material": "black"}]
    file = os.path.join(args.out, name)
    with open(file + ".json", "w", encoding="utf-8") as out:
        json.dump(scene, out)
    subprocess.run([args.wale, "render", file + ".json", "-o", file + ".exr", "--spp", str(args.spp), "--quiet"], check=True)
    text = subprocess.run(["oiiotool", "--stats", file + ".exr"], check=True, capture_output=True, text=True).stdout
    return [float(v) for v in re.search(r"Stats Avg: (.*?)\(", text).group(1).split()[:3]]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("out")
    parser.add_argument("--wale", default="build/wale")
    parser.add_argument("--layers", type=int, default=24)
    parser.add_argument("--spp", type=int, default=64)
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    for preset in ("wool", "cotton", "silk"):
        for number, colour in enumerate(([0.05, 0.2, 0.5], [0.8, 0.95, 0.5])):
            low, high = (mean(args, f"{preset}_{number}_{g}", preset, colour, g) for g in (True, False))
            print(preset, "asked", colour, "on black", [round(v, 3) for v in low], "white behind", [round(v, 3) for v in high], flush=True)


if __name__ == "__main__":
    main()
