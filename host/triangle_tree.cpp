#include "host/triangle_tree.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "shared/wale_types.h"

namespace wale {
namespace {

struct Builder {
  std::span<const float> corners;
  TriangleTree& out;
  std::vector<Box> boxes;

  float centre(uint32_t triangle, int axis) const {
    const float* c = corners.data() + size_t(triangle) * 9 + axis;
    return c[0] + c[3] + c[6];
  }

  void split(uint32_t* first, uint32_t* last) {
    if (last - first <= W_LEAF_LANES) return leaf(first, last);
    float lo[3] = {1e30f, 1e30f, 1e30f}, hi[3] = {-1e30f, -1e30f, -1e30f};
    for (auto* t = first; t != last; ++t)
      for (int a = 0; a < 3; ++a) lo[a] = std::min(lo[a], centre(*t, a)), hi[a] = std::max(hi[a], centre(*t, a));
    int axis = 0;
    for (int a = 1; a < 3; ++a)
      if (hi[a] - lo[a] > hi[axis] - lo[axis]) axis = a;
    // Full leaves on the left, so that few lanes stay empty; ties by number keep the order the same everywhere.
    const auto leaves = (last - first + W_LEAF_LANES - 1) / W_LEAF_LANES;
    auto* middle = first + leaves / 2 * W_LEAF_LANES;
    std::nth_element(first, middle, last, [&](uint32_t a, uint32_t b) {
      const float x = centre(a, axis), y = centre(b, axis);
      return x < y || (x == y && a < b);
    });
    split(first, middle);
    split(middle, last);
  }

  void leaf(uint32_t* first, uint32_t* last) {
    const size_t at = out.leaves.size();
    out.leaves.resize(at + W_TRI_LEAF_WORDS, 0.0f);
    float* words = out.leaves.data() + at;
    words[0] = std::bit_cast<float>(uint32_t(first - out.order.data()));
    words[1] = std::bit_cast<float>(uint32_t(last - first));
    Box box;
    for (auto* t = first; t != last; ++t) {
      const float* c = corners.data() + size_t(*t) * 9;
      for (int a = 0; a < 3; ++a) {
        words[4 + a * 16 + (t - first)] = c[a];
        words[4 + (3 + a) * 16 + (t - first)] = c[3 + a] - c[a];
        words[4 + (6 + a) * 16 + (t - first)] = c[6 + a] - c[a];
        for (int corner = 0; corner < 3; ++corner) {
          box.lo[a] = std::min(box.lo[a], c[3 * corner + a]);
          box.hi[a] = std::max(box.hi[a], c[3 * corner + a]);
        }
      }
    }
    boxes.push_back(box);
  }
};

}  // namespace

TriangleTree build_triangle_tree(std::span<const float> corners) {
  TriangleTree out;
  out.order.resize(corners.size() / 9);
  std::iota(out.order.begin(), out.order.end(), 0u);
  Builder builder{corners, out, {}};
  if (!out.order.empty()) builder.split(out.order.data(), out.order.data() + out.order.size());
  std::vector<uint32_t> codes(builder.boxes.size());
  for (size_t i = 0; i < codes.size(); ++i) codes[i] = uint32_t(i * W_TRI_LEAF_WORDS / 4);  // 16-byte units
  out.tree = build_wide_tree(builder.boxes, codes, {}, {});
  return out;
}

}  // namespace wale
