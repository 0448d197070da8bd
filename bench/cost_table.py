#!/usr/bin/env python3
"""Prints what `wale cost` found on several scenes as one table (Markdown).

    python3 bench/cost_table.py FIRST/cost.json [SECOND/cost.json ...]

Time is to equal noise over that of the scene as it is; bias against the reference and change against the scene are
relative root mean squares, "<" the upper limit of what noise hides. A scene that is named again adds the levels that its
earlier runs left out. Levels that the scene has anyway are not rows.
"""
import json
import sys


def percent(square):
    return f"{100 * max(square, 0) ** 0.5:.3g} %"


def error(figure):
    if not figure:
        return "-"
    if figure["resolved"]:
        return percent(figure["relative_mse"]) if figure["relative_mse"] > 0 else "none"
    return "< " + percent(max(figure["relative_mse"], 0) + figure["high"] - figure["relative_mse"])  # Bias::limit()


def main():
    scenes, rows = {}, []
    for path in sys.argv[1:]:
        with open(path, encoding="utf-8") as source:
            report = json.load(source)
        name = report["scene"].rsplit("/", 1)[-1].removesuffix(".json")
        found = scenes.setdefault(name, {})
        for level in report["levels"]:
            key = level["option"], level["level"]
            if key not in rows:
                rows.append(key)
            if "left_out" not in level:
                found.setdefault(key, level)
    print("| option | level | " + " | ".join(f"{name}: time | bias | change" for name in scenes) + " |")
    print("|" + "---|" * (2 + 3 * len(scenes)))
    for key in sorted(rows, key=lambda row: [r[0] for r in rows].index(row[0])):
        cells = []
        for found in scenes.values():
            level = found.get(key)
            if not level:
                cells += ["", "", ""]
                continue
            reference = level["note"] == "the reference"
            cells += [f"{level['equal_noise']['median']:.3g}", "the reference" if reference else error(level["bias"]),
                      error(level["change"])]
        own = all(not f.get(key) or f[key]["note"] == "the scene as it is" for f in scenes.values())
        if not own:
            print(f"| {key[0]} | {key[1]} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
