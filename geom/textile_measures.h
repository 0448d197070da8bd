#pragma once
#include "geom/fabric.h"

namespace wale {

/// What a ply's yarn is made of.
struct YarnSubstance {
  double density = 1310;  ///< of the fibres, kg/m^3
  double packing = 0.5;   ///< share of a ply's section that is fibre
};

/// Figures that textile technologists state of a knitted cloth. SI units.
struct TextileMeasures {
  double yarn_per_stitch = 0;  ///< metres: the loop length
  double ply_per_yarn = 0;     ///< metres of each ply in a metre of yarn: the twist's take-up
  double yarn_mass = 0;        ///< kg per metre of yarn; times 1e6 in tex
  double area_mass = 0;        ///< kg per square metre of cloth
  double cover = 0;            ///< share of the flat cloth that plies hide, seen straight on
  double tex() const { return 1e6 * yarn_mass; }
  /// Munden's tightness factor sqrt(tex) / loop length in cm.
  double tightness() const;
};

/// Measures one tile region of the flat knit, in double. `tile` is the size of a tile in the cloth, metres, and `yarn`
/// how plies lie in the cloth; the tolerance with which curves are followed is this function's own. Cover is counted on
/// a raster of `raster` x `raster` points over four by four tiles; plies are the tubes that are traced.
TextileMeasures measure_textile(const Pattern& pattern, const YarnSpec& yarn, dvec2 tile,
                                const YarnSubstance& substance, int raster = 1024);

/// The same of a knitted fabric: of its mean tile.
TextileMeasures measure_textile(const Fabric& fabric, const Pattern& pattern, const FabricSpec& spec,
                                const YarnSubstance& substance);

}  // namespace wale
