// Knitout (McCann et al., textiles-lab.github.io/knitout/knitout.html): what the needles of a V-bed machine do. Each
// pass of a carrier becomes a row: knit on the front bed k, on the back bed p, tuck t or T, loops that it leaves alone
// s or S, with the yarn between the beds; a stitch on an empty needle is a yarn over. Transfers move loops: two or
// three on one needle are a decrease, blocks that changed places a cable. The chart is the unit that repeats in the
// middle.
//
// Which loop of a needle lies uppermost is not in the specification, and follows from the needle: a transfer hangs a
// loop over the tip, which points to the gap between the beds, so that those that were there lie nearer to the
// needle's own side of the cloth. To that side the next loop is pulled through all of them. So the first to come is
// uppermost where they are pulled to; of a cable, the block that comes back first lies in front. The rules of
// precedence of TopoKnit say the same (Kapllani et al. 2022, Loop order analysis of weft-knitted textiles,
// doi:10.3390/textiles2020015: loops of the front bed before those transferred to it, in turn). A pile that goes over
// to the other bed keeps its order from front to back: what was nearest to the one bed is farthest from the other.
#include <algorithm>
#include <map>
#include <optional>

#include "geom/chart/knitout_needle.h"
#include "geom/chart/repeat_unit.h"
#include "geom/chart/stitch_chart.h"
#include "geom/error.h"
#include "geom/text_lines.h"

namespace wale {
namespace {

constexpr size_t kMostCells = 1'000'000;
constexpr size_t kMostCarriers = 26;  // yarns of a chart are letters
constexpr size_t kMostLoops = 3;      // on a needle: no decrease of a chart takes more

struct Held {
  int wale = 0;     // of the row below
  int arrival = 0;  // transfers so far when it came to this needle; 0: it was made here
};

class Machine {
 public:
  explicit Machine(const std::filesystem::path& file) : file_(file.string()) {}

  void line(const TextLine& line) {
    line_ = line.number;
    const auto& w = line.words;
    const std::string_view op = w[0];
    if (op == "knit" || op == "tuck" || op == "miss") {
      if (w.size() < 4) fail(fmt::format("{} needs a direction, a needle and a carrier", op));
      stitch(op, w);
    } else if (op == "xfer") {
      if (w.size() != 3) fail("xfer needs two needles");
      end_pass();
      transfer(named(w[1]), named(w[2]));
    } else if (op == "drop") {
      if (w.size() != 2) fail("drop needs a needle");
      end_pass();
      held_.erase(named(w[1]));
    } else if (op == "rack") {
      end_pass();
      if (w.size() != 2) fail("rack needs a number");
      const double rack = finite_number(file_, line_, w[1]);
      if (!(rack >= -kMostNeedles && rack <= kMostNeedles)) fail("such a rack does not exist");
      rack_ = rack;
    } else if (op == "split" || op == "amiss") {
      fail(fmt::format("{} is not read; valid: knit, tuck, miss, xfer, drop, rack, and carriers in and out", op));
    } else if (op != "in" && op != "inhook" && op != "out" && op != "outhook" && op != "releasehook" && op != "pause" &&
               !op.starts_with("x-")) {
      fail(fmt::format("\"{}\" is no instruction; valid: knit, tuck, miss, xfer, drop, rack, and carriers in and out",
                       one_line(std::string(op))));
    }
  }

  StitchChart chart(const std::string& name) {
    end_pass();
    if (rows_.empty()) user_error("{}: no stitches", file_);
    RepeatUnit unit = repeat_unit(rows_);
    if (unit.rows.empty())
      user_error(
          "{}: no unit of stitches repeats in the middle of its {} rows ({} to {}); at least two repeats across "
          "and two up are needed",
          file_, rows_.size(), rows_.front().where, rows_.back().where);
    for (size_t r = 0; r < unit.rows.size(); ++r) {
      const Reach& reach = reach_[unit.first_row + r];
      if (reach.first > unit.first_wale || reach.last < unit.last_wale)
        user_error("{}:1: the yarn ends in mid-air: this pass reaches stitches {} to {}, the repeating unit {} to {}",
                   unit.rows[r].where, reach.first + 1, reach.last + 1, unit.first_wale + 1, unit.last_wale + 1);
    }
    StitchChart out;
    out.name = name;
    out.rows = std::move(unit.rows);
    // Yarns in the order in which they come.
    std::map<int, int> letters;
    for (ChartRow& row : out.rows)
      for (int& yarn : row.yarn) {
        const auto [at, is_new] = letters.try_emplace(yarn, int(letters.size()));
        if (is_new) {
          out.yarns.push_back({char('a' + at->second), {}});
        }
        yarn = at->second;
      }
    return out;
  }

