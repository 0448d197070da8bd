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
  const float3 d = ray_d[slot].xyz;
  const float density = ray_d[slot].w;
  const float t = as_float(raw.x);
  const float3 from = ray_o[slot].xyz + ray_l[slot].xyz;

  float3 p, ng, ns;
  uint material, skip = W_NONE;
  if (raw.y == W_HIT_TRIANGLE) {
    __global const float* v = triangles + (ulong)raw.z * W_TRIANGLE_WORDS;
    const float3 a = vload3(0, v), b = vload3(1, v), c = vload3(2, v);
    p = a + uv.x * (b - a) + uv.y * (c - a);
    ng = normalize(cross(b - a, c - a));
    ns = (1.0f - uv.x - uv.y) * vload3(3, v) + uv.x * vload3(4, v) + uv.y * vload3(5, v);
    ns = dot(ns, ns) > 0.0f ? normalize(ns) : ng;
    material = as_uint(v[18]);
    skip = raw.z;
  } else {
    const WSphere sphere = spheres[raw.z];
    ng = w_unit(from + t * d - sphere.center.xyz);
    ns = ng;
    p = sphere.center.xyz + sphere.center.w * ng;
    material = (uint)sphere.material;
    skip = W_SKIP_SPHERE | raw.z;
  }
  const WSurfaceMaterial m = materials[material];
  const int front = dot(ng, d) < 0.0f;

  float3 gathered = radiance[slot].xyz;
  if (w_max3(m.emission.xyz) > 0.0f && (front || !(m.emission.w != 0.0f))) {
    float share = 1.0f;
    if (density >= 0.0f && frame->light_sampling == 1) share = 0.0f;
    if (density >= 0.0f && frame->light_sampling == 0 && m.light >= 0) {
      const float pdf = raw.y == W_HIT_TRIANGLE ? w_light_pdf_triangle(lights, (uint)m.light, ng, d, t)
                                                : w_light_pdf_sphere(lights, (uint)m.light, from, d, t);
      share = w_mis(density, pdf);
    }
    gathered += weight[slot].xyz * m.emission.xyz * share;
    radiance[slot].xyz = gathered;
  }

  const float3 n_geo = front ? ng : -ng;
  float3 n = dot(ns, n_geo) < 0.0f ? -ns : ns;
  // A shading normal that faces away from the viewer would lose energy: lean it back to grazing.
  const float facing = dot(n, d);
  if (facing > -1e-3f) n = w_unit(n - d * (facing + 1e-3f));

#ifdef W_AOVS
  const float3 none = (float3)(0.0f);
  if (depth == 0) W_STORE_FEATURES(slot, m.color.xyz, t, n, uv.x, none, uv.y, p, W_NONE)
#endif

  // Rounding of the hit: a few ulps of the largest coordinate and of the way travelled.
  const float reach = fmax(fmax(fabs(p.x), fabs(p.y)), fmax(fabs(p.z), t));
  const float3 lift = n_geo * (reach * 4e-7f);
  const WSampler sampler = w_sampler(w_slot_pixel(frame, wave_tiles, slot), w_slot_sample(frame, slot), frame->seed);
  const float4 u = w_sample4(&sampler, W_SET_SCATTER(depth));
  const float3 wv = -d;

  uint bins = 0u;
  if (!w_last_ray(frame, depth) && (w_max3(m.color.xyz) > 0.0f || m.kind != 0)) {
#ifdef W_HAS_LIGHTS
    if (frame->light_sampling != 2) {
      const WLightSample l = w_light_sample(lights, p, w_sample4(&sampler, W_SET_LIGHT(depth)));
      if (l.pdf > 0.0f && dot(l.direction, n_geo) > 0.0f) {
        float pdf;
        const float3 f = w_surface_eval(m, n, wv, l.direction, &pdf);
        const float share = frame->light_sampling == 0 ? w_mis(l.pdf, pdf) : 1.0f;
        const float3 c = weight[slot].xyz * f * l.radiance * (share / l.pdf);
        if (w_max3(c) > 0.0f) {
          bins |= W_BIN_SHADOW;
          W_STORE_SHADOW_RAY(slot, p, lift, W_NONE, skip, l, c)
        }
      }
    }
#endif
    float3 w;
    float pdf;
    float3 next = weight[slot].xyz * w_surface_sample(m, n, wv, u.x, u.y, u.z, &w, &pdf);
    if (pdf > 0.0f && dot(w, n_geo) > 0.0f) {
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
