#!/usr/bin/env python3
"""Rows of the table of docs/patterns.md, from the reports that make.sh wrote.

usage: scenes/patterns/make.sh FOLDER && scenes/patterns/table.py FOLDER
"""
import json
import pathlib
import sys

ORDER = ["stockinette_relaxed", "garter", "rib_1x1", "rib_2x2", "seed", "moss", "basketweave", "honeycomb", "cable_4",
         "cable_6", "half_cardigan", "eyelet", "waffle", "cartridge_belt_rib", "stranded", "mosaic"]

if len(sys.argv) != 2:
    sys.exit(__doc__.strip())
found = {file.stem: json.loads(file.read_text()) for file in pathlib.Path(sys.argv[1]).glob("*.json")}
print("| tile | stitches | period, mm | gauge per 10 cm | closest | force, period | loop length, mm | processor seconds (steps) |")
print("|---|---|---|---|---|---|---|---|")
for name in ORDER + sorted(set(found) - set(ORDER)):
    if name not in found:
        print(f"{name}: no report", file=sys.stderr)
        continue
    r = found[name]
    seconds = f"{r['processor_seconds']:.2g}" if r["processor_seconds"] < 100 else f"{r['processor_seconds']:.0f}"
    print(f"| `{name}` | {r['stitches'][0]} x {r['stitches'][1]} | {1e3 * r['period'][0]:.3f} x {1e3 * r['period'][1]:.3f} "
          f"| {r['wales_per_10cm']:.1f} x {r['courses_per_10cm']:.1f} | {r['closest']:.3f} "
          f"| {r['force']:.1e}, {r['period_force']:.1e} | {1e3 * r['loop_length']:.1f} | {seconds} ({r['steps']}) |")
