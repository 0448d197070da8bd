#!/usr/bin/env python3
"""Loads ply curves that Wale exported into Mitsuba 3 and renders them, by hand.

    wale export scenes/swatch_front.json -o out/swatch.txt
    peer/bin/python bench/peers/mitsuba_curves.py out/swatch.txt out/swatch.png

Says how many curves, points and segments the file and Mitsuba have, compares the bounds, and writes a picture of the
swatch from the front (+z, y up). Fails when the counts or bounds differ or the picture is empty.
"""
import os
import sys

import mitsuba as mi
import numpy as np


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    curves, picture = sys.argv[1:]
    mi.set_variant(os.environ.get("MITSUBA_VARIANT", "scalar_rgb"))
    with open(curves, encoding="utf-8") as file:
        groups = [np.loadtxt(block.splitlines(), ndmin=2) for block in file.read().split("\n\n") if block.strip()]
    points = np.concatenate(groups)
    segments = len(points) - len(groups)

    shape = mi.load_dict({"type": "linearcurve", "filename": os.path.abspath(curves),
                          "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.8, 0.4, 0.2]}}})
    box = shape.bbox()
    print(f"file: {len(groups)} curves, {len(points)} points, {segments} segments; "
          f"mitsuba: {shape.primitive_count()} segments")
    lo, hi = (points[:, :3] - points[:, 3:]).min(axis=0), (points[:, :3] + points[:, 3:]).max(axis=0)
    print("bounds (mm): file", np.round(1e3 * lo, 3), np.round(1e3 * hi, 3), "mitsuba",
          np.round(1e3 * np.array(box.min).ravel(), 3), np.round(1e3 * np.array(box.max).ravel(), 3))
    slack = 2 * points[:, 3].max()  # Mitsuba's bounds of a curve are conservative
    inside = (np.array(box.min).ravel() <= lo + 1e-6).all() and (np.array(box.max).ravel() >= hi - 1e-6).all()
    tight = np.abs(np.array(box.min).ravel() - lo).max() < slack and np.abs(np.array(box.max).ravel() - hi).max() < slack

    centre = (lo + hi) / 2
    scene = mi.load_dict({
        "type": "scene", "integrator": {"type": "path", "max_depth": 6}, "curves": shape,
        "light": {"type": "directional", "direction": [0.5, -0.5, -1], "irradiance": {"type": "rgb", "value": 2}},
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": 0.2}},
        "sensor": {"type": "perspective", "fov": 30,
                   "to_world": mi.ScalarTransform4f().look_at(
                       origin=list(centre + [0, 0, 2 * (hi - lo).max()]), target=list(centre), up=[0, 1, 0]),
                   "film": {"type": "hdrfilm", "width": 256, "height": 256, "pixel_format": "rgb"},
                   "sampler": {"type": "independent", "sample_count": 16}}})
    image = mi.render(scene)
    mi.util.write_bitmap(picture, image)
    values = np.array(image)
    cloth = np.abs(values - 0.2).max(axis=2) > 1e-3
    print(f"picture: mean {values.mean(axis=(0, 1))}, {100 * cloth.mean():.1f} % of the pixels show cloth")
    if shape.primitive_count() != segments or not (inside and tight) or not np.isfinite(values).all() or not cloth.any():
        sys.exit("Mitsuba does not see the curves that the file holds")


if __name__ == "__main__":
    main()
