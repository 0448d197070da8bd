#!/usr/bin/env python3
"""Plots what cloth_goniometer measured: reflectance, transmittance and openness against the angle.

    pip install matplotlib
    python3 bench/plot_cloth.py OUT.png LABEL=FILE.json [LABEL=FILE.json ...]
"""
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def main():
    out, files = sys.argv[1], [argument.split("=", 1) for argument in sys.argv[2:]]
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), sharey=True)
    for axis, plane in zip(axes, ("courses", "wales")):
        for number, (label, file) in enumerate(files):
            with open(file, encoding="utf-8") as source:
                rows = [r for r in json.load(source)["angles"] if r["plane"] == plane or r["theta"] == 0]
            theta = [r["theta"] for r in rows]
            for channel, colour in enumerate(("tab:red", "tab:green", "tab:blue")):
                for key, style in (("reflectance", "-"), ("transmittance", "--")):
                    axis.plot(theta, [r[key][channel] for r in rows], style, color=colour, alpha=1 - 0.5 * number,
                              label=f"{label}, {key}" if channel == 0 else None)
            axis.plot(theta, [r["openness"] for r in rows], ":", color="black", alpha=1 - 0.5 * number)
        axis.set_title(f"tilted along {plane} (dotted: openness)")
        axis.set_xlabel("angle to the cloth's normal, degrees")
        axis.set_ylim(0, 1)
    axes[0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(out, dpi=110)


if __name__ == "__main__":
    main()
