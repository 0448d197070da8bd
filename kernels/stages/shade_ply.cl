/* A path meets a ply (KNIT21 section 3.3): connect it to a light, go on along a lobe of the ply BSDF. A direction on
   the outer side of the surface leaves at the hit; any other one leaves from the middle of the chord through the ply
   (docs/appearance.md), and meets whatever lies ahead, its own segment excepted. */
#include "appearance/ply_bsdf.clh"
#include "appearance/ply_color.clh"
#ifdef W_GRADIENTS
#include "appearance/ply_gradient.clh"
#endif
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

/* Offset from the anchor at which a direction leaves: the hit moved out by a few ulps, or the chord's middle. */
static inline w_real3 w_leave(const WPlySurface* s, w_real3 out, w_real3 middle, w_real3 w) {
  return dot(w, s->n) > R(0.0) ? out : middle;
}

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

W_CALL void w_shade_ply(const WFrame* frame, W_PATH_PARAMS, const WScene* scene, const WLights* lights,
                        __global const float* frames, uint normals, __global const WPlyMaterial* materials,
                        W_DETAIL_PARAMS W_COLOR_PARAMS __global float4* aov, uint slot, uint depth) {
  const WRay ray = w_slot_ray(ray_o, ray_l, ray_d, slot);
  const WHit h = w_slot_hit(hit, hit_uv, slot);
  const WPlySurface s = w_ply_surface(scene, frames, &ray, &h, normals);
  const w_real3 wv = -ray.d;
  const WPlyMaterial material = W_COLORED(materials[s.material], s.segment);
  WFibreAt fibre = w_fibre_mean(material.tilt);
#ifdef W_HAS_DETAIL
  // What the camera sees itself; later on the path nothing is sharp enough to tell fibres apart.
  if (depth == 0 && details[s.material].level != W_DETAIL_NONE) {
    const WFibreDetail detail = details[s.material];
    const int paper = detail.level == W_DETAIL_PAPER;
    const w_real2 phase = paper ? w_ellipse_phase(&s) : (w_real2)(s.cos_phi, s.sin_phi);
    const w_real width = pixel_width.x + pixel_width.y * h.t;
    const w_real facing = fmax(sqrt(fmax(R(1.0) - s.h * s.h, R(0.0))), R(0.05));
    const w_real diameters = width / (R(2.0) * detail.fibre_radius * s.radius * facing);
    if (paper || diameters < R(2.0))
      fibre = w_fibre_at(detail, fibre_offsets, fibre_candidates, phase.x, phase.y, s.length);
    if (!paper) fibre = w_fibre_filtered(detail, fibre, diameters);
  }
#endif
  const WPlyShade shade = w_ply_setup_detail(material, s.smooth_t, s.smooth_n, wv, fibre);

#ifdef W_GRADIENTS
  const WPlyShade tilted = w_ply_setup_tilted(material, s.smooth_t, s.smooth_n, wv, fibre);
#endif

  // Within the rounding of the lobes' energies, 2e-6.
  if (w_max3(shade.a[0] + shade.a[1] + shade.a[2]) > R(1.00001)) atomic_inc(scene->counters + W_EVENT_ENERGY);

#ifdef W_AOVS
  if (depth == 0)
    W_STORE_FEATURES(slot, shade.a[0] + shade.a[1] + shade.a[2], h.t, s.smooth_n, s.phi, s.smooth_t, s.length,
                     s.anchor + s.x, s.ply)
#endif

  const WSampler sampler = w_sampler(w_slot_pixel(frame, wave_tiles, slot), w_slot_sample(frame, slot), frame->seed);
  const float4 u = w_sample4(&sampler, W_SET_SCATTER(depth));
  w_real left;
  const int lobe = w_ply_choose(&shade, u.x, &left);

  const w_real3 radial = s.x - s.t * dot(s.x, s.t);
  const w_real3 out = s.x + radial * R(9.5367432e-7);  // 4 * 2^-22: beyond the error of the hit
  const w_real sin2 = fmax(R(1.0) - dot(ray.d, s.t) * dot(ray.d, s.t), R(1e-6));
  const w_real3 middle = s.x + ray.d * (s.radius * sqrt(fmax(R(0.0), R(1.0) - s.h * s.h)) * rsqrt(sin2));

  uint bins = 0u;
#ifdef W_HAS_LIGHTS
  if (frame->light_sampling != 2) {
    // One light sample seen from each of the two places a direction may leave from. Each counts only on its own side;
    // where both do (a thin set), one is taken at random and counts twice.
    const float4 ul = w_sample4(&sampler, W_SET_LIGHT(depth));
    const WLightSample a = w_light_sample(lights, s.anchor + out, ul);
    WLightSample b = a;
    if (a.distance < R(1e29)) b = w_light_sample(lights, s.anchor + middle, ul);  // nearer lights show a parallax
    const int a_ok = a.pdf > R(0.0) && dot(a.direction, s.n) > R(0.0);
    const int b_ok = b.pdf > R(0.0) && !(dot(b.direction, s.n) > R(0.0));
    if (a_ok || b_ok) {
      const int take_b = a_ok && b_ok ? left < R(0.5) : b_ok;
      const WLightSample l = take_b ? b : a;
      const w_real twice = a_ok && b_ok ? R(2.0) : R(1.0);
      w_real p;
      const w_real3 f = w_ply_eval(&shade, l.direction, &p);
      const w_real share = frame->light_sampling == 0 ? w_mis(l.pdf, p) : R(1.0);
      const w_real3 c = w_real3_of(weight[slot]) * f * l.radiance * (twice * share / l.pdf);
      if (w_max3(c) > R(0.0)) {
        bins |= W_BIN_SHADOW;
        W_STORE_SHADOW_RAY(slot, s.anchor, take_b ? middle : out, h.code, W_NONE, l, c)
#ifdef W_GRADIENTS
        const WPlyGradient g = w_ply_gradient(&shade, &tilted, material.beta_r, l.direction, f);
        for (uint k = 0; k < W_GRADIENT_COUNT; ++k) {
          const w_real3 all = w_real3_of(score[slot * W_GRADIENT_COUNT + k]) + w_ply_score(g.d[k], f);
          shadow_gradient[slot * W_GRADIENT_COUNT + k] = (float4)(w_float3(c * all), 0.0f);
        }
#endif
      }
    }
  }
#endif

  const w_real3 w = w_ply_sample(&shade, lobe, u.y, u.z, u.w);
  w_real density;
  const w_real3 f = w_ply_eval(&shade, w, &density);
  // A direction whose density has underflowed was drawn from the far tail of its lobe: the lobe's own weight is exact.
  w_real3 next = w_real3_of(weight[slot]) * (density > R(1e-20) ? f / density : shade.a[lobe] / shade.q[lobe]);
#ifdef W_GRADIENTS
  const WPlyGradient g = w_ply_gradient(&shade, &tilted, material.beta_r, w, f);
  for (uint k = 0; k < W_GRADIENT_COUNT; ++k)
    score[slot * W_GRADIENT_COUNT + k].xyz += w_float3(w_ply_score(g.d[k], f));
#endif
  bins |= w_continue(frame, &next, depth, &sampler);
  W_STORE_PATH_RAY(slot, s.anchor, w_leave(&s, out, middle, w), h.code, W_NONE, w, density, next)
  mask[slot] = bins;
}

__kernel void shade_ply(WFrame frame, W_PATH_PARAMS, W_SCENE_PARAMS, W_LIGHT_PARAMS, __global const float* frames,
                        uint normals, __global const WPlyMaterial* materials, W_DETAIL_PARAMS W_COLOR_PARAMS __global float4* aov,
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
  w_shade_ply(&frame, W_PATH_ARGS, &scene, &lights, frames, normals, materials, W_DETAIL_ARGS W_COLOR_ARGS aov, slot, depth);
}
