#!/usr/bin/env python3
"""sheet.py WALE FOLDER/SCENE.json OUT.jpg --seconds S: one picture per renderer, each with S processor seconds of
samples.

The samples follow from the times that measure.py kept; start, loading and building come on top. --names chooses."""
import argparse
import json
import os
import subprocess
import tempfile

import numpy as np
from PIL import Image, ImageDraw

from picture_files import load
from renderers import environment, peer_command, wale_command
from report import figures


def eight_bit(picture):
    upper = 1.055 * np.maximum(picture, 0.0031308) ** (1 / 2.4) - 0.055
    encoded = np.where(picture <= 0.0031308, 12.92 * picture, upper)
    return (255 * np.clip(encoded, 0, 1) + 0.5).astype(np.uint8)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wale")
    parser.add_argument("measured")
    parser.add_argument("out")
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--data", default="out/pictures")
    parser.add_argument("--names", default="wale,mitsuba llvm,cycles,luxcore")
    args = parser.parse_args()
    with open(args.measured, encoding="utf-8") as file:
        data = json.load(file)
    tiles = []
    with tempfile.TemporaryDirectory() as folder:
        for name in args.names.split(","):
            path_seconds = figures(data, data["rows"][name])["render"] / (data["size"] ** 2 * data["spp"])
            spp = max(1, round(args.seconds / path_seconds / args.size**2))
            out = os.path.join(folder, "picture" + (".exr" if name == "wale" else ".npy"))
            command = (wale_command(args.wale, data["scene"], out, args.size, spp, 1, data["depth"], args.data)
                       if name == "wale" else
                       peer_command(name, data["scene"], out, args.size, spp, 1, data["depth"], args.data))
            subprocess.run(command, check=True, env=environment(name), capture_output=True)
            tile = Image.fromarray(eight_bit(load(out)))
            canvas = Image.new("RGB", (args.size, args.size + 16), "white")
            canvas.paste(tile, (0, 16))
            ImageDraw.Draw(canvas).text((4, 2), f"{name}, {spp} samples", fill="black")
            tiles.append(np.asarray(canvas))
            print(name, spp, "samples", flush=True)
    Image.fromarray(np.concatenate(tiles, axis=1)).save(args.out, quality=88)


if __name__ == "__main__":
    main()
