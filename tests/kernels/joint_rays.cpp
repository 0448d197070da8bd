#include "tests/kernels/joint_rays.h"

#include <cmath>

#include "tests/kernels/synthetic.h"

namespace wale::test {

std::vector<JointPair> joints_of(const BruteForce& oracle) {
  std::vector<JointPair> joints;
  for (size_t i = 0; i < oracle.segments(); ++i) {
    const OracleSegment& s = oracle.segment(i);
    const long next = oracle.after(i);
    if (next >= 0 && glm::length(s.end - s.start) > 0) joints.push_back({uint32_t(i), uint32_t(next)});
  }
  return joints;
}

Ray ray_at(const BruteForce& oracle, JointPair joint, Stream& random) {
  const OracleSegment &a = oracle.segment(joint.before), &b = oracle.segment(joint.after);
  const double r = a.radius;
  const dvec3 ta = glm::normalize(a.end - a.start), tb = glm::normalize(b.end - b.start);
  const dvec3 sum = ta + tb, m = glm::length(sum) > 0.1 ? glm::normalize(sum) : ta;
  const dvec3 in = glm::normalize(glm::cross(m, random.direction())), side = glm::cross(m, in);
  const double beside =
      random.uniform() < 0.5 ? 0 : (random.next() & 1 ? 1 : -1) * r * std::pow(10, -7 * random.uniform());
  const dvec3 target = a.end + beside * m + r * (2 * random.uniform() - 1) * side;
  const dvec3 d = random.next() & 1 ? in : random.direction();
  const double away = r * std::pow(10, 0.5 + 4.5 * random.uniform());
  Ray ray = make_ray({0, 0, 0}, d, 0);
  const dvec3 o = target - away * dvec3(ray.d[0], ray.d[1], ray.d[2]);
  for (int k = 0; k < 3; ++k) ray.o[k] = float(o[k]);
  ray.tmax = float(away + 8 * r);
  return ray;
}

}  // namespace wale::test
