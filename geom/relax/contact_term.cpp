#include "geom/relax/contact_term.h"

#include <cmath>

#include "geom/relax/yarn_terms.h"

namespace wale {
namespace {

// Calls visit(s, t, way) for all pairs of samples, way from the second to the first. A segment's last point is the
// first sample of the next one.
template <typename Visit>
void for_samples(const PeriodicYarns& yarns, const YarnSegment& first, const YarnSegment& second, ivec2 image,
                 int samples, const Visit& visit) {
  const dvec3 p = yarns.points[first.a], along = edge_of(yarns, first);
  const dvec3 q = yarns.points[second.a] + dvec3(dvec2(image) * yarns.period, 0.0), beside = edge_of(yarns, second);
  for (int i = 0; i < samples; ++i)
    for (int j = 0; j < samples; ++j) {
      const double s = double(i) / samples, t = double(j) / samples;
      if (!visit(s, t, (p + s * along) - (q + t * beside))) return;
    }
}

}  // namespace

LocalTerm contact_term(const PeriodicYarns& yarns, const YarnSegment& first, const YarnSegment& second, ivec2 image,
                       const ContactBarrier& barrier, Order order) {
  LocalTerm out;
  out.count = 4;
  out.point[0] = first.a, out.point[1] = first.b, out.point[2] = second.a, out.point[3] = second.b;
  const double a = barrier.from, c = barrier.closest;
  const double share = first.length * second.length / (barrier.samples * barrier.samples) * barrier.stiffness;
  for_samples(yarns, first, second, image, barrier.samples, [&](double s, double t, const dvec3& way) {
    const double squared = glm::dot(way, way);
    if (squared >= a * a) return true;
    const double d = std::sqrt(squared), gap = d - a, room = d - c;
    if (!(room > 0)) {
      out.energy = INFINITY;
      return false;
    }
    const double log = std::log(room / (a - c));
    out.energy -= share * gap * gap * log;
    if (order == Order::energy) return true;
    const double slope = -share * (2 * gap * log + gap * gap / room);
    const double curvature = -share * (2 * log + 4 * gap / room - gap * gap / (room * room));
    const dvec3 n = way / d;
    const dmat3 along = glm::outerProduct(n, n);
    const double weight[] = {1 - s, s, t - 1, -t};
    out.add(weight, way, slope * n, curvature * along + slope / d * (dmat3(1.0) - along));
    return true;
  });
  return out;
}

double sample_distance(const PeriodicYarns& yarns, const YarnSegment& first, const YarnSegment& second, ivec2 image,
                       int samples) {
  double least = INFINITY;
  for_samples(yarns, first, second, image, samples, [&](double, double, const dvec3& way) {
    least = std::min(least, glm::dot(way, way));
    return true;
  });
  return std::sqrt(least);
}

// Inside segments the way w between closest points is at right angles to both, and each has a sample within half a
// spacing h: the way between these is w and h/2 + h/2 at most at right angles to it. Corners are samples themselves.
double barrier_for(double closest, double longest, int samples) {
  const double spacing = longest / samples;
  return std::sqrt(closest * closest + spacing * spacing);
}

}  // namespace wale
