"""How each renderer is started for one picture: a command line and what its environment needs."""
import json
import os
import sys

from scenes import DEPTH, SCENES, wale_scene

HERE = os.path.dirname(os.path.abspath(__file__))

# name: (script, option)
PEERS = {
    "mitsuba llvm": ("render_mitsuba.py", "llvm_ad_rgb"),
    "mitsuba scalar": ("render_mitsuba.py", "scalar_rgb"),
    "cycles": ("render_cycles.py", "THICK_LINEAR"),
    "cycles smooth": ("render_cycles.py", "THICK"),
    "luxcore": ("render_luxcore.py", "PATHCPU"),
    "luxcore opencl": ("render_luxcore.py", "PATHOCL"),
}
# PoCL compiles for longer than anyone waits (bench/results/pictures.md): that one only when it is asked for.
NAMES = ["wale", *(name for name in PEERS if name != "luxcore opencl")]


def wale_command(wale, scene, out, size, spp, seed, depth=DEPTH, data="out/pictures", stats=None):
    """Writes the scene file beside the picture."""
    file = os.path.splitext(out)[0] + ".json"
    mesh = os.path.abspath(os.path.join(data, scene + ".obj"))
    with open(file, "w", encoding="utf-8") as text:
        json.dump(wale_scene(SCENES[scene], size, depth, seed, mesh), text)
    command = [wale, "render", file, "-o", out, "--spp", str(spp), "--quiet"]
    return command + (["--stats", stats] if stats else [])


def peer_command(name, scene, out, size, spp, seed, depth=DEPTH, data="out/pictures", colour=None, roughness=None):
    script, option = PEERS[name]
    command = [sys.executable, os.path.join(HERE, script), scene, out, "--data", data, "--size", str(size), "--spp",
               str(spp), "--seed", str(seed), "--depth", str(depth), "--option", option]
    if roughness is not None:
        command += ["--roughness", str(roughness)]
    return command + (["--colour", *map(str, colour)] if colour is not None else [])


def environment(name):
    """LuxCore looks for OpenCL devices in any case, and PoCL frees with one malloc what it got from another unless the
    one that LuxCore's wheel brings is there from the start ("double free or corruption")."""
    env = dict(os.environ)
    if name.startswith("luxcore"):
        import glob
        import sysconfig
        folder = os.path.join(sysconfig.get_paths()["purelib"], "pyluxcore.libs")
        env["LD_PRELOAD"] = glob.glob(os.path.join(folder, "libtbbmalloc_proxy*"))[0]
    return env
