#!/usr/bin/env python3
"""Blender Cycles on the CPU: hair curves with the Principled Hair BSDF (Chiang). --option is the curves' shape,
THICK_LINEAR (segments as they are) or THICK (Catmull-Rom curves through the same points)."""
import math
import os
import tempfile

import bpy
import numpy as np
from mathutils import Matrix, Vector

import curves
import yarn_colours
from command import arguments
from scenes import ENVIRONMENT, pages


def frame(at, target, up):
    """Where a camera or lamp stands, that looks along its own -z."""
    z = (Vector(at) - Vector(target)).normalized()
    x = Vector(up).cross(z).normalized()
    return Matrix.Translation(at) @ Matrix((x, z.cross(x), z)).transposed().to_4x4()


def shader(name, kind):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    node, out = nodes.new(kind), nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(node.outputs[0], out.inputs["Surface"])
    return material, node


def yarn(colour, roughness):
    material, hair = shader("yarn", "ShaderNodeBsdfHairPrincipled")
    hair.model, hair.parametrization = "CHIANG", "ABSORPTION"
    values = {"Absorption Coefficient": yarn_colours.absorption(colour, roughness), "IOR": yarn_colours.INDEX,
              "Roughness": roughness, "Radial Roughness": roughness, "Coat": 0.0,
              "Offset": math.radians(yarn_colours.TILT), "Random Roughness": 0.0}
    for name, value in values.items():
        hair.inputs[name].default_value = value
    return material


def hair(path):
    points, radii, sizes = curves.load(path)
    data = bpy.data.hair_curves.new("plies")
    data.add_curves(sizes.tolist())
    data.attributes["position"].data.foreach_set("vector", points.ravel())
    data.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", radii)
    return data


def cloth(args, scene):
    if "pages" in scene:
        data = bpy.data.meshes.new("pages")
        corners, triangles = pages(scene)
        data.from_pydata(corners, [], triangles)
        material, diffuse = shader("page", "ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = [scene["pages"]["albedo"]] * 3 + [1]
    else:
        data = hair(args.base + ".npz")
        material = yarn(args.colour or yarn_colours.CYCLES, args.roughness)
    data.materials.append(material)
    bpy.context.collection.objects.link(bpy.data.objects.new("cloth", data))


def lights(light):
    lamp = bpy.data.lights.new("quad", "AREA")
    lamp.shape, lamp.size = "SQUARE", light["side"]
    # Watts: radiance times pi times area. Elsewhere the lamp hides the environment behind it, here it adds to it.
    lamp.energy = (light["radiance"] - ENVIRONMENT) * math.pi * light["side"] ** 2
    lamp.cycles.max_bounces = 1024
    item = bpy.data.objects.new("quad", lamp)
    item.matrix_world = frame(light["position"], light["look_at"], light["up"])
    bpy.context.collection.objects.link(item)
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = [ENVIRONMENT] * 3 + [1]
    bpy.context.scene.world = world


def view(camera):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle = "VERTICAL", math.radians(camera["fov"])
    data.clip_start, data.clip_end = 0.1, 1e5
    item = bpy.data.objects.new("camera", data)
    item.matrix_world = frame(camera["position"], camera["look_at"], camera["up"])
    bpy.context.collection.objects.link(item)
    bpy.context.scene.camera = item


def settings(args):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = args.size
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads = "FIXED", args.threads
    scene.cycles_curves.shape = args.option or "THICK_LINEAR"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples, cycles.seed = args.spp, args.seed
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    # max_bounces counts what follows the first scattering event.
    for name in ["max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"]:
        setattr(cycles, name, args.depth - 1)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.light_sampling_threshold = 0.0


def render(out):
    scene = bpy.context.scene
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = os.path.join(folder, "picture.exr")
        image = scene.render.image_settings
        image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGB", "32"
        bpy.ops.render.render(write_still=True)
        picture = bpy.data.images.load(scene.render.filepath)
        pixels = np.empty(picture.size[0] * picture.size[1] * picture.channels, np.float32)
        picture.pixels.foreach_get(pixels)
    np.save(out, pixels.reshape(picture.size[1], picture.size[0], -1)[::-1, :, :3])


def main():
    args, scene = arguments(__doc__)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    cloth(args, scene)
    lights(scene["light"])
    view(scene["camera"])
    settings(args)
    render(args.out)


if __name__ == "__main__":
    main()
