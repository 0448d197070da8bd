#include "geom/chart/loop_curves.h"
#include "geom/chart/loops.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/targets.h"

namespace wale::fuzz {
namespace {

// What is accepted has as many loops below each row as it takes, and as many yarns as it names; loops are taken above
// where they are made; small ones become finite curves. It reads back from its own lines.
bool read(std::string_view bytes, const std::filesystem::path& file) {
  return accepted([&] {
    const StitchChart chart = parse_chart(bytes, file);
    int below = chart.rows.back().makes();
    for (const ChartRow& row : chart.rows) {
      expect(row.takes() == below && row.makes() == chart.wales(), "loops do not match");
      expect(int(row.yarn.size()) == chart.wales(), "stitches without yarn");
      for (const int yarn : row.yarn) expect(yarn >= 0 && size_t(yarn) < chart.yarns.size(), "no such yarn");
      below = row.makes();
    }
    std::string again;
    for (const std::string& line : chart_lines(chart)) again += line + "\n";
    expect(chart_lines(parse_chart(again, "again.chart")) == chart_lines(chart), "its lines say something else");
    const Knit knit = knit_chart(chart);
    for (const Loop& loop : knit.loops) expect(loop.top_row > loop.row, "a loop is taken before it is made");
    if (knit.loops.size() > 500) return;
    for (const dvec3& p : loop_curves(knit, {}).points) expect(finite(p), "a point is not finite");
  });
}

}  // namespace

bool chart(std::string_view bytes) { return read(bytes, "fuzz.chart"); }
bool chart_json(std::string_view bytes) { return read(bytes, "fuzz.json"); }
bool knitout(std::string_view bytes) { return read(bytes, "fuzz.knitout"); }

}  // namespace wale::fuzz
