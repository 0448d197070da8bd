// All yarns of a chart, a few at a time on each thread, put together in their order.
#include <algorithm>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>

#include "geom/run_tasks.h"
#include "geom/yarn_cut.h"

namespace wale {
namespace {

/// Batches that a thread gets on average, so that all end together.
constexpr size_t kBatches = 8;

template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void append(Fabric& fabric, std::vector<dvec2>& uv, CutYarns&& cut) {
  const auto first_vertex = static_cast<uint32_t>(fabric.anchors.size());
  const auto first_place = static_cast<uint32_t>(fabric.place.size());
  for (PlyRun& run : cut.runs) {
    run.first_vertex += first_vertex;
    run.first_place += first_place;
  }
  append(fabric.runs, cut.runs);
  append(fabric.anchors, cut.anchors);
  append(fabric.place, cut.place);
  append(uv, cut.uv);
  fabric.report.full_yarns += cut.yarns;
  fabric.report.flyaways += cut.flyaways;
  fabric.report.samples_outside += cut.samples_outside;
  fabric.report.samples_extrapolated += cut.samples_extrapolated;
  fabric.report.jumps_cut += cut.jumps_cut;
  fabric.report.strain.add(cut.strain);
}

}  // namespace

void cut_yarns(Fabric& fabric, const YarnCutting& cutting, const FlatKnit& knit, unsigned threads,
               std::vector<dvec2>& uv) {
  const ChartLocator locator(fabric.mesh, fabric.charts[cutting.chart]);
  std::optional<StrainField> field;
  if (cutting.strains) {
    const ChartMap& map = cutting.map;
    field.emplace(fabric.mesh, fabric.charts[cutting.chart], map.metric * map.scale.z / dvec2(map.scale));
  }
  const size_t yarns = knit.yarns(), first_yarn = fabric.report.full_yarns;
  // A strand goes on from yarn to yarn: where places on it are asked for, they are laid one after the other.
  const size_t batches = cutting.spec.places ? 1 : std::max<size_t>(1, std::min(yarns, kBatches * threads));
  std::mutex mutex;
  std::map<size_t, CutYarns> done;  // batches that wait for an earlier one
  size_t next = 0;
  std::vector<size_t> tasks(batches);  // taken from the back
  std::iota(tasks.rbegin(), tasks.rend(), size_t(0));
  run_tasks(threads, std::move(tasks), [&](size_t batch, const auto&) {
    const size_t begin = yarns * batch / batches, end = yarns * (batch + 1) / batches;
    YarnCutter cutter(cutting, locator, field ? &*field : nullptr, first_yarn + begin);
    FlatYarn yarn;
    for (size_t i = begin; i < end; ++i) {
      knit.lay(i, yarn);
      cutter.add(yarn);
    }
    const std::lock_guard lock(mutex);
    done.emplace(batch, cutter.take());
    for (auto at = done.begin(); at != done.end() && at->first == next; at = done.erase(at), ++next)
      append(fabric, uv, std::move(at->second));
  });
}

}  // namespace wale