 private:
  enum class Op { knit, tuck };
  struct Reach {
    int first, last;
  };

  [[noreturn]] void fail(const std::string& what) const { user_error("{}:{}: {}", file_, line_, what); }

  Needle named(std::string_view word) const {
    const auto needle = needle_of(word);
    if (!needle)
      fail(fmt::format("\"{}\" is no needle; valid: f or b and a number up to {} (sliders are not read)",
                       one_line(std::string(word)), kMostNeedles));
    return *needle;
  }

  void stitch(std::string_view op, const std::vector<std::string_view>& words) {
    if (words[1] != "+" && words[1] != "-")
      fail(fmt::format("\"{}\" is no direction; valid: + and -", one_line(std::string(words[1]))));
    const bool right = words[1] == "+";
    const Needle needle = named(words[2]);
    std::string carrier;
    for (size_t i = 3; i < words.size(); ++i) carrier += std::string(words[i]) + " ";
    const bool goes_on = pass_ && pass_->right == right && pass_->carrier == carrier &&
                         (right ? !(needle.number < pass_->at) : !(needle.number > pass_->at)) &&
                         !pass_->ops.contains(needle);
    if (!goes_on) {
      end_pass();
      pass_ = Pass{right, carrier, needle.number, line_, rack_, {}};
    }
    pass_->at = needle.number;
    if (op != "miss") pass_->ops[needle] = op == "knit" ? Op::knit : Op::tuck;
  }

  void transfer(Needle from, Needle to) {
    if (from.back == to.back) fail("xfer goes from one bed to the other");
    const int offset = int(rack_);  // back needle b lies at b + rack
    if (offset != rack_)
      fail(fmt::format("at rack {} no needles face each other, and nothing is transferred; valid: a whole number",
                       rack_));
    if ((to.back ? from.number - to.number : to.number - from.number) != offset)
      fail(fmt::format("at rack {} these needles do not face each other", rack_));
    const auto at = held_.find(from);
    if (at == held_.end()) return;
    std::vector<Held> loops = std::move(at->second);
    held_.erase(at);
    ++transfers_;
    for (Held& loop : loops) loop.arrival = transfers_;
    std::vector<Held>& there = held_[to];
    if (there.size() + loops.size() > kMostLoops)
      fail(fmt::format("{} loops on needle {}; a chart takes up to {} as one", there.size() + loops.size(),
                       needle_text(to), kMostLoops));
    there.insert(there.end(), loops.rbegin(), loops.rend());
  }

  void end_pass() {
    if (!pass_) return;
    const Pass pass = std::move(*pass_);
    pass_.reset();
    if (pass.ops.empty()) return;
    if (cells_ > kMostCells) fail(fmt::format("more than {} stitches", kMostCells));
    ChartRow row;
    row.where = fmt::format("{}:{}", file_, pass.line);
    std::vector<Needle> needles;  // that hold loops after it
    for (const auto& [needle, loops] : held_) needles.push_back(needle);
    for (const auto& [needle, op] : pass.ops)
      if (!held_.contains(needle)) needles.push_back(needle);
    std::sort(needles.begin(), needles.end());
    // At rack r back needle b lies at b + r. From 0 on and below 1 that is between front needles b and b + 1; beyond,
    // loops of the beds pass each other, which no chart says.
    const bool beds = std::any_of(needles.begin(), needles.end(), [](Needle n) { return n.back; }) &&
                      std::any_of(needles.begin(), needles.end(), [](Needle n) { return !n.back; });
    if (beds && !(pass.rack >= 0 && pass.rack < 1))
      user_error("{}:{}: a pass at rack {} with loops on both beds; valid: racks from 0 on and below 1", file_,
                 pass.line, pass.rack);
    const int yarn = carriers_.try_emplace(pass.carrier, int(carriers_.size())).first->second;
    if (carriers_.size() > kMostCarriers)
      user_error("{}:{}: more than {} yarns: carriers, and sets of them that knit as one", file_, pass.line,
                 kMostCarriers);
    Reach reach{-1, -1};
    for (size_t i = 0; i < needles.size(); ++i)
      if (pass.ops.contains(needles[i])) {
        if (reach.first < 0) reach.first = int(i);
        reach.last = int(i);
      }
    int taken = 0;
    for (size_t i = 0; i < needles.size();) {
      const std::vector<Held>& loops = held_[needles[i]];
      if (loops.size() == 1 && loops[0].wale > taken) {
        i += cable(needles, i, taken, pass, row);
        continue;
      }
      row.cells.push_back(cell(needles[i], loops, taken, pass));
      ++i;
    }
    cells_ += needles.size();
    row.yarn.assign(needles.size(), yarn);
    for (size_t i = 0; i < row.cells.size(); ++i) row.cells[i].column = int(i) + 1;
    rows_.push_back(std::move(row));
    reach_.push_back(reach);
    for (size_t i = 0; i < needles.size(); ++i) held_[needles[i]] = {{int(i), 0}};
  }

