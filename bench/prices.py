#!/usr/bin/env python3
"""What each level of the accuracy options costs per sample: the table of bench/results/prices.md, whose figures
host/price_class.cpp quotes for `wale plan`.

    bench/prices.py build/wale [SCENE] [ROUNDS]

Time: processor seconds of the whole program at SPP samples less those at 8, kernels already compiled; one level after the
other in each round, ratios to the same round's run of the scene as it is, median over the rounds."""
import json
import resource
import statistics
import subprocess
import sys

SPP, SIZE = 136, "96x96"


def run(words):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return (seconds if done.returncode == 0 else None), done


def price(wale, scene, overrides):
    sets = [word for text in overrides for word in ("--set", text)]
    render = [wale, "render", scene, "-o", "/tmp/wale_price.png", "--size", SIZE, "--quiet", *sets, "--spp"]
    few, _ = run(render + ["8"])
    many, done = run(render + [str(SPP)])
    return (many - few if few is not None and many is not None else None), done.stderr.strip()


def main():
    wale = sys.argv[1]
    scene = sys.argv[2] if len(sys.argv) > 2 else "bench/specialised/2_lamp.json"
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    plan = json.loads(subprocess.run([wale, "plan", scene, "--quiet", "--json", "-"], capture_output=True, text=True,
                                     check=True).stdout)
    levels = [(o["option"], level["level"], level["set"]) for o in plan["accuracy"] for level in o["levels"]]
    ratios = {(option, name): [] for option, name, _ in levels}
    refused = {}
    for turn in range(rounds + 1):
        base, _ = price(wale, scene, [])
        for option, name, sets in levels:
            if (option, name) in refused:
                continue
            seconds, said = price(wale, scene, sets)
            if seconds is None:
                refused[option, name] = said
            elif turn:  # the first round compiles
                ratios[option, name].append(seconds / base)
    print("| option | level | time per sample, times the scene's own | times the option's cheapest | least and greatest |")
    print("|---|---|---|---|---|")
    medians = {key: statistics.median(values) for key, values in ratios.items() if values}
    for option, name, _ in levels:
        if (option, name) not in medians:
            print(f"| {option} | {name} | refused: {refused[option, name]} | | |")
            continue
        cheapest = min(value for (o, _), value in medians.items() if o == option)
        values = ratios[option, name]
        print(f"| {option} | {name} | {medians[option, name]:.2f} | {medians[option, name] / cheapest:.2f} | "
              f"{min(values):.2f} to {max(values):.2f} |")


if __name__ == "__main__":
    main()
