#!/usr/bin/env python3
"""prepare.py WALE FOLDER: exports the ply curves of every scene with Wale, for the peers, as text and as arrays."""
import json
import os
import subprocess
import sys

import curves
from scenes import DEPTH, SCENES, pages, wale_scene


def write_pages(scene, path):
    """The scene's pages as OBJ, for Wale."""
    corners, triangles = pages(scene)
    with open(path, "w", encoding="ascii") as file:
        file.writelines("v %g %g %g\n" % tuple(c) for c in corners)
        file.writelines("f %d %d %d\n" % tuple(i + 1 for i in t) for t in triangles)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    wale, folder = sys.argv[1:]
    os.makedirs(folder, exist_ok=True)
    for name, scene in SCENES.items():
        base = os.path.join(folder, name)
        if "pages" in scene:
            write_pages(scene, base + ".obj")
            continue
        with open(base + ".json", "w", encoding="utf-8") as file:
            json.dump(wale_scene(scene, 64, DEPTH, 0), file)
        subprocess.run([wale, "export", base + ".json", "-o", base + "_metres.txt"], check=True)
        points, radii, sizes = curves.read_mitsuba_text(base + "_metres.txt")
        os.remove(base + "_metres.txt")
        curves.write_mitsuba_text(base + ".txt", points, radii, sizes)
        curves.save(base + ".npz", points, radii, sizes)
        print(f"{name}: {len(sizes)} curves, {len(points) - len(sizes)} segments, radius {radii.min():.4g} mm")


if __name__ == "__main__":
    main()