  struct Pass {
    bool right = true;
    std::string carrier;
    int at = 0, line = 0;
    double rack = 0;
    std::map<Needle, Op> ops;
  };

  ChartCell cell(Needle needle, const std::vector<Held>& loops, int& taken, const Pass& pass) const {
    const auto op = pass.ops.find(needle);
    const bool worked = op != pass.ops.end(), tucks = worked && op->second == Op::tuck;
    if (loops.empty()) return {Stitch::yarn_over};
    for (size_t k = 0; k < loops.size(); ++k)
      if (std::none_of(loops.begin(), loops.end(), [&](const Held& h) { return h.wale == taken + int(k); }))
        crossed(needle, pass);
    const int before = taken;
    taken += int(loops.size());
    if (loops.size() == 1) {
      if (!worked) return {needle.back ? Stitch::slip_front : Stitch::slip};
      if (tucks) return {needle.back ? Stitch::tuck_front : Stitch::tuck};
      return {needle.back ? Stitch::purl : Stitch::knit};
    }
    if (worked && !tucks)
      for (const StitchWord& known : stitch_words())
        if (is_decrease(known.stitch) && pulls_to_front(known.stitch) != needle.back &&
            std::ranges::equal(loops, taken_order(known.stitch), {}, [&](const Held& h) { return h.wale - before; }))
          return {known.stitch};
    user_error(
        "{}:{}: {} loops on needle {} are {}; what can be read is k2tog, ssk, k3tog, k3togtbl, sk2p and cdd on the "
        "front bed, p2tog and ssp on the back bed",
        file_, pass.line, loops.size(), needle_text(needle),
        !worked ? "left alone"
        : tucks ? "tucked"
                : "taken together in another order");
  }

  [[noreturn]] void crossed(Needle needle, const Pass& pass) const {
    user_error("{}:{}: the loops of needle {} were moved across others in a way that is neither a decrease nor a cable",
               file_, pass.line, needle_text(needle));
  }

  // Blocks of loops that have changed places, from needle i on; how many needles.
  size_t cable(const std::vector<Needle>& needles, size_t i, int& taken, const Pass& pass, ChartRow& row) {
    const auto only = [&](size_t k) -> const Held* {
      const std::vector<Held>& loops = held_[needles[k]];
      const auto op = pass.ops.find(needles[k]);
      const bool knits = op != pass.ops.end() && op->second == Op::knit && !needles[k].back;
      return loops.size() == 1 && knits ? &loops[0] : nullptr;
    };
    ChartCell out;
    out.stitch = Stitch::cable;
    const Held* first = only(i);
    if (!first) crossed(needles[i], pass);
    out.left = first->wale - taken;
    size_t k = i;
    while (k < needles.size() && only(k) && only(k)->wale == first->wale + int(k - i)) ++k;
    out.right = int(k - i);
    const size_t middle = k;
    for (int n = 0; n < out.left; ++n, ++k)
      if (k >= needles.size() || !only(k) || only(k)->wale != taken + n) crossed(needles[i], pass);
    // One block lies in front of the other where all of it came first; else their strands are interleaved.
    const auto arrivals = [&](size_t from, size_t to) {
      const auto [least, most] =
          std::minmax_element(needles.begin() + std::ptrdiff_t(from), needles.begin() + std::ptrdiff_t(to),
                              [&](Needle a, Needle b) { return held_[a][0].arrival < held_[b][0].arrival; });
      return std::pair(held_[*least][0].arrival, held_[*most][0].arrival);
    };
    const auto right = arrivals(i, middle), left = arrivals(middle, k);
    out.left_in_front = left.second < right.first;
    if (!out.left_in_front && !(right.second < left.first)) crossed(needles[i], pass);
    taken += out.left + out.right;
    row.cells.push_back(out);
    return k - i;
  }

  std::string file_;
  int line_ = 0;
  std::map<Needle, std::vector<Held>> held_;  // the first to come first
  std::optional<Pass> pass_;
  std::map<std::string, int> carriers_;
  std::vector<ChartRow> rows_;
  std::vector<Reach> reach_;
  double rack_ = 0;
  int transfers_ = 0;
  size_t cells_ = 0;
};

}  // namespace

StitchChart parse_knitout(std::string_view text, const std::filesystem::path& file) {
  if (!text.starts_with(";!knitout-")) user_error("{}:1: does not begin with ;!knitout-2", file.string());
  Machine machine(file);
  for (const TextLine& line : text_lines(text, ';')) machine.line(line);
  return machine.chart(file.stem().string());
}

}  // namespace wale
