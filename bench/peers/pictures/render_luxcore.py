#!/usr/bin/env python3
"""LuxCore: strands tessellated to tubes of 6 sides with `glossytranslucent`. --option is PATHCPU (native) or PATHOCL
(OpenCL; with PoCL the environment needs LD_PRELOAD=libtbbmalloc_proxy of the wheel, see README.md)."""
import os
import time

import numpy as np
import pyluxcore

import curves
import yarn_colours
from command import arguments
from scenes import ENVIRONMENT, light_corners, pages

SIDES = 6


def properties(values):
    out = pyluxcore.Properties()
    for name, value in values.items():
        out.Set(pyluxcore.Property(name, value))
    return out


def add_mesh(world, name, corners, triangles):
    world.DefineMesh(name, [tuple(c) for c in corners], [tuple(t) for t in triangles], None, None, None, None)


def add_cloth(world, args, scene):
    if "pages" in scene:
        add_mesh(world, "cloth_shape", *pages(scene))
        albedo = [scene["pages"]["albedo"]] * 3
        world.Parse(properties({"scene.materials.yarn.type": "matte", "scene.materials.yarn.kd": albedo}))
    else:
        points, radii, sizes = curves.load(args.base + ".npz")
        world.DefineStrands("cloth_shape", len(sizes), len(points), [tuple(p) for p in points.tolist()],
                            (sizes - 1).tolist(), (2.0 * radii).tolist(), 0.0, (1.0, 1.0, 1.0), None, "solid", 0, 0.0,
                            SIDES, True, True, False)
        colour = list(args.colour or yarn_colours.LUXCORE)
        gloss = {"ks": [0.05] * 3, "ks_bf": [0.05] * 3, "uroughness": 0.3, "vroughness": 0.3, "uroughness_bf": 0.3,
                 "vroughness_bf": 0.3}
        world.Parse(properties({"scene.materials.yarn.type": "glossytranslucent", "scene.materials.yarn.kd": colour,
                                "scene.materials.yarn.kt": colour,
                                **{"scene.materials.yarn." + k: v for k, v in gloss.items()}}))
    world.Parse(properties({"scene.objects.cloth.shape": "cloth_shape", "scene.objects.cloth.material": "yarn"}))


def add_lights(world, light):
    add_mesh(world, "light_shape", light_corners(light), [[0, 1, 2], [0, 2, 3]])
    world.Parse(properties({
        "scene.materials.glow.type": "matte", "scene.materials.glow.kd": [0.0] * 3,
        "scene.materials.glow.emission": [float(light["radiance"])] * 3,
        "scene.objects.light.shape": "light_shape", "scene.objects.light.material": "glow",
        "scene.lights.sky.type": "constantinfinite", "scene.lights.sky.color": [1.0] * 3,
        "scene.lights.sky.gain": [ENVIRONMENT] * 3, "scene.lights.sky.visibilitymapcache.enable": False}))


def main():
    args, scene = arguments(__doc__)
    pyluxcore.Init()
    pyluxcore.SetLogHandler(lambda text: None)
    engine = args.option or "PATHCPU"
    world = pyluxcore.Scene()
    camera = scene["camera"]
    world.Parse(properties({
        "scene.camera.type": "perspective", "scene.camera.lookat.orig": [float(c) for c in camera["position"]],
        "scene.camera.lookat.target": [float(c) for c in camera["look_at"]],
        "scene.camera.up": [float(c) for c in camera["up"]], "scene.camera.fieldofview": float(camera["fov"]),
        "scene.camera.autovolume.enable": False}))
    add_cloth(world, args, scene)
    add_lights(world, scene["light"])
    # The depth of a path counts its camera ray, so n scattering events are n + 1.
    settings = {
        "renderengine.type": engine, "renderengine.seed": args.seed, "sampler.type": "SOBOL",
        "sampler.sobol.adaptive.strength": 0.0, "native.threads.count": args.threads,
        **{"path.pathdepth." + kind: args.depth + 1 for kind in ["total", "diffuse", "glossy", "specular"]},
        "path.clamping.variance.maxvalue": 0.0,
        "film.width": args.size, "film.height": args.size, "film.filter.type": "BOX", "film.filter.width": 0.5,
        "batch.haltspp": args.spp, "film.imagepipelines.0.0.type": "NOP", "film.outputs.0.type": "RGB",
        "film.outputs.0.filename": "unused.exr"}
    if engine == "PATHOCL":
        settings.update({"opencl.cpu.use": True, "opencl.gpu.use": False, "opencl.native.threads.count": 0})
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties(settings), world))
    session.Start()
    while not session.HasDone():
        time.sleep(0.02)
        session.UpdateStats()
    pixels = np.zeros(3 * args.size * args.size, dtype=np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels, 0)
    session.Stop()
    np.save(args.out, pixels.reshape(args.size, args.size, 3)[::-1])
    os._exit(0)  # the wheel's libraries crash when they are unloaded after OpenCL was looked for


if __name__ == "__main__":
    main()
