#!/usr/bin/env python3
"""Renders one scene with every renderer in turn, again and again with other seeds, and keeps times and pictures.

    measure.py WALE SCENE FOLDER [--data DATA] [--names wale,cycles] [--spp 64] [--size 128] [--repeat 3]

Each turn renders with 1 sample and with --spp: the difference is the time of the samples without start, loading and
building. Processor seconds are those of all threads and children. Writes FOLDER/SCENE.json for report.py."""
import argparse
import json
import os
import subprocess
import time

from picture_files import load
from renderers import NAMES, environment, peer_command, wale_command
from scenes import DEPTH, SCENES


def run(command, env, log):
    """Wall seconds, processor seconds and peak bytes of a process and its children; None if it fails."""
    start = time.time()
    with open(log, "w", encoding="utf-8") as out:
        child = subprocess.Popen(command, env=env, stdout=out, stderr=subprocess.STDOUT)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        return None
    return {"wall": time.time() - start, "cpu": usage.ru_utime + usage.ru_stime, "peak": 1024 * usage.ru_maxrss}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wale")
    parser.add_argument("scene", choices=[s for s in SCENES if "fabric" in SCENES[s]])
    parser.add_argument("folder")
    parser.add_argument("--data", default="out/pictures")
    parser.add_argument("--names", default=",".join(NAMES))
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--depth", type=int, default=DEPTH)
    args = parser.parse_args()
    os.makedirs(args.folder, exist_ok=True)
    rows = {name: [] for name in args.names.split(",")}
    for seed in range(1, args.repeat + 1):
        for name in rows:
            row = {}
            for spp in (1, args.spp):
                base = os.path.join(args.folder, f"{args.scene}_{name.replace(' ', '_')}_{spp}_{seed}")
                out = base + (".exr" if name == "wale" else ".npy")
                if name == "wale":
                    command = wale_command(args.wale, args.scene, out, args.size, spp, seed, args.depth, args.data,
                                           base + "_stats.json")
                else:
                    command = peer_command(name, args.scene, out, args.size, spp, seed, args.depth, args.data)
                row["one" if spp == 1 else "all"] = times = run(command, environment(name), base + ".log")
                print(args.scene, name, spp, "failed, see " + base + ".log" if times is None else
                      f"{times['wall']:.1f} s wall, {times['cpu']:.1f} s processor, mean "
                      f"{load(out).mean(axis=(0, 1)).round(4)}", flush=True)
            row["picture"] = out
            rows[name].append(row)
            with open(os.path.join(args.folder, args.scene + ".json"), "w", encoding="utf-8") as file:
                json.dump({"scene": args.scene, "spp": args.spp, "size": args.size, "depth": args.depth,
                           "rows": rows}, file, indent=1)


if __name__ == "__main__":
    main()
