/* A path meets a ply (KNIT21 section 3.3): connect it to a light, go on along a lobe of the ply BSDF. A direction on
   the outer side of the surface leaves at the hit; any other one leaves from the middle of the chord through the ply
   (docs/appearance.md), and meets whatever lies ahead, its own segment excepted.
   A work-item shades W_LANES hits: each is found and lit on its own, and what is arithmetic, the lobes, is done for all
   of them at once, a hit a lane. */
#include "appearance/ply_bsdf.clh"
#include "appearance/ply_color.clh"
#ifdef W_GRADIENTS
#include "appearance/ply_gradient.clh"
#endif
#include "geometry/ply_surface.clh"
#include "lights.clh"
#include "sampling/dimensions.clh"
#include "sampling/sobol_lanes.clh"
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
#define W_COLORED(material, segment) \
  w_ply_colored(material, (segment) < color_count ? colors[segment] : 0u)
#else
#define W_COLOR_PARAMS
#define W_COLOR_ARGS
#define W_COLORED(material, segment) material
#endif

#ifdef W_HAS_DETAIL
#define W_DETAIL_PARAMS                                                                                              \
  __global const WFibreDetail *details, __global const uint *fibre_offsets, __global const float4 *fibre_candidates, \
      float2 pixel_width,
#define W_DETAIL_ARGS details, fibre_offsets, fibre_candidates, pixel_width,
#else
#define W_DETAIL_PARAMS
#define W_DETAIL_ARGS
#endif

#ifdef W_HAS_DETAIL
/* What of the fibre detail shows at a hit that the camera sees itself, `distance` away; later on the path nothing is
   sharp enough to tell fibres apart. */
static inline WFibreAt w_fibre_of_hit(const WPlySurface* s, W_DETAIL_PARAMS w_real tilt, w_real distance) {
  WFibreAt fibre = w_fibre_mean(tilt);
  const WFibreDetail detail = details[s->material];
  if (detail.level == W_DETAIL_NONE) return fibre;
  const int paper = detail.level == W_DETAIL_PAPER;
  const w_real2 phase = paper ? w_ellipse_phase(s) : (w_real2)(s->cos_phi, s->sin_phi);
  const w_real width = pixel_width.x + pixel_width.y * distance;
  const w_real facing = fmax(sqrt(fmax(R(1.0) - s->h * s->h, R(0.0))), R(0.05));
  const w_real diameters = width / (R(2.0) * detail.fibre_radius * s->radius * facing);
  if (paper || diameters < R(2.0))
    fibre = w_fibre_at(detail, fibre_offsets, fibre_candidates, phase.x, phase.y, s->length);
  return paper ? fibre : w_fibre_filtered(detail, fibre, diameters);
}
#endif

/* Offset from the anchor at which a direction leaves: the hit moved out by a few ulps, for those on the outer side
   of n, or the chord's middle. */
typedef struct WPlyLeave {
  w_v3 out, middle;
} WPlyLeave;

static inline WPlyLeave w_ply_leave(const WPlyHits* hits, const WPlySurfaces* s) {
  WPlyLeave from;
  const w_v3 d = hits->d;
  const w_v3 radial = w_v3_fma(-w_v3_dot(s->x, s->t), s->t, s->x);
  const w_vf along = w_v3_dot(d, s->t), sin2 = w_max(R(1.0) - along * along, w_all(R(1e-6)));
  from.out = w_v3_fma(w_all(R(9.5367432e-7)), radial, s->x);  // 4 * 2^-22: beyond the error of the hit
  from.middle = w_v3_fma(hits->radius * w_root(R(1.0) - hits->h * hits->h) / sqrt(sin2), d, s->x);
  return from;
}

#ifdef W_HAS_LIGHTS
/* A light as a hit sees it. */
typedef struct WPlyLight {
  WLightSample light;
  int inside;   /* seen from the chord's middle */
  w_real times; /* 0: not at all */
} WPlyLight;

/* One light sample seen from each of the two places a direction may leave from. Each counts only on its own side; where
   both do (a thin set), one is taken at random, by `left`, and counts twice. */
static inline WPlyLight w_ply_light(const WLights* lights, w_real3 out, w_real3 middle, w_real3 n, float4 u,
                                    w_real left) {
  WPlyLight at;
  const WLightSample a = w_light_sample(lights, out, u);
  WLightSample b = a;
  if (a.distance < R(1e29)) b = w_light_sample(lights, middle, u);  // nearer ones show a parallax
  const int a_ok = a.pdf > R(0.0) && dot(a.direction, n) > R(0.0);
  const int b_ok = b.pdf > R(0.0) && !(dot(b.direction, n) > R(0.0));
  at.inside = a_ok && b_ok ? left < R(0.5) : b_ok;
  at.light = at.inside ? b : a;
  at.times = a_ok && b_ok ? R(2.0) : a_ok || b_ok ? R(1.0) : R(0.0);
  return at;
}
#endif

