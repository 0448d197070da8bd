/* A path meets a prop, the ground or the surface of a light. */
#include "appearance/surface.clh"
#include "geometry/scene.clh"
#include "lights.clh"
#include "sampling/dimensions.clh"
#include "sampling/sobol.clh"
#include "stages/continue_path.clh"
#include "stages/light_args.clh"
#include "stages/path_state.clh"
#include "stages/store_rays.clh"

/* Per triangle: corners 9, corner normals 9, material 1, unused 1. */
#define W_TRIANGLE_WORDS 20

W_CALL void w_shade_surface(const WFrame* frame, W_PATH_PARAMS, const WLights* lights, __global const float* triangles,
                            __global const WSphere* spheres, __global const WSurfaceMaterial* materials,
                            __global float4* aov, uint slot, uint depth) {
  const uint4 raw = hit[slot];
  const float2 uv = hit_uv[slot];
  const w_real3 d = w_real3_of(ray_d[slot]);
  const w_real density = ray_d[slot].w;
  const w_real t = as_float(raw.x);
  const w_real3 from = w_real3_of(ray_o[slot]) + w_real3_of(ray_l[slot]);

  w_real3 p, ng, ns;
  uint material, skip = W_NONE;
  if (raw.y == W_HIT_TRIANGLE) {
    __global const float* v = triangles + (ulong)raw.z * W_TRIANGLE_WORDS;
    const w_real3 a = w_real3_from(vload3(0, v)), b = w_real3_from(vload3(1, v)), c = w_real3_from(vload3(2, v));
    p = a + uv.x * (b - a) + uv.y * (c - a);
    ng = normalize(cross(b - a, c - a));
    ns = (R(1.0) - uv.x - uv.y) * w_real3_from(vload3(3, v)) + uv.x * w_real3_from(vload3(4, v)) +
         uv.y * w_real3_from(vload3(5, v));
    ns = dot(ns, ns) > R(0.0) ? normalize(ns) : ng;
    material = as_uint(v[18]);
    skip = raw.z;
  } else {
    const WSphere sphere = spheres[raw.z];
    ng = w_unit(from + t * d - w_real3_of(sphere.center));
    ns = ng;
    p = w_real3_of(sphere.center) + sphere.center.w * ng;
    material = (uint)sphere.material;
    skip = W_SKIP_SPHERE | raw.z;
  }
  const WSurfaceMaterial m = materials[material];
  const int front = dot(ng, d) < R(0.0);

  w_real3 gathered = w_real3_of(radiance[slot]);
  if (w_max3(w_real3_of(m.emission)) > R(0.0) && (front || !(m.emission.w != R(0.0)))) {
    w_real share = R(1.0);
    if (density >= R(0.0) && frame->light_sampling == 1) share = R(0.0);
    if (density >= R(0.0) && frame->light_sampling == 0 && m.light >= 0) {
      const w_real pdf = raw.y == W_HIT_TRIANGLE ? w_light_pdf_triangle(lights, (uint)m.light, ng, d, t)
                                                : w_light_pdf_sphere(lights, (uint)m.light, from, d, t);
      share = w_mis(density, pdf);
    }
    const w_real3 c = w_real3_of(weight[slot]) * w_real3_of(m.emission) * share;
    gathered += c;
    radiance[slot].xyz = w_float3(gathered);
    W_ADD_GRADIENTS(slot, c)
  }

  const w_real3 n_geo = front ? ng : -ng;
  w_real3 n = dot(ns, n_geo) < R(0.0) ? -ns : ns;
  // A shading normal that faces away from the viewer would lose energy: lean it back to grazing.
  const w_real facing = dot(n, d);
  if (facing > -R(1e-3)) n = w_unit(n - d * (facing + R(1e-3)));

#ifdef W_AOVS
  const w_real3 none = (w_real3)(R(0.0));
  if (depth == 0) W_STORE_FEATURES(slot, w_real3_of(m.color), t, n, uv.x, none, uv.y, p, W_NONE)
#endif

  // Rounding of the hit: a few ulps of the largest coordinate and of the way travelled.
  const w_real reach = fmax(fmax(fabs(p.x), fabs(p.y)), fmax(fabs(p.z), t));
  const w_real3 lift = n_geo * (reach * R(4e-7));
  const WSampler sampler = w_sampler(w_slot_pixel(frame, wave_tiles, slot), w_slot_sample(frame, slot), frame->seed);
  const float4 u = w_sample4(&sampler, W_SET_SCATTER(depth));
  const w_real3 wv = -d;

  uint bins = 0u;
  if (!w_last_ray(frame, depth) && (w_max3(w_real3_of(m.color)) > R(0.0) || m.kind != 0)) {
#ifdef W_HAS_LIGHTS
    if (frame->light_sampling != 2) {
      const WLightSample l = w_light_sample(lights, p, w_sample4(&sampler, W_SET_LIGHT(depth)));
      if (l.pdf > R(0.0) && dot(l.direction, n_geo) > R(0.0)) {
        w_real pdf;
        const w_real3 f = w_surface_eval(m, n, wv, l.direction, &pdf);
        const w_real share = frame->light_sampling == 0 ? w_mis(l.pdf, pdf) : R(1.0);
        const w_real3 c = w_real3_of(weight[slot]) * f * l.radiance * (share / l.pdf);
        if (w_max3(c) > R(0.0)) {
          bins |= W_BIN_SHADOW;
          W_STORE_SHADOW_RAY(slot, p, lift, W_NONE, skip, l, c)
#ifdef W_GRADIENTS
          for (uint k = slot * W_GRADIENT_COUNT; k < (slot + 1) * W_GRADIENT_COUNT; ++k)
            shadow_gradient[k] = (float4)(w_float3(c) * score[k].xyz, 0.0f);
#endif
        }
      }
    }
#endif
    w_real3 w;
    w_real pdf;
    w_real3 next = w_real3_of(weight[slot]) * w_surface_sample(m, n, wv, u.x, u.y, u.z, &w, &pdf);
    if (pdf > R(0.0) && dot(w, n_geo) > R(0.0)) {
      bins |= w_continue(frame, &next, depth, &sampler);
      W_STORE_PATH_RAY(slot, p, lift, W_NONE, skip, w, pdf, next)
    }
  }
  mask[slot] = bins;
}

__kernel void shade_surface(WFrame frame, W_PATH_PARAMS, W_LIGHT_PARAMS, __global const float* triangles,
                            __global const WSphere* spheres, __global const WSurfaceMaterial* materials,
                            __global float4* aov, __global const uint* list, __global const uint* counts,
                            uint count_index, uint depth) {
  const uint i = get_global_id(0);
  if (i >= counts[count_index]) return;
  const WLights lights = W_LIGHTS;
  w_shade_surface(&frame, W_PATH_ARGS, &lights, triangles, spheres, materials, aov, list[i], depth);
}
