#pragma once
#include "geom/fabric.h"
#include "geom/fabric_map.h"

namespace wale {

/// Ties the yarns of one chart to the mesh and cuts them where the cloth ends: what lies on the chart or within half a
/// stitch of its border stays. Appends to the fabric's runs, anchors and counters, and to `uv` per vertex.
class YarnCutter {
 public:
  YarnCutter(Fabric& fabric, uint32_t chart, const ChartMap& map, double height_offset, std::vector<dvec2>& uv);
  void add(const FlatYarn& yarn);

 private:
  struct Sample {
    ChartPoint at;
    dvec2 uv{0, 0};
    dvec3 point{0, 0, 0};  ///< on the mesh, where kept
    bool kept = false;
    bool cut_before = false;
  };

  Sample locate_sample(dvec3 centre) const;
  bool jumps(const Sample& a, const Sample& b) const;
  ChartPoint extrapolate(const Sample& from, dvec2 uv) const;
  /// Appends the samples begin, begin+1, ... of a yarn; a closed yarn's continue past its end by whole laps.
  void add_run(const FlatYarn& yarn, size_t begin, size_t count, bool ghost_ends);
  void add_places(const FlatYarn& yarn, size_t begin, size_t count, bool ghost_ends);
  Anchor anchor_of(const FlatYarn& yarn, size_t vertex, const Sample& centre, dvec2 uv) const;

  Fabric& fabric_;
  const uint32_t chart_;
  const ChartMap& map_;
  const double height_offset_;
  std::vector<dvec2>& uv_;
  const ChartLocator locator_;
  std::vector<Sample> samples_;
  double strand_ = 0;  ///< metres of yarn laid so far
};

}  // namespace wale
