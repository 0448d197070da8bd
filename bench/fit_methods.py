#!/usr/bin/env python3
"""What derivatives along the paths buy: one known answer by each method of `wale fit`.

    python3 bench/fit_methods.py WALE OUT

Photographs of a hidden cotton are rendered from scenes/photo.json, then fitted with nine parameters from one far start.
Prints renders, processor seconds, loss and the worst colour's error; standard library only.
"""
import json
import re
import resource
import subprocess
import sys
from pathlib import Path

SCENE = Path(__file__).resolve().parent.parent / "scenes/photo.json"
HIDDEN = {"type": "ply", "preset": "cotton", "transmit": [0.18, 0.28, 0.60], "reflect": [0.12, 0.20, 0.48],
          "roughness": 12, "optical_radius": 3.2, "fibre_twist": 22}
START = dict(HIDDEN, transmit=[0.5, 0.5, 0.5], reflect=[0.5, 0.5, 0.5], roughness=20, optical_radius=0.8, fibre_twist=0)
SIZE = "48x48"


def run(*words):
    """Standard output and processor seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    return done.stdout + done.stderr, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    wale, out = Path(sys.argv[1]), Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    for side, other in (("front", "back"), ("back", "front")):
        run(wale, "render", SCENE, "-o", out / f"{side}.exr", "--size", SIZE, "--spp", 8192, "--quiet", "--set",
            f"materials.yarn={json.dumps(HIDDEN)}", "--set", f"lights.{other}.radiance=0", "--set", "integrator.seed=900")
    print("| method | renders | processor s | loss | worst colour off by | roughness | optical radius |")
    print("|---|---|---|---|---|---|---|")
    for method in ("paths", "differences", "bobyqa"):
        said, seconds = run(wale, "fit", SCENE, "--front", out / "front.exr", "--back", out / "back.exr", "--resolution", 1,
                            "--method", method, "--starts", 1, "--spp", 32, "--final-spp", 1024, "--redo", "-o",
                            out / f"{method}.json", "--set", f"materials.yarn={json.dumps(START)}", "--set",
                            f"film.size=[{SIZE.replace('x', ',')}]")
        value = {m[1]: float(m[2]) for m in re.finditer(r"^([a-z_.]+) ([-+.e0-9]+)", said, re.M)}
        off = max(abs(value[f"{k}.{c}"] - HIDDEN[k][i]) for k in ("transmit", "reflect") for i, c in enumerate("rgb"))
        loss, renders = re.search(r"loss ([-.e0-9]+);.*?(\d+) pairs", said).groups()
        print(f"| {method} | {renders} | {seconds:.0f} | {loss} | {off:.4f} | {value['roughness']:g} | "
              f"{value['optical_radius']:g} |", flush=True)


if __name__ == "__main__":
    main()
