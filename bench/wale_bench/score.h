#pragma once
#include <map>
#include <string>

#include "bench/wale_bench/measure.h"
#include "bench/wale_bench/picture_check.h"

namespace wale::bench {

/// The one figure of the frozen workload: 100 times the geometric mean of a device's speeds over fixed ones, those of
/// two cores of an AVX-512 CPU under PoCL 3.1 on the day that v1 was frozen (kReferenceSpeeds in score.cpp). Its parts:
/// Mrays/s of primary, bounce and opaque shadow rays and of attenuated shadow rays, and samples per second of the whole
/// render. On a GPU seconds are those of the device's clock. On a CPU, which other programs share, they are the CPU
/// seconds of all threads divided by the number of compute units: what an idle machine would take.
struct Score {
  double score = 0;
  std::map<std::string, double> speeds;  ///< per second: million rays, and thousand samples
  bool verified = false;                 ///< every row, and the picture
  PictureCheck picture;
};

/// Median seconds that count: see Score.
double counted_seconds(const Device& device, const std::vector<double>& by_device, const std::vector<double>& cpu);

/// Renders the frozen workload's picture and compares it with the reference.
PictureCheck check_picture(const Device& device, const std::filesystem::path& kernel_dir);
TileMeans render_picture(const Device& device, int spp, uint32_t seed, const std::filesystem::path& kernel_dir);

Score score_of(const Device& device, const FabricResult& result, const PictureCheck& picture);

}  // namespace wale::bench