/* The hits of list[0 .. count - 1], count <= W_LANES; lanes behind them repeat the last one and leave nothing. */
W_CALL void w_shade_plies(const WFrame* frame, W_PATH_PARAMS, const WScene* scene, const WLights* lights,
                          __global const float* frames, uint normals, __global const WPlyMaterial* materials,
                          W_DETAIL_PARAMS W_COLOR_PARAMS __global float4* aov, __global const uint* list, uint count,
                          uint depth) {
  WPlyHits hits;
  WSamplers samplers;
  for (uint i = 0; i < W_LANES; ++i) {
    const uint slot = list[min(i, count - 1u)];
    const WRay ray = w_slot_ray(ray_o, ray_l, ray_d, slot);
    const WHit h = w_slot_hit(hit, hit_uv, slot);
    w_ply_set_hit(scene, frames, &ray, &h, &hits, i);
    w_samplers_set_lane(
        &samplers, i, w_sampler(w_slot_pixel(frame, wave_tiles, slot), w_slot_sample(frame, slot), frame->seed));
  }
  const WPlySurfaces surface = w_ply_surfaces(&hits, normals);
  const WPlyLeave from = w_ply_leave(&hits, &surface);
  WPlyMaterialLanes material;
  for (uint i = 0; i < W_LANES; ++i)
    w_ply_material_set_lane(&material, i, W_COLORED(materials[hits.material[i]], hits.segment[i]));
  WFibreLanes fibre = w_fibre_mean_lanes(material.tilt);
#ifdef W_HAS_DETAIL
  if (depth == 0)
    for (uint i = 0; i < W_LANES; ++i) {
      const WPlySurface s = w_ply_surface_lane(&hits, &surface, i);
      w_fibre_set_lane(&fibre, i, w_fibre_of_hit(&s, W_DETAIL_ARGS w_lane_of(material.tilt, i),
                                                 w_lane_of(hits.distance, i)));
    }
#endif
  const w_v3 t = surface.smooth_t, n = surface.smooth_n, wv = w_v3_scaled(w_all(R(-1.0)), hits.d);
  const WPlyShade shade = w_ply_setup_detail(&material, t, n, wv, fibre);
#ifdef W_GRADIENTS
  const WPlyShade tilted = w_ply_setup_tilted(&material, t, n, wv, fibre);
#endif

  const w_v3 energy = w_v3_add(w_v3_add(shade.a[0], shade.a[1]), shade.a[2]);
  // Within the rounding of the lobes' energies, 2e-6.
  const uint lanes = (1u << count) - 1u, above = w_mask_bits(w_lt(w_all(R(1.00001)), w_v3_max(energy))) & lanes;
  if (above) atomic_add(scene->counters + W_EVENT_ENERGY, popcount(above));

#ifdef W_AOVS
  if (depth == 0)
    for (uint i = 0; i < count; ++i) {
      const WPlySurface s = w_ply_surface_lane(&hits, &surface, i);
      W_STORE_FEATURES(list[i], w_v3_lane(&energy, i), w_lane_of(hits.distance, i), s.smooth_n, s.phi, s.smooth_t,
                       s.length, s.anchor + s.x, s.ply)
    }
#endif

  const WNumbers u = w_samplers4(&samplers, W_SET_SCATTER(depth));
  w_vf left;
  const w_vi lobe = w_ply_choose(&shade, u.x, &left);
  uint bins[W_LANES];
  for (uint i = 0; i < count; ++i) bins[i] = 0u;

#ifdef W_HAS_LIGHTS
  if (frame->light_sampling != 2) {
    WPlyLight lit[W_LANES];
    w_v3 towards = wv;
    const WNumbers ul = w_samplers4(&samplers, W_SET_LIGHT(depth));
    for (uint i = 0; i < count; ++i) {
      const float4 at = (float4)((float)w_lane_of(ul.x, i), (float)w_lane_of(ul.y, i), (float)w_lane_of(ul.z, i),
                                 (float)w_lane_of(ul.w, i));
      const w_real3 anchor = w_v3_lane(&hits.p1, i);
      lit[i] = w_ply_light(lights, anchor + w_v3_lane(&from.out, i), anchor + w_v3_lane(&from.middle, i),
                           w_v3_lane(&surface.n, i), at, w_lane_of(left, i));
      w_v3_set_lane(&towards, i, lit[i].light.direction);
    }
    w_vf density;
    const w_v3 f = w_ply_eval(&shade, towards, &density);
#ifdef W_GRADIENTS
    const WPlyGradient g = w_ply_gradient(&shade, &tilted, material.beta_r, towards, f);
#endif
    for (uint i = 0; i < count; ++i) {
      if (lit[i].times == R(0.0)) continue;
      const uint slot = list[i];
      const WLightSample l = lit[i].light;
      const w_real share = frame->light_sampling == 0 ? w_mis(l.pdf, w_lane_of(density, i)) : R(1.0);
      const w_real3 c =
          w_real3_of(weight[slot]) * w_v3_lane(&f, i) * l.radiance * (lit[i].times * share / l.pdf);
      if (!(w_max3(c) > R(0.0))) continue;
      bins[i] = W_BIN_SHADOW;
      const w_real3 offset = lit[i].inside ? w_v3_lane(&from.middle, i) : w_v3_lane(&from.out, i);
      W_STORE_SHADOW_RAY(slot, w_v3_lane(&hits.p1, i), offset, hit[slot].z, W_NONE, l, c)
#ifdef W_GRADIENTS
      for (uint k = 0; k < W_GRADIENT_COUNT; ++k) {
        const w_real3 all = w_real3_of(score[slot * W_GRADIENT_COUNT + k]) +
                            w_ply_score(w_v3_lane(&g.d[k], i), w_v3_lane(&f, i));
        shadow_gradient[slot * W_GRADIENT_COUNT + k] = (float4)(w_float3(c * all), 0.0f);
      }
#endif
    }
  }
#endif

  const w_v3 w = w_ply_sample(&shade, lobe, u.y, u.z, u.w);
  w_vf density;
  const w_v3 f = w_ply_eval(&shade, w, &density);
  // A direction whose density has underflowed was drawn from the far tail of its lobe: the lobe's own weight is exact.
  const w_vi sound = w_lt(w_all(R(1e-20)), density);
  w_v3 ratio;
  ratio.x = w_select(w_of_lobe(lobe, shade.a[0].x, shade.a[1].x, shade.a[2].x), f.x, sound);
  ratio.y = w_select(w_of_lobe(lobe, shade.a[0].y, shade.a[1].y, shade.a[2].y), f.y, sound);
  ratio.z = w_select(w_of_lobe(lobe, shade.a[0].z, shade.a[1].z, shade.a[2].z), f.z, sound);
  ratio = w_v3_scaled(
      w_all(R(1.0)) / w_select(w_of_lobe(lobe, shade.q[0], shade.q[1], shade.q[2]), density, sound), ratio);
#ifdef W_GRADIENTS
  const WPlyGradient g = w_ply_gradient(&shade, &tilted, material.beta_r, w, f);
#endif
  const w_v3 offset = w_v3_select(from.middle, from.out, w_lt(w_all(R(0.0)), w_v3_dot(w, surface.n)));
  for (uint i = 0; i < count; ++i) {
    const uint slot = list[i];
    const w_real3 d = w_v3_lane(&w, i);
    w_real3 next = w_real3_of(weight[slot]) * w_v3_lane(&ratio, i);
#ifdef W_GRADIENTS
    for (uint k = 0; k < W_GRADIENT_COUNT; ++k)
      score[slot * W_GRADIENT_COUNT + k].xyz += w_float3(w_ply_score(w_v3_lane(&g.d[k], i), w_v3_lane(&f, i)));
#endif
    const WSampler sampler = w_samplers_lane(&samplers, i);
    bins[i] |= w_continue(frame, &next, depth, &sampler);
    W_STORE_PATH_RAY(slot, w_v3_lane(&hits.p1, i), w_v3_lane(&offset, i), hit[slot].z, W_NONE, d,
                     w_lane_of(density, i), next)
    mask[slot] = bins[i];
  }
}

__kernel void shade_ply(WFrame frame, W_PATH_PARAMS, W_SCENE_PARAMS, W_LIGHT_PARAMS, __global const float* frames,
                        uint normals, __global const WPlyMaterial* materials, W_DETAIL_PARAMS W_COLOR_PARAMS __global float4* aov,
                        __global const uint* list, __global const uint* counts, uint count_index, uint depth) {
  const uint first = get_global_id(0) * W_LANES, end = counts[count_index];
  if (first >= end) return;
  const uint count = min(end - first, (uint)W_LANES);
  if (w_last_ray(&frame, depth)) {
    for (uint i = first; i < first + count; ++i) mask[list[i]] = 0u;
    return;
  }
  const WScene scene = W_SCENE;
  for (uint i = first; i < first + count; ++i) w_ask_for_hits(&scene, frames, list, hit, i, end);
  const WLights lights = W_LIGHTS;
  w_shade_plies(&frame, W_PATH_ARGS, &scene, &lights, frames, normals, materials, W_DETAIL_ARGS W_COLOR_ARGS aov,
                list + first, count, depth);
}
