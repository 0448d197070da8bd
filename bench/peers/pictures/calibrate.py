#!/usr/bin/env python3
"""calibrate.py WALE NAME ...: the colour of each peer's yarn that gives the picture "close" the mean of Wale's.

Prints what belongs into yarn_colours.py. A colour is multiplied by the ratio of the means a few times, kept within
0.005 and 0.995."""
import os
import subprocess
import sys
import tempfile

import numpy as np

import yarn_colours
from picture_files import load
from renderers import environment, peer_command, wale_command

DATA = os.environ.get("PICTURES_DATA", "out/pictures")
SIZE, SPP, STEPS = 64, 32, 7


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    wale, names = sys.argv[1], sys.argv[2:]
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "wale.exr")
        subprocess.run(wale_command(wale, "close", out, SIZE, 2 * SPP, 1, data=DATA), check=True)
        target = load(out).mean(axis=(0, 1))
        print("wale", np.round(target, 4))
        for name in names:
            colour = np.array(getattr(yarn_colours, name.split()[0].upper()))
            out = os.path.join(folder, "peer.npy")
            for step in range(STEPS):
                command = peer_command(name, "close", out, SIZE, SPP, step, data=DATA, colour=colour)
                subprocess.run(command, check=True, env=environment(name), capture_output=True)
                mean = load(out).mean(axis=(0, 1))
                print(name, np.round(colour, 4), "mean", np.round(mean, 4), flush=True)
                colour = np.clip(colour * (target / mean) ** 1.5, 0.005, 0.995)


if __name__ == "__main__":
    main()
