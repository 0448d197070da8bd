"""Plots what `goniometer fit BUNDLE -o DIR` wrote: model beside measurement, one picture per bundle.

    python3 bench/goniometer/plot.py DIR            every *_compared.json there, as PNG beside it
    python3 bench/goniometer/plot.py DIR --svg
"""
import argparse
import json
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def draw(data, path):
    figure, axes = plt.subplots(2, 4, figsize=(15, 7))
    normal, oblique = data["inclinations"][0], data["inclinations"][3]
    colors = plt.cm.viridis(np.linspace(0, 0.9, 6))
    degrees = np.linspace(-175, 175, 36)
    for row, inclination in enumerate((normal, oblique)):
        azimuth = axes[row][0]
        for slice_, color in zip(inclination["slices"][0::2], colors):
            azimuth.plot(degrees, slice_["phi"], ".", color=color, ms=4, label=f"h = {slice_['h']}")
            azimuth.plot(degrees, slice_["phi_model"], color=color, lw=1)
        azimuth.set_title(f"azimuth, th = {inclination['theta']:.0f} deg")
        azimuth.set_xlabel("phi, degrees; 180 = straight on")
        inclined = axes[row][1]
        for slice_, color in list(zip(inclination["slices"][0::2], colors))[::2]:
            inclined.plot(degrees / 2, slice_["theta"], ".", color=color, ms=4)
            inclined.plot(degrees / 2, slice_["theta_model"], color=color, lw=1)
        inclined.set_title(f"inclination, th = {inclination['theta']:.0f} deg")
        inclined.set_xlabel("th_o, degrees")
    axes[0][0].legend(fontsize=7)

    h = [s["h"] for s in normal["slices"][0::2]]
    split, share = axes[0][2], axes[1][2]
    for key, label, color in (("uncollided", "T0", "C0"), ("surface", "R1 / (1 - T0)", "C1"), ("forward", "forward", "C2")):
        split.plot(h, [s[key] for s in normal["slices"][0::2]], "o", color=color, label=label)
        split.plot(h, [s[key + "_model"] for s in normal["slices"][0::2]], color=color)
    split.set_title("energy split, th = 0")
    split.set_xlabel("h")
    split.legend(fontsize=8)
    angles = [i["theta"] for i in data["inclinations"]]
    for k, color in ((2, "C0"), (6, "C1"), (10, "C2")):
        for sign, marker in ((0, "o"), (1, "x")):
            slices = [i["slices"][k + sign] for i in data["inclinations"]]
            share.plot(angles, [s["forward"] for s in slices], marker, color=color, label=f"h = {slices[0]['h']}")
            share.plot(angles, [s["forward_model"] for s in slices], color=color, lw=1)
    share.set_title("forward share")
    share.set_xlabel("th, degrees")
    share.legend(fontsize=7)

    fibre = np.linspace(0, 1, 21)
    for slice_, color in zip(normal["slices"][0::2], colors):
        axes[0][3].plot(fibre, slice_["albedo"], ".", color=color, ms=4)
        axes[0][3].plot(fibre, slice_["albedo_model"], color=color, lw=1)
        bright = fibre[16:20]
        axes[1][3].plot(bright, 1 - np.array(slice_["albedo"][16:20]), ".", color=color)
        axes[1][3].plot(bright, 1 - np.array(slice_["albedo_model"][16:20]), color=color, lw=1)
    axes[0][3].set_title("body albedo")
    axes[0][3].set_xlabel("fibre colour")
    axes[1][3].set_title("light lost by bright fibres")
    axes[1][3].set_xlabel("fibre colour")
    figure.suptitle(f"{data['name']}: measured (points) and model (lines)")
    figure.tight_layout()
    figure.savefig(path, dpi=70)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--svg", action="store_true")
    options = parser.parse_args()
    for path in sorted(options.folder.glob("*_compared.json")):
        picture = path.with_name(path.name.replace("_compared.json", ".svg" if options.svg else ".png"))
        draw(json.loads(path.read_text()), picture)
        print(picture)


if __name__ == "__main__":
    main()
