// Every stage compiles in every variant that a scene can ask for, without a warning.
#include <gtest/gtest.h>

#include "host/program.h"

namespace wale {
namespace {

class StagesCompile : public testing::TestWithParam<const char*> {};

TEST_P(StagesCompile, InAllVariants) {
  const Device device = Device::open();
  const std::string all =
      " -DW_HAS_PLIES -DW_HAS_TRIANGLES -DW_HAS_SPHERES -DW_HAS_ENVIRONMENT -DW_HAS_LIGHTS -DW_AOVS -DW_HAS_PLY_COLORS";
  for (const std::string& options :
       {std::string("-DW_LANES=1 -DW_LOCAL_STAGE=0"), "-DW_LANES=8 -DW_LOCAL_STAGE=1" + all,
        "-DW_LANES=16 -DW_LOCAL_STAGE=2" + all, "-DW_LANES=16 -DW_LOCAL_STAGE=0" + all,
        "-DW_LANES=16 -DW_LOCAL_STAGE=0 -DW_HAS_FIBRES" + all, "-DW_LANES=16 -DW_HAS_PROCEDURAL -DW_HAS_FIBRES" + all,
        "-DW_LANES=1 -DW_DOUBLE -DW_HAS_PROCEDURAL -DW_HAS_FIBRES -DW_HAS_DETAIL" + all,
        "-DW_LANES=1 -DW_HAS_PROCEDURAL" + all, "-DW_LANES=16 -DW_QUANTISED_VERTICES -DW_HAS_FIBRES" + all, "-DW_LANES=16 -DW_SPLIT_LEAVES -DW_HAS_PROCEDURAL" + all,
        "-DW_LANES=1 -DW_SIMT -DW_SPLIT_LEAVES -DW_HAS_PROCEDURAL -DW_HAS_FIBRES" + all}) {
    const cl::Program program = build_program(device, GetParam(), options);
    EXPECT_EQ(program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.id()).find("warning"), std::string::npos)
        << program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.id());
  }
}

INSTANTIATE_TEST_SUITE_P(All, StagesCompile,
                         testing::Values("stages/generate.cl", "stages/intersect.cl", "stages/miss.cl",
                                         "stages/shade_ply.cl", "stages/shade_fibre.cl", "stages/shade_surface.cl",
                                         "stages/connect.cl", "stages/compact.cl", "stages/accumulate.cl",
                                         "stages/accumulate_aov.cl", "stages/intersect_packets.cl", "stages/paths.cl",
                                         "stages/trace.cl"));

}  // namespace
}  // namespace wale
