#!/usr/bin/env python3
"""Says how alike two runs of `wale cost` rank the levels of a scene.

    python3 bench/cost_ranking.py FIRST/cost.json SECOND/cost.json

Of all pairs of levels: how many stand in the same order in both runs (Kendall's tau is twice that share, minus 1), and
how many of those that both runs tell apart, their intervals not overlapping, stand in another order. None should.
"""
import itertools
import json
import sys

# A figure of a level: its value and its interval.
FIGURES = {
    "time a path": lambda level: (level["time"]["median"], level["time"]["least"], level["time"]["largest"]),
    "time to equal noise": lambda level: (
        level["equal_noise"]["median"], level["equal_noise"]["least"], level["equal_noise"]["largest"]),
    "bias": lambda level: level["bias"] and (
        level["bias"]["relative_mse"], level["bias"]["low"], level["bias"]["high"]),
    "change": lambda level: level["change"] and (
        level["change"]["relative_mse"], level["change"]["low"], level["change"]["high"]),
}


def read(path):
    with open(path, encoding="utf-8") as source:
        report = json.load(source)
    rows = {}
    for row in report["levels"]:
        if "left_out" not in row:  # the scene as it is has a row in every option; it is one level
            own = row["note"] == "the scene as it is"
            rows[("the scene", "") if own else (row["option"], row["level"])] = row
    return report, rows


def order(a, b):
    return (a[0] > b[0]) - (a[0] < b[0])


def apart(a, b):
    return a[2] < b[1] or b[2] < a[1]


def main():
    first, rows = read(sys.argv[1])
    _, others = read(sys.argv[2])
    print(f"{first['scene']}: {len(rows.keys() & others.keys())} levels in both runs")
    for name, figure in FIGURES.items():
        pairs = same = told = crossed = 0
        for one, two in itertools.combinations(sorted(rows.keys() & others.keys()), 2):
            a, b, c, d = figure(rows[one]), figure(rows[two]), figure(others[one]), figure(others[two])
            if not (a and b and c and d) or (order(a, b) == 0 and order(c, d) == 0):
                continue
            pairs += 1
            same += order(a, b) == order(c, d)
            if apart(a, b) and apart(c, d):
                told += 1
                crossed += order(a, b) != order(c, d)
        if pairs:
            print(f"  {name}: {same} of {pairs} pairs in the same order (tau {2 * same / pairs - 1:.3f}); of {told} that "
                  f"both runs tell apart {crossed} in another")


if __name__ == "__main__":
    main()
