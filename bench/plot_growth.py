#!/usr/bin/env python3
"""Plots speed, build, update and memory against the number of segments, from the rows that bench/growth.sh collects.

    pip install matplotlib
    python3 bench/plot_growth.py bench/results/growth.csv bench/results/growth.png
"""
import csv
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

FORMS = {
    "stored": ("Wale, stored", "tab:blue", "o-"),
    "procedural": ("Wale, procedural", "tab:green", "^-"),
    "embree": ("Embree, round linear curves", "tab:red", "s-"),
}
SPEED = "million rays a CPU second"
# Title, unit and quantities. Speeds of procedural leaves are of other rays at another cloth: they have their own panel.
PANELS = (
    ("camera rays", SPEED, ("speed, primary", "speed, primary, one by one")),
    ("shadow rays", SPEED, ("speed, shadow", "speed, shadow, attenuated")),
    ("bounce rays", SPEED, ("speed, bounce",)),
    ("build", "CPU seconds", ("build",)),
    ("update of a frame (Embree: commit)", "CPU seconds", ("update",)),
    ("memory to trace", "MB", ("memory to trace",)),
)
SECOND = {"speed, primary, one by one": "one by one", "speed, shadow, attenuated": "through plies of cotton"}
RATIOS = (("primary", "camera, one by one", "o-"), ("shadow", "shadow", "s--"), ("bounce", "bounce", "v:"))


def read(path):
    rows = defaultdict(list)
    with open(path, newline="", encoding="utf-8") as source:
        for row in csv.DictReader(source):
            rows[row["form"], row["quantity"]].append((int(row["segments"]), float(row["value"])))
    return {key: sorted(points) for key, points in rows.items()}


def dress(axis, title, unit):
    axis.set_xscale("log")
    axis.set_xlim(6e4, 8e7)
    axis.set_title(title, fontsize=9)
    axis.set_ylabel(unit, fontsize=8)
    axis.set_xlabel("ply segments", fontsize=8)
    axis.tick_params(labelsize=7)
    axis.grid(alpha=0.3)


def plot(axis, rows, title, unit, quantities):
    for form, (_, colour, style) in FORMS.items():
        for number, quantity in enumerate(quantities):
            # Embree's opaque rays are what attenuated ones are compared with: the same line twice.
            own_panel = unit == SPEED and form == "procedural"
            if own_panel or (form, quantity) not in rows or (number and form == "embree"):
                continue
            n, value = zip(*rows[form, quantity])
            label = FORMS[form][0] + (": " + SECOND[quantity] if number else "")
            if unit == "MB":
                label = f"{value[-1]:.3g} bytes a segment"
                value = [a * b * 1e-6 for a, b in zip(n, value)]
            axis.plot(n, value, style if not number else style[0] + "--", color=colour, markersize=4, linewidth=1.2,
                      markerfacecolor=colour if not number else "white", label=label)
    if unit == SPEED:
        axis.set_ylim(0, 1.25 * axis.get_ylim()[1])
    else:
        axis.set_yscale("log")
    if len(quantities) > 1 or unit == "MB":
        axis.legend(fontsize=7, loc="lower right" if unit == "MB" else "upper right")
    dress(axis, title, unit)


def plot_ratios(axis, rows):
    for kind, label, style in RATIOS:
        stored = dict(rows["stored of lattice", f"speed, {kind}"])
        points = [(n, v / stored[n]) for n, v in rows["procedural", f"speed, {kind}"] if n in stored]
        axis.plot(*zip(*points), style, color="tab:green", markersize=4, linewidth=1.2, label=label)
    axis.set_ylim(bottom=0)
    axis.legend(fontsize=7, loc="lower right")
    dress(axis, "speed, procedural / stored, one lattice", "ratio")


def main():
    rows, out = read(sys.argv[1]), sys.argv[2]
    figure, axes = plt.subplots(2, 4, figsize=(13.5, 6))
    panels = [*axes[0][:3], *axes[1][:3]]
    for axis, panel in zip(panels, PANELS):
        plot(axis, rows, *panel)
    plot_ratios(axes[0][3], rows)
    axes[1][3].axis("off")
    lines = [plt.Line2D([], [], color=colour, marker=style[0], linestyle=style[1:], markersize=4)
             for _, colour, style in FORMS.values()]
    axes[1][3].legend(lines, [label for label, _, _ in FORMS.values()], loc="center", fontsize=9, frameon=False)
    figure.tight_layout()
    figure.savefig(out, dpi=90)


if __name__ == "__main__":
    main()
