#!/usr/bin/env python3
"""report.py FOLDER/SCENE.json ...: time to equal noise of every renderer, over Wale's, as a table in Markdown."""
import json
import statistics
import sys

import noise
from picture_files import load


def median(rows, of):
    return statistics.median(of(row) for row in rows)


def figures(data, rows):
    """Medians over the repetitions; seconds of processor and wall time, variance at data["spp"] samples."""
    share = data["spp"] / (data["spp"] - 1)  # the first sample is part of the start
    out = {"render": median(rows, lambda r: (r["all"]["cpu"] - r["one"]["cpu"]) * share),
           "wall": median(rows, lambda r: (r["all"]["wall"] - r["one"]["wall"]) * share),
           "start": median(rows, lambda r: r["one"]["cpu"]), "start_wall": median(rows, lambda r: r["one"]["wall"]),
           "peak": median(rows, lambda r: r["all"]["peak"])}
    pictures = [load(row["picture"]) for row in rows]
    out["plain"], out["blocks"] = noise.of_seeds(pictures)
    out["mean"] = sum(p.mean(axis=(0, 1)) for p in pictures) / len(pictures)
    return out


def table(data):
    rows = {name: figures(data, done) for name, runs in data["rows"].items()
            if len(done := [r for r in runs if r["one"] and r["all"]]) > 1}
    if "wale" not in rows:
        sys.exit(f"{data['scene']}: needs two finished repetitions of wale, which the others are compared with")
    wale, paths = rows["wale"], data["size"] ** 2 * data["spp"]
    print(f"\n### {data['scene']}, {data['size']} x {data['size']}, {data['spp']} samples, depth {data['depth']}\n")
    print("| | us a path | variance | of blocks | **equal noise** | blocks | wall | start | picture | GB | mean |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for name, f in rows.items():
        cost = {k: f[t] * f[v] / (wale[t] * wale[v]) for k, t, v in
                [("plain", "render", "plain"), ("blocks", "render", "blocks"), ("wall", "wall", "plain")]}
        # Start and as many samples as Wale's noise takes.
        whole = (f["start"] + f["render"] * f["plain"] / wale["plain"]) / (wale["start"] + wale["render"])
        print(f"| {name} | {1e6 * f['render'] / paths:.2f} | {f['plain'] * data['spp']:.3f} | "
              f"{f['blocks'] * data['spp']:.3f} | **{cost['plain']:.2f}** | {cost['blocks']:.2f} | "
              f"{cost['wall']:.2f} | {f['start']:.1f} ({f['start_wall']:.1f}) | {whole:.2f} | {f['peak'] / 1e9:.2f} | "
              f"{' '.join(f'{m:.3f}' for m in f['mean'])} |")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("Processor time a path without the start; relative variance of one sample, mean and median of blocks;\n"
          "time to equal noise over Wale's by either, and by wall time; start: processor (wall) seconds to one\n"
          "sample; picture: time to equal noise with the start; peak memory; mean of the picture.")
    for path in sys.argv[1:]:
        with open(path, encoding="utf-8") as file:
            table(json.load(file))


if __name__ == "__main__":
    main()
