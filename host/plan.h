#pragma once
#include <map>
#include <string>
#include <vector>

#include "host/features.h"
#include "host/price_class.h"
#include "host/scene_device.h"
#include "host/world.h"

namespace wale {

/// What a render of a scene would do on a device, and why; nothing is traced for it. `also`: RenderOptions::also.
struct Plan {
  struct Program {
    std::string file;  ///< below kernels/
    std::vector<std::string> kernels;
    bool built = false, launched = false;
    std::string because;
  };
  struct Accuracy {
    std::string option, level, doc;
    PriceClass price;
  };
  struct Feature : Reason {
    bool built = false;  ///< also where the scene does not call for it
  };
  std::vector<Feature> features;
  std::vector<Dropped> dropped;  ///< what the scene has and what cannot matter
  std::vector<Program> programs;
  std::string options;                      ///< of the kernels' compiler
  std::map<std::string, uint64_t> buffers;  ///< bytes on the device
  std::vector<Accuracy> accuracy;

  uint64_t bytes() const;
};

Plan plan_render(const Device& device, const Scene& scene, const World& world, const SceneDevice& on_device,
                 const Features& also = {});

std::string plan_text(const Plan& plan);
std::string plan_json(const Plan& plan);

}  // namespace wale
