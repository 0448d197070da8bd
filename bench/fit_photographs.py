#!/usr/bin/env python3
"""Fits materials to real photographs of woven cloth and judges them on parts that the fit has not seen.

    python3 bench/fit_photographs.py WALE DATA OUT [cloth ...] [--vgg]

WALE: the program. DATA: a folder with photos/fabric-btdf (pairs NAME_R.png and NAME_T.png of FabricBTDF-Recovery,
Tang et al. 2024), yarn-patterns/madypg/satin.pyp and vgg16. OUT: a folder for scenes, materials, reports and
pictures; none of them is kept in the repository, as the photographs' licence would go with them. Needs NumPy and Pillow.

The set-up, in units of 10 mm: camera at (0,0,8) over the plane, 53 degrees across; small lamps at (0,8,8) in front and
(0,0,-9) behind, equally strong. A part of the photograph is what the same camera sees when it is turned to look at the part's
middle: the four corners of its film, followed to the plane, are the --corners. The weave is a stand-in: a satin tile, its
threads as many a millimetre as peaks in the photograph's spectrum say, its floats across the picture, as the upright streak of
satin1's highlight wants; one thick ply a thread closes the tile's gaps, which the cloths have not. So windows are compared, not
pixels. Nobody had a grey card: the lamps' strength is fitted too (exposure).
"""
import json
import math
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from PIL import Image

SIZE, FOV, HEIGHT, MM = 512, math.radians(53), 8.0, 10.0
PART, HALF_FOV = 144, math.radians(8.2)  # pixels rendered of a part; half the angle that the turned camera sees
# Millimetres a thread across and along the photograph. (Through the gaps of basket.pyp, the other woven tile, comes ten times the
# red light that twill4's saturated green lets through.)
CLOTHS = {"satin1": (0.245, 0.36), "twill1": (0.207, 0.443), "twill4": (0.51, 0.243)}
TILE, THREADS = "satin.pyp", 5
# The fit sees the upper part, the lower one judges it. Left and right would not do: under one lamp in the middle satin1's right
# part is 1.3 times as bright as its left one, twill4's 0.8 times, and no parameter here makes that.
PARTS = {"fitted": (-2.0, 1.2), "unseen": (-2.0, -1.2)}


def turned(target):
    """Axes of a camera at (0,0,HEIGHT) that looks at a point of the plane, +y up."""
    f = np.array([target[0], target[1], -HEIGHT])
    f /= np.linalg.norm(f)
    r = np.cross(f, [0, 1, 0])
    r /= np.linalg.norm(r)
    return f, r, np.cross(r, f)


def corners(target):
    """Where the turned camera's film corners lie in the photograph, pixels."""
    f, r, u = turned(target)
    t, out = math.tan(HALF_FOV), []
    for x, y in ((-1, 1), (1, 1), (1, -1), (-1, -1)):
        d = f + t * (x * r + y * u)
        p = d * (HEIGHT / -d[2])
        scale = SIZE / 2 / (HEIGHT * math.tan(FOV / 2))
        out += [SIZE / 2 + p[0] * scale, SIZE / 2 - p[1] * scale]
    return out


def scene(data, cloth, target):
    reach = 2 * math.tan(HALF_FOV) * HEIGHT * MM * 1.5 + 6
    lamp = {"type": "sphere", "radius": 2, "radiance": 4526}
    return {
        "wale": 1, "units": "mm",
        "camera": {"position": [0, 0, HEIGHT * MM], "look_at": [target[0] * MM, target[1] * MM, 0], "up": [0, 1, 0],
                   "fov": 2 * math.degrees(HALF_FOV)},
        "film": {"size": [PART, PART], "filter": "box", "view": "srgb"},
        "materials": {"yarn": {"type": "ply", "preset": "cotton", "reflect": [0.5, 0.5, 0.5], "transmit": [0.5, 0.5, 0.5]}},
        "fabrics": [{"name": "cloth", "mesh": {"generator": "swatch", "width": reach, "height": reach, "nu": 8, "nv": 8},
                     "transform": {"rotate": [0, 0, 90], "translate": [target[0] * MM, target[1] * MM, 0]},
                     "pattern": str((data / "yarn-patterns/madypg" / TILE).resolve()),
                     "repeats": [1000 / (THREADS * p) for p in reversed(CLOTHS[cloth])], "yarn": {"plies": 1, "twist_pitch": 8, "thickness": 1.4}, "material": "yarn"}],
        "lights": [dict(lamp, name="front", position=[0, 80, 80]), dict(lamp, name="back", position=[0, 0, -90])]}


def linear(picture):
    return np.where(picture <= 0.04045, picture / 12.92, ((picture + 0.055) / 1.055) ** 2.4)


