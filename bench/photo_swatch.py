#!/usr/bin/env python3
"""Puts a rendered stockinette beside the photograph of a machine-knit swatch and compares their stitches.

    pip install numpy pillow
    WALE_REAL_DATA=... python3 bench/photo_swatch.py OUT [--wale build/wale] [--spp 64]

The photograph (photos/neural-inverse-knitting, MIT) shows 20 x 20 stitches in 160 x 160 pixels; its program says where
they are plain purls (left border) and plain knits (lower right). Both sides of a swatch are rendered at the same scale in
the photograph's mean colour. Printed for linear luminance: contrast (standard deviation over mean, slow gradients taken
out), and the share of the spectrum's power at the stitches' own frequencies, 1/8 per pixel across, down and both.
"""
import argparse
import json
import os
import subprocess
import sys

import numpy as np
from PIL import Image, ImageFilter

STITCH = 8  # pixels
REGIONS = {"purl": (8, 152, 0, 24), "knit": (112, 160, 96, 160)}  # y0, y1, x0, x1


def linear(path, blur=0.0):
    image = Image.open(path).convert("RGB")
    if blur:
        image = image.filter(ImageFilter.GaussianBlur(blur))
    a = np.asarray(image).astype(float) / 255
    return np.where(a <= 0.04045, a / 12.92, ((a + 0.055) / 1.055) ** 2.4)


def luminance(rgb):
    return rgb @ np.array([0.2126, 0.7152, 0.0722])


def stitches(y):
    """Contrast, and the share of power at (1,0), (0,1) and (1,1) stitch frequencies."""
    y = y / y.mean() - 1
    f = np.fft.fft2(y * np.outer(np.hanning(y.shape[0]), np.hanning(y.shape[1])))
    power = np.abs(f) ** 2
    fy, fx = np.abs(np.fft.fftfreq(y.shape[0])), np.abs(np.fft.fftfreq(y.shape[1]))
    fy, fx = np.meshgrid(fy, fx, indexing="ij")
    slow = np.hypot(fx, fy) < 0.06
    kept = np.where(slow, 0, power)
    width = [1.6 / n for n in y.shape]
    share = {}
    for name, (kx, ky) in {"across": (1, 0), "down": (0, 1), "both": (1, 1), "across 2": (2, 0), "down 2": (0, 2)}.items():
        near = (np.abs(fx - kx / STITCH) < width[1]) & (np.abs(fy - ky / STITCH) < width[0])
        share[name] = kept[near].sum() / kept.sum()
    window = np.outer(np.hanning(y.shape[0]), np.hanning(y.shape[1])) ** 2
    return np.sqrt(kept.sum() / y.size / window.sum()), share


def scene(side, colour):
    z = 300 if side == "knit" else -300
    return {
        "wale": 1, "units": "mm",
        "camera": {"type": "orthographic", "position": [0, 0, z], "look_at": [0, 0, 0], "up": [0, 1, 0], "height": 50},
        "film": {"size": [160, 160], "view": "srgb", "filter": "tent"},
        "materials": {"yarn": {"type": "ply", "preset": "acrylic", "color": colour},
                      "ground": {"type": "diffuse", "color": [0.05, 0.03, 0.03]}},
        "fabrics": [{"mesh": {"generator": "swatch", "width": 60, "height": 60, "nu": 4, "nv": 4},
                     "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 40, "courses": 40},
                     "yarn": {"plies": 3, "thickness": 1.25}, "material": "yarn"}],
        "objects": [{"type": "ground", "up": [0, 0, 1 if z > 0 else -1], "height": -1.5, "extent": 500,
                     "material": "ground"}],
        "lights": [{"type": "quad", "position": [-150, 250, z], "look_at": [0, 0, 0], "width": 200, "height": 200,
                    "radiance": 10},
                   {"type": "environment", "radiance": 0.9}],
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("out")
    parser.add_argument("--wale", default="build/wale")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--blur", type=float, default=0.8, help="of the render, pixels: the photograph is not sharp")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    folder = os.path.join(os.environ["WALE_REAL_DATA"], "photos", "neural-inverse-knitting")
    photo_file = os.path.join(folder, "Cable2_046_16_0_back.jpg")
    photo = linear(photo_file)
    # One layer is not the thick layer whose colour the material names: its light passes each fibre less often.
    colour = [round(float(c) ** 1.4 * 1.25, 3) for c in np.quantile(photo.reshape(-1, 3), 0.75, axis=0)]
    tiles = [Image.open(photo_file).convert("RGB")]
    print(f"{'':24}contrast  across  down   both   across 2  down 2")
    for side, (y0, y1, x0, x1) in REGIONS.items():
        name = os.path.join(args.out, side)
        with open(name + ".json", "w", encoding="utf-8") as file:
            json.dump(scene(side, colour), file)
        subprocess.run([args.wale, "render", name + ".json", "-o", name + ".png", "--spp", str(args.spp), "--quiet"], check=True)
        tiles.append(Image.open(name + ".png").convert("RGB"))
        for label, rgb in (("photograph", photo), ("render", linear(name + ".png", args.blur))):
            contrast, share = stitches(luminance(rgb)[y0:y1, x0:x1])
            print(f"{side:6}{label:18}{contrast:8.3f}  " + "  ".join(f"{v:6.3f}" for v in share.values()))
        if side == "knit":
            print("mean colour of the photograph", photo.mean((0, 1)).round(3), "of the render", linear(name + ".png").mean((0, 1)).round(3))
    sheet = Image.new("RGB", (3 * 480, 480))
    for i, tile in enumerate(tiles):
        sheet.paste(tile.resize((480, 480), Image.NEAREST), (480 * i, 0))
    sheet.save(os.path.join(args.out, "beside.png"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
