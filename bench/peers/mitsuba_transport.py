#!/usr/bin/env python3
"""Renders a scene file of Wale without fabric in Mitsuba 3 and compares it with Wale's picture.

    python3 -m venv peer && peer/bin/pip install mitsuba numpy
    wale render scenes/check/transport.json -o out/transport.exr
    peer/bin/python bench/peers/mitsuba_transport.py scenes/check/transport.json out/transport.exr

Prints the mean radiance of both pictures per channel, and over a 4 x 4 grid of blocks the largest relative difference
with its standard error. Fails when a mean differs by more than --limit. Only diffuse materials, spheres, a ground,
sphere, quad and environment lights are known here; lengths are metres.
"""
import argparse
import json
import math
import os
import re
import sys

import mitsuba as mi
import numpy as np

DEFAULT_GREY = [0.5, 0.5, 0.5]


def read_scene(path):
    """A scene file is JSON with // comments."""
    with open(path, encoding="utf-8") as file:
        return json.loads(re.sub(r"^\s*//.*$", "", file.read(), flags=re.M))


def rgb(value):
    value = [value] * 3 if isinstance(value, (int, float)) else value
    return {"type": "rgb", "value": value}


def to_world(at, forward, up, half_u, half_v):
    """Mitsuba's rectangle spans [-1, 1]^2 and faces +z: bring +z to `forward`."""
    t = mi.ScalarTransform4f
    target = [a + f for a, f in zip(at, forward)]
    return t().look_at(origin=at, target=target, up=up) @ t().scale([half_u, half_v, 1])


def diffuse(scene, name):
    color = scene.get("materials", {}).get(name, {}).get("color", DEFAULT_GREY)
    return {"type": "diffuse", "reflectance": rgb(color)}


def object_shape(scene, item):
    bsdf = {"type": "twosided", "bsdf": diffuse(scene, item.get("material"))}
    if item["type"] == "sphere":
        return {"type": "sphere", "center": item["center"], "radius": item["radius"], "bsdf": bsdf}
    if item["type"] == "ground":
        up = np.array(item.get("up", [0, 1, 0]), float)
        up /= np.linalg.norm(up)
        side = [1, 0, 0] if abs(up[0]) < 0.9 else [0, 1, 0]
        extent = item.get("extent", 10)
        return {"type": "rectangle", "bsdf": bsdf,
                "to_world": to_world(list(up * item.get("height", 0)), list(up), side, extent, extent)}
    sys.exit(f"objects of type {item['type']} are not compared here")


def light_shape(item):
    radiance = rgb(item.get("radiance", 1))
    if item["type"] == "environment" and "file" not in item:
        return {"type": "constant", "radiance": radiance}
    emitter = {"type": "area", "radiance": radiance}
    black = {"type": "diffuse", "reflectance": rgb(0.0)}
    if item["type"] == "sphere":
        return {"type": "sphere", "center": item["position"], "radius": item["radius"], "emitter": emitter, "bsdf": black}
    if item["type"] == "quad":
        at, look = item["position"], item.get("look_at", [0, 0, 0])
        return {"type": "rectangle", "emitter": emitter, "bsdf": black,
                "to_world": to_world(at, [b - a for a, b in zip(at, look)], item.get("up", [0, 1, 0]),
                                     item.get("width", 1) / 2, item.get("height", 1) / 2)}
    sys.exit(f"lights of type {item['type']} are not compared here")


def mitsuba_scene(scene, spp):
    camera, film = scene["camera"], scene["film"]
    out = {
        "type": "scene",
        # -1: no limit of depth, as Wale's 0; Russian roulette does not change the mean.
        "integrator": {"type": "path", "max_depth": -1, "rr_depth": 8},
        "sensor": {
            "type": "perspective", "fov": camera.get("fov", 35), "fov_axis": "y",
            "to_world": mi.ScalarTransform4f().look_at(origin=camera["position"], target=camera["look_at"],
                                                       up=camera["up"]),
            "film": {"type": "hdrfilm", "width": film["size"][0], "height": film["size"][1],
                     "rfilter": {"type": "box"}, "pixel_format": "rgb", "component_format": "float32"},
            "sampler": {"type": "independent", "sample_count": spp},
        },
    }
    for i, item in enumerate(scene.get("objects", [])):
        out[f"object{i}"] = object_shape(scene, item)
    for i, item in enumerate(scene["lights"]):
        out[f"light{i}"] = light_shape(item)
    return out


def blocks(picture, n=4):
    h, w = picture.shape[0] // n * n, picture.shape[1] // n * n
    return picture[:h, :w].reshape(n, h // n, n, w // n, 3).mean(axis=(1, 3))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("picture", help="Wale's EXR of the scene")
    parser.add_argument("--spp", type=int, default=1024)
    parser.add_argument("--limit", type=float, default=0.005, help="largest relative difference of a mean")
    args = parser.parse_args()
    mi.set_variant(os.environ.get("MITSUBA_VARIANT", "scalar_rgb"))

    wale = mi.Bitmap(args.picture)
    channels = {wale.struct_()[i].name: i for i in range(len(wale.struct_()))}
    wale = np.array(wale)[:, :, [channels[c] for c in "RGB"]].astype(float)

    scene = mi.load_dict(mitsuba_scene(read_scene(args.scene), args.spp))
    # Independent runs give the noise of the peer.
    runs = 4
    peers = [np.array(mi.render(scene, spp=args.spp // runs, seed=1 + i)).astype(float) for i in range(runs)]
    peer = np.mean(peers, axis=0)
    if peer.shape != wale.shape:
        sys.exit(f"{args.picture}: {wale.shape} against {peer.shape}")

    worst = 0.0
    print(f"mitsuba {mi.__version__} ({mi.variant()}), {args.spp} spp, {wale.shape[1]} x {wale.shape[0]}")
    for c, name in enumerate("RGB"):
        a, b = wale[:, :, c].mean(), peer[:, :, c].mean()
        error = np.std([p[:, :, c].mean() for p in peers], ddof=1) / math.sqrt(runs)
        worst = max(worst, abs(a / b - 1))
        print(f"mean {name}   wale {a:.6f}   mitsuba {b:.6f} +- {error:.6f}   difference {100 * (a / b - 1):+.3f} %")
    relative = blocks(wale) / blocks(peer) - 1
    noise = np.std([blocks(p) for p in peers], axis=0, ddof=1) / math.sqrt(runs) / blocks(peer)
    at = np.unravel_index(np.abs(relative).argmax(), relative.shape)
    print(f"largest difference of a block of 4 x 4: {100 * relative[at]:+.3f} % +- {100 * noise[at]:.3f} %, "
          f"block ({at[1]}, {at[0]}), {'RGB'[at[2]]}")
    if worst > args.limit:
        sys.exit(f"the means differ by {100 * worst:.3f} %, more than {100 * args.limit:.3f} %")


if __name__ == "__main__":
    main()
