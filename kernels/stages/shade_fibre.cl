/* A path meets a single fibre: connect it to a light, go on along a lobe of the fibre's far-field scattering. The path
   goes on from the fibre's axis, where a far-field function has its one place: a ray from there meets no front face of
   its own tube. One hit a work-item. */
#undef W_LANES
#define W_LANES 1
#include "appearance/fibre_bsdf.clh"
#include "appearance/ply_color.clh"
#include "geometry/ply_surface.clh"
#include "lights.clh"
#include "sampling/dimensions.clh"
#include "sampling/sobol.clh"
#include "stages/ask_ahead.clh"
#include "stages/continue_path.clh"
#include "stages/light_args.clh"
#include "stages/load_hit.clh"
#include "stages/path_state.clh"
#include "stages/scene_args.clh"
#include "stages/store_rays.clh"

#ifdef W_HAS_PLY_COLORS
/* Segments from color_count on have the colour of their material. */
#define W_COLOR_PARAMS __global const uint *colors, uint color_count,
#define W_COLOR_ARGS colors, color_count,
#else
#define W_COLOR_PARAMS
#define W_COLOR_ARGS
#endif

W_CALL void w_shade_fibre(const WFrame* frame, W_PATH_PARAMS, const WScene* scene, const WLights* lights,
                          __global const float* frames, uint normals, __global const WFibreMaterial* materials,
                          W_COLOR_PARAMS __global float4* aov, uint slot, uint depth) {
  const WRay ray = w_slot_ray(ray_o, ray_l, ray_d, slot);
  const WHit h = w_slot_hit(hit, hit_uv, slot);
  const WPlySurface s = w_ply_surface(scene, frames, &ray, &h, normals);
  WFibreMaterial material = materials[s.material & ~W_MATERIAL_FIBRE];
#ifdef W_HAS_PLY_COLORS
  if (s.segment < color_count && (colors[s.segment] & W_COLOR_GIVEN))
    material.transmit.xyz =
        w_float3(w_ply_color(colors[s.segment])) * (material.transmit.w != 0.0f ? material.transmit.xyz : 1.0f);
#endif
  const WFibreShade shade = w_fibre_setup(material, s.smooth_t, s.smooth_n, -ray.d);
  const w_real3 axis = s.u * s.edge;

  // Within the rounding of the lobes' energies, 2e-6.
  if (w_max3(shade.a[0] + shade.a[1]) > R(1.00001)) atomic_inc(scene->counters + W_EVENT_ENERGY);

#ifdef W_AOVS
  if (depth == 0)
    W_STORE_FEATURES(slot, shade.a[0] + shade.a[1], h.t, s.smooth_n, s.phi, s.smooth_t, s.length, s.anchor + s.x, s.ply)
#endif

  const WSampler sampler = w_sampler(w_slot_pixel(frame, wave_tiles, slot), w_slot_sample(frame, slot), frame->seed);
  const float4 u = w_sample4(&sampler, W_SET_SCATTER(depth));
  w_real left;
  const int lobe = w_fibre_choose(&shade, u.x, &left);

  uint bins = 0u;
#ifdef W_HAS_LIGHTS
  if (frame->light_sampling != 2) {
    const WLightSample l = w_light_sample(lights, s.anchor + axis, w_sample4(&sampler, W_SET_LIGHT(depth)));
    if (l.pdf > R(0.0)) {
      w_real p;
      const w_real3 f = w_fibre_eval(&shade, l.direction, &p);
      const w_real share = frame->light_sampling == 0 ? w_mis(l.pdf, p) : R(1.0);
      const w_real3 c = w_real3_of(weight[slot]) * f * l.radiance * (share / l.pdf);
      if (w_max3(c) > R(0.0)) {
        bins |= W_BIN_SHADOW;
        W_STORE_SHADOW_RAY(slot, s.anchor, axis, h.code, W_NONE, l, c)
      }
    }
  }
#endif

  const w_real3 w = w_fibre_sample(&shade, lobe, u.y, u.z, u.w, left);
  w_real density;
  const w_real3 f = w_fibre_eval(&shade, w, &density);
  // A direction whose density has underflowed was drawn from the far tail of its lobe: the lobe's own weight is exact.
  w_real3 next = w_real3_of(weight[slot]) * (density > R(1e-20) ? f / density : shade.a[lobe] / shade.q[lobe]);
  bins |= w_continue(frame, &next, depth, &sampler);
  W_STORE_PATH_RAY(slot, s.anchor, axis, h.code, W_NONE, w, density, next)
  mask[slot] = bins;
}

__kernel void shade_fibre(WFrame frame, W_PATH_PARAMS, W_SCENE_PARAMS, W_LIGHT_PARAMS, __global const float* frames,
                          uint normals, __global const WFibreMaterial* materials, W_COLOR_PARAMS __global float4* aov,
                          __global const uint* list, __global const uint* counts, uint count_index, uint depth) {
  const uint i = get_global_id(0);
  const uint count = counts[count_index];
  if (i >= count) return;
  const uint slot = list[i];
  if (w_last_ray(&frame, depth)) {
    mask[slot] = 0u;
    return;
  }
  const WScene scene = W_SCENE;
  w_ask_for_hits(&scene, frames, list, hit, i, count);
  const WLights lights = W_LIGHTS;
  w_shade_fibre(&frame, W_PATH_ARGS, &scene, &lights, frames, normals, materials, W_COLOR_ARGS aov, slot, depth);
}
