#pragma once
// Numbers that no file should hold but memory can: NaN, infinities, denormals, random bits.
#include <random>

#include "tests/hard/trap.h"
#include "tests/kernels/synthetic.h"

namespace wale::test {

/// A float of random bits that is neither NaN nor infinite.
float random_finite(std::mt19937& random);
/// The hit is a miss, or a segment at a distance that the ray allows; both kinds of query agree.
bool bounded(const Ray& ray, const Hit& hit);

/// NaN and infinities in every component of origin, offset, direction and tmax, and directions without a length, mixed
/// with sound rays: wrong answers. The sound rays must answer as they do alone, every other one miss and be counted.
Finding look_at_rays_that_are_not_finite();
/// Time of a batch of such rays over that of sound ones.
Finding look_at_their_time();
/// Random finite bits as origins, offsets and tmax: answers that are no number, out of (0, tmax], or no segment.
Finding look_at_rays_of_random_bits();
/// Denormal components against the same components flushed to 0: differing answers.
Finding look_at_denormal_rays();
/// Random finite bits as the vertices of plies: answers out of bounds; broken when the tree is slower than trying every
/// leaf.
Finding look_at_vertices_of_random_bits();
/// NaN and infinite coordinates in a file of every format that Wale reads: files that were not refused in one line that
/// names the file and the vertex, or its line.
Finding look_at_files_that_are_not_finite();

}  // namespace wale::test