def rectified(file, target):
    """The photograph's part, linear, by sampling four by four points a pixel."""
    photo = linear(np.asarray(Image.open(file).convert("RGB"), float) / 255)
    f, r, u = turned(target)
    n = PART * 4
    a = (np.arange(n) + 0.5) / n * 2 - 1
    x, y = np.meshgrid(a, -a)
    d = f + math.tan(HALF_FOV) * (x[..., None] * r + y[..., None] * u)
    p = d * (HEIGHT / -d[..., 2:])
    scale = SIZE / 2 / (HEIGHT * math.tan(FOV / 2))
    i = np.clip((SIZE / 2 - p[..., 1] * scale).astype(int), 0, SIZE - 1)
    j = np.clip((SIZE / 2 + p[..., 0] * scale).astype(int), 0, SIZE - 1)
    return photo[i, j].reshape(PART, 4, PART, 4, 3).mean((1, 3))


def bands(picture):
    """Standard deviation of luminance over its mean, in octaves of frequency from 2 cycles a picture on."""
    y = picture @ [0.2126, 0.7152, 0.0722]
    y = y / y.mean() - 1
    window = np.hanning(len(y))[:, None] * np.hanning(len(y))
    power = np.abs(np.fft.fft2(y * window)) ** 2 / len(y) ** 2 / (window ** 2).sum()
    f = np.hypot(np.fft.fftfreq(len(y))[:, None], np.fft.fftfreq(len(y)))
    edges = [2 / len(y) * 2 ** k for k in range(9)]
    return [math.sqrt(power[(f >= lo) & (f < hi)].sum()) for lo, hi in zip(edges, edges[1:]) if lo < 0.5]


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(str(w) for w in words)}\n{done.stdout}{done.stderr}")
    return done.stdout


def fit(wale, data, out, cloth, weights):
    photos = data / "photos/fabric-btdf"
    # Statistics of windows see the noise of a render as contrast of the cloth: samples enough that it is little.
    name = f"{cloth}_{'vgg' if weights else 'plain'}"
    where = out / f"{cloth}_fitted.json"
    material = out / f"{name}.json"
    words = [wale, "fit", where, "--front", photos / f"{cloth}_R.png", "--back", photos / f"{cloth}_T.png", "--corners",
             ",".join(f"{c:.2f}" for c in corners(PARTS["fitted"])), "--resolution", 1, "--unaligned", "--redo", "--parameters",
             "transmit,reflect,roughness,optical_radius,exposure", "--spp", 16, "--final-spp", 384, "--starts", 1, "-o", material,
             "--report", out / f"{name}.html", "--progress", out / f"{name}_progress.png"]
    # The stand-in's contrast is not the cloth's: colours go first.
    terms = "low-pass=100,color=1,spectrum=0.3,"
    words += ["--loss", terms + ("feature=0.1" if weights else "gradient=0.1")]
    if weights:
        words += ["--weights", data / "vgg16/vgg16_imagenet_block1_block2.npz"]
    begun = time.time()
    said = run(*words)
    exposure = float(next(l for l in said.splitlines() if l.startswith("exposure ")).split()[1])
    return material, exposure, time.time() - begun, said


def picture(wale, out, cloth, part, material, exposure, side):
    other = "back" if side == "front" else "front"
    file = out / f"{material.stem}_{part}_{side}.png"
    # A material's file takes the place of the scene's own.
    made = json.loads(material.read_text())
    # 8 bits hold what the photograph holds; brighter ones are cut alike.
    run(wale, "render", out / f"{cloth}_{part}.json", "-o", file, "--quiet", "--spp", 64, "--set",
        f"materials.yarn={json.dumps(made)}", "--set", f"film.exposure={exposure}", "--set", f"lights.{other}.radiance=0")
    return linear(np.asarray(Image.open(file).convert("RGB"), float) / 255)


def main():
    wale, data, out = Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3])
    out.mkdir(parents=True, exist_ok=True)
    print("| cloth | loss | part | lit from | mean colour, render over photograph | contrast by octaves: photograph | render |")
    print("|---|---|---|---|---|---|---|")
    for cloth in [a for a in sys.argv[4:] if not a.startswith("-")] or CLOTHS:
        for part, target in PARTS.items():
            (out / f"{cloth}_{part}.json").write_text(json.dumps(scene(data, cloth, target), indent=1))
        weights = "--vgg" in sys.argv
        material, exposure, seconds, said = fit(wale, data, out, cloth, weights)
        print(f"<!-- {material.stem}: {seconds:.0f} s; {said.strip()} -->".replace("\n", "; "))
        for part, target in PARTS.items():
            rows = []
            for side, letter in (("front", "R"), ("back", "T")):
                photo = rectified(data / f"photos/fabric-btdf/{cloth}_{letter}.png", target)
                render = picture(wale, out, cloth, part, material, exposure, side)
                ratio = render.mean((0, 1)) / photo.mean((0, 1))
                text = lambda v: " ".join(f"{x:.3f}" for x in v)
                print(f"| {cloth} | {'with VGG16' if weights else 'without'} | {part} | {side} | {text(ratio)} | "
                      f"{text(bands(photo))} | {text(bands(render))} |", flush=True)
                both = np.concatenate([photo, render], 1)
                rows.append(np.where(both <= 0.0031308, both * 12.92, 1.055 * both ** (1 / 2.4) - 0.055))
            Image.fromarray((np.clip(np.concatenate(rows), 0, 1) * 255 + 0.5).astype("uint8")).save(
                out / f"{material.stem}_{part}.png")


if __name__ == "__main__":
    main()
