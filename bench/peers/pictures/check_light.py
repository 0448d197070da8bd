#!/usr/bin/env python3
"""check_light.py WALE [NAME ...]: light, camera and path depth mean the same to all renderers.

Renders the scene "book" (two diffuse pages, no cloth) with 1, 2 and all scattering events and compares the means of
each picture's quarters with Wale's. Fails when one differs by more than 1.5 %."""
import os
import subprocess
import sys
import tempfile

import numpy as np

from picture_files import load
from prepare import write_pages
from renderers import NAMES, environment, peer_command, wale_command
from scenes import SCENES

LIMIT = 0.015
SIZE, SPP = 64, 256


def quarters(picture):
    h = picture.shape[0] // 2
    return picture.reshape(2, h, 2, h, 3).mean(axis=(1, 3, 4))


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    wale, names = sys.argv[1], sys.argv[2:] or NAMES
    worst = 0.0
    with tempfile.TemporaryDirectory() as folder:
        write_pages(SCENES["book"], os.path.join(folder, "book.obj"))
        for depth in [1, 2, 12]:
            means = {}
            for name in dict.fromkeys(["wale", *names]):
                out = os.path.join(folder, name.replace(" ", "_") + (".exr" if name == "wale" else ".npy"))
                command = (wale_command(wale, "book", out, SIZE, SPP, 1, depth, folder) if name == "wale" else
                           peer_command(name, "book", out, SIZE, SPP, 1, depth, folder))
                done = subprocess.run(command, env=environment(name), capture_output=True, text=True)
                if done.returncode:
                    sys.exit(f"{name}: {(done.stderr or done.stdout or 'failed').strip().splitlines()[-1]}")
                means[name] = quarters(load(out))
            for name, mean in means.items():
                ratio = mean / means["wale"] - 1
                worst = max(worst, np.abs(ratio).max())
                print(f"depth {depth:2}  {name:15} quarters {np.round(mean.ravel(), 4)}  "
                      f"largest difference {100 * np.abs(ratio).max():.2f} %", flush=True)
    if worst > LIMIT:
        sys.exit(f"the pictures differ by {100 * worst:.2f} %")


if __name__ == "__main__":
    main()
