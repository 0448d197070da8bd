#!/usr/bin/env python3
"""widths.py NAME ...: how the noise of a path depends on the width of the hair's lobes, in the scene "close".

Relative variance of one sample and the mean of the picture, by roughness along and around the hair."""
import os
import sys
import tempfile
from subprocess import run

import noise
from picture_files import load
from renderers import environment, peer_command

DATA = os.environ.get("PICTURES_DATA", "out/pictures")
SIZE, SPP = 64, 64


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "picture.npy")
        for name in sys.argv[1:]:
            for roughness in (0.9, 0.7, 0.5, 0.3):
                pictures = []
                for seed in (1, 2):
                    command = peer_command(name, "close", out, SIZE, SPP, seed, data=DATA, roughness=roughness)
                    run(command, env=environment(name), check=True, capture_output=True)
                    pictures.append(load(out))
                print(name, roughness, *(f"{SPP * v:.3f}" for v in noise.relative_variance(*pictures)),
                      pictures[0].mean(axis=(0, 1)).round(3), flush=True)


if __name__ == "__main__":
    main()
