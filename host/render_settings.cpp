// What a scene and the options of a render say to the device.
#include "geom/error.h"
#include "host/render.h"

namespace wale {

WFrame frame_of(const World& world, const IntegratorScene& integrator) {
  WFrame frame{};
  frame.seed = integrator.seed;
  frame.max_depth = uint32_t(integrator.max_depth);
  frame.roulette_depth = uint32_t(integrator.russian_roulette_depth);
  frame.light_sampling = integrator.light_sampling == "mis" ? 0 : integrator.light_sampling == "light" ? 1 : 2;
  if (world.first_hits_only) {  // a path that samples lights only ends with its last scattering event
    frame.max_depth = 1;
    frame.light_sampling = 1;
  }
  frame.opaque_shadows = integrator.ply_shadows == "opaque";
  frame.lights = uint32_t(world.lights.lights.size());
  frame.spheres = uint32_t(world.spheres.size());
  return frame;
}

uint32_t pool_of(const DeviceTraits& traits, const IntegratorScene& integrator, const RenderOptions& options) {
  return options.pool ? options.pool : integrator.pool ? integrator.pool : traits.pool;
}

Features features_of(const DeviceTraits& traits, const World& world, const IntegratorScene& integrator,
                     const RenderOptions& options) {
  Features features = analyse(world, integrator, options.aovs, traits).with(options.also);
  features.gradients |= options.gradients;
  if (features.gradients && (features.aovs || features.fibres))
    bug("render: derivatives beside feature images, or of single fibres");
  return features;
}

}  // namespace wale
