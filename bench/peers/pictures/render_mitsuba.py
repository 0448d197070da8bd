#!/usr/bin/env python3
"""Mitsuba 3: `linearcurve` with the `hair` BSDF, stratified samples (`multijitter`: less noise here than `independent`
and `ldsampler`). --option is the variant, llvm_ad_rgb or scalar_rgb."""
import os

import mitsuba as mi
import numpy as np

import yarn_colours
from command import arguments
from scenes import ENVIRONMENT, pages


def rgb(value):
    return {"type": "rgb", "value": list(value)}


def mesh(corners, triangles, name, more):
    out = mi.Mesh(name, len(corners), len(triangles), props=more)
    params = mi.traverse(out)
    params["vertex_positions"] = np.ravel(np.array(corners, np.float32))
    params["faces"] = np.ravel(np.array(triangles, np.uint32))
    params.update()
    return out


def cloth(args, scene):
    if "pages" in scene:
        props = mi.Properties()
        props["bsdf"] = mi.load_dict({"type": "twosided", "bsdf": {
            "type": "diffuse", "reflectance": rgb([scene["pages"]["albedo"]] * 3)}})
        return mesh(*pages(scene), "pages", props)
    colour = args.colour or yarn_colours.MITSUBA
    return {"type": "linearcurve", "filename": os.path.abspath(args.base + ".txt"),
            "bsdf": {"type": "hair", "int_ior": yarn_colours.INDEX, "ext_ior": 1.0,
                     "longitudinal_roughness": args.roughness,
                     "azimuthal_roughness": args.roughness,
                     "scale_tilt": yarn_colours.TILT, "sigma_a": rgb(yarn_colours.absorption(colour, args.roughness))}}


def quad_light(light):
    t = mi.ScalarTransform4f
    return {"type": "rectangle", "emitter": {"type": "area", "radiance": rgb([light["radiance"]] * 3)},
            "bsdf": {"type": "diffuse", "reflectance": rgb([0, 0, 0])},
            "to_world": t().look_at(origin=light["position"], target=light["look_at"], up=light["up"])
            @ t().scale([light["side"] / 2, light["side"] / 2, 1])}


def main():
    args, scene = arguments(__doc__)
    mi.set_variant(args.option or "llvm_ad_rgb")
    if mi.variant().startswith("llvm"):
        import drjit as dr
        dr.set_thread_count(args.threads)
    camera = scene["camera"]
    world = mi.load_dict({
        # Depth 1 is light seen directly, so n scattering events are n + 1.
        "type": "scene", "integrator": {"type": "path", "max_depth": args.depth + 1},
        "cloth": cloth(args, scene), "light": quad_light(scene["light"]),
        "sky": {"type": "constant", "radiance": rgb([ENVIRONMENT] * 3)},
        "sensor": {"type": "perspective", "fov": camera["fov"], "fov_axis": "y",
                   "near_clip": 0.1, "far_clip": 1e5,
                   "to_world": mi.ScalarTransform4f().look_at(origin=camera["position"], target=camera["look_at"],
                                                              up=camera["up"]),
                   "film": {"type": "hdrfilm", "width": args.size, "height": args.size, "rfilter": {"type": "box"},
                            "pixel_format": "rgb", "component_format": "float32"},
                   "sampler": {"type": "multijitter", "sample_count": args.spp}}})
    np.save(args.out, np.array(mi.render(world, spp=args.spp, seed=args.seed)).astype(np.float32))


if __name__ == "__main__":
    main()
