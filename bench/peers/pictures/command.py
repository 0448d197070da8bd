"""The command line that all renderers' scripts share: SCENE OUT.npy [options]."""
import argparse
import os

from scenes import DEPTH, SCENES
from yarn_colours import ROUGHNESS


def arguments(doc):
    parser = argparse.ArgumentParser(description=doc)
    parser.add_argument("scene", choices=SCENES)
    parser.add_argument("out", help="picture: .npy, height x width x 3 floats, linear, row 0 at the top")
    parser.add_argument("--data", default="out/pictures", help="folder that prepare.py filled")
    parser.add_argument("--size", type=int, default=192)
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--depth", type=int, default=DEPTH, help="scattering events of a path")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--option", default="", help="what else the renderer can be asked for, see its script")
    parser.add_argument("--colour", type=float, nargs=3, help="of the yarn, in the renderer's own terms")
    parser.add_argument("--roughness", type=float, default=ROUGHNESS, help="of Mitsuba's and Cycles' hair")
    args = parser.parse_args()
    args.base = os.path.join(args.data, args.scene)
    return args, SCENES[args.scene]
