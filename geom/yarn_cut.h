#pragma once
#include "geom/fabric.h"
#include "geom/fabric_map.h"
#include "geom/fibre_bundle.h"
#include "geom/strain_field.h"

namespace wale {

/// What is left of a few yarns: their runs, counted from their own first vertex and place, and what Fabric and its
/// report take of them.
struct CutYarns {
  std::vector<PlyRun> runs;
  std::vector<Anchor> anchors;
  std::vector<StrandPlace> place;
  std::vector<dvec2> uv;  ///< per vertex, in the flat knit
  size_t yarns = 0, flyaways = 0, samples_outside = 0, samples_extrapolated = 0, jumps_cut = 0;
  StrainReport strain;
};

/// Where yarns are cut: one chart of a fabric whose mesh, charts, scales and radii are known.
struct YarnCutting {
  const Fabric& fabric;
  uint32_t chart;
  const ChartMap& map;
  const FabricSpec& spec;
  const FibreBundle* bundle;   ///< the fibres of its plies, where they are explicit
  double flyaway_radius;       ///< metres, 0 where there are none
  const StrainTable* strains;  ///< of the tile, where its loops follow the strain of the cloth; else null
};

/// Cuts all yarns of a chart and appends them to its fabric, in their order, and to `uv` per vertex; on `threads`
/// threads, which change nothing.
void cut_yarns(Fabric& fabric, const YarnCutting& cutting, const FlatKnit& knit, unsigned threads,
               std::vector<dvec2>& uv);

/// Ties yarns of one chart to the mesh and cuts them where the cloth ends: what lies on the chart or within half a
/// stitch of its border stays.
class YarnCutter {
 public:
  /// `first_yarn`: number of the first yarn of all that is added. `field`: where yarns follow it, else null.
  YarnCutter(const YarnCutting& cutting, const ChartLocator& locator, const StrainField* field, size_t first_yarn);
  /// Moves the yarn where it follows the strain of the cloth.
  void add(FlatYarn& yarn);
  /// All that has been added.
  CutYarns take() { return std::move(out_); }

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
  /// Samples begin, begin+1, ... of a yarn; a closed yarn's continue past its end by whole laps.
  struct Stretch {
    size_t begin, count;
    bool ghost_ends;
  };
  /// Sample of the yarn that a stretch's sample repeats, and the laps in between.
  struct Place {
    size_t k;
    double laps;
  };
  static Place place_in(const FlatYarn& yarn, size_t sample);
  StoredLength length_of(const FlatYarn& yarn, size_t ply, double& lap) const;
  void find_shifts(const FlatYarn& yarn);
  void follow_strain(FlatYarn& yarn);
  void add_places(const FlatYarn& yarn, const Stretch& stretch);
  void add_runs(const FlatYarn& yarn, const Stretch& stretch);
  void add_ply_run(const FlatYarn& yarn, const Stretch& stretch);
  void add_fibre_runs(const FlatYarn& yarn, const Stretch& stretch);
  void add_flyaways(const FlatYarn& yarn, const Stretch& stretch);
  void begin_run(const Stretch& stretch, PlyRun::Kind kind, size_t curves, double radius);
  void add_vertex(const Place& place, const dvec3& position, const dvec3& normal, float length);
  Anchor anchor_of(const dvec3& position, const dvec3& normal, const Sample& centre, dvec2 uv) const;

  uint32_t yarn_number() const { return static_cast<uint32_t>(first_yarn_ + out_.yarns); }

  const Fabric& fabric_;
  const uint32_t chart_;
  const ChartMap& map_;
  const FabricSpec& spec_;
  const FibreBundle* bundle_;
  const double flyaway_radius_;
  const ChartLocator& locator_;
  const StrainTable* strains_;
  const StrainField* field_;
  const size_t first_yarn_;
  CutYarns out_;
  std::vector<Sample> samples_;
  dvec2 lap_{0, 0};  ///< UV of one lap of a closed yarn
  std::vector<uint32_t> fibre_order_, fibre_groups_;
  std::vector<dvec3> shift_, unstrained_, tangent_, strained_tangent_;  ///< of follow_strain
  double strand_ = 0;                                                   ///< metres of yarn laid so far
  uint32_t color_ = 0;        ///< of the yarn that is being added
  uint32_t first_place_ = 0;                                            ///< of the stretch that is being added
};

}  // namespace wale
