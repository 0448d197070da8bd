// Sizes and views of pictures: known answers, and nothing lost on the way.
#include <gtest/gtest.h>

#include "host/fit/homography.h"
#include "host/fit/resample.h"
#include "tests/host/fit_pictures.h"

namespace wale::fit {
namespace {

double largest_difference(const Picture& a, const Picture& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  double largest = 0;
  for (size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i)
    largest = std::max(largest, std::abs(double(a.pixels[i]) - double(b.pixels[i])));
  return largest;
}

constexpr double kRounding = 1e-6;  // a mean of floats between 0 and 1

TEST(FitResample, ThreePixelsInTwo) {
  const Picture row = painted(3, 1, [](int x, int, int) { return x == 0 ? 1 : x == 1 ? 4 : 7; });
  const Picture two = at_resolution(row, 2, 1);
  EXPECT_FLOAT_EQ(two.at(0, 0)[0], (1 + 0.5f * 4) / 1.5f);
  EXPECT_FLOAT_EQ(two.at(1, 0)[2], (0.5f * 4 + 7) / 1.5f);
}

TEST(FitResample, TheMeanStaysAtEverySize) {
  const Picture picture = random_picture(37, 23, 1);
  for (const auto& [width, height] : {std::pair{37, 23}, {10, 10}, {1, 1}, {36, 5}, {80, 61}})
    EXPECT_NEAR(brightness(at_resolution(picture, width, height)), brightness(picture), kRounding)
        << width << " x " << height;
  EXPECT_EQ(at_resolution(picture, 37, 23).pixels, picture.pixels);
}

TEST(FitResample, PyramidsHalve) {
  const auto levels = pyramid(random_picture(37, 20, 2), 9, 4);
  ASSERT_EQ(levels.size(), 3u);  // 37 x 20, 19 x 10, 10 x 5; then 5 x 3
  EXPECT_EQ(levels[2].width, 10);
  EXPECT_EQ(levels[2].height, 5);
  EXPECT_EQ(pyramid(random_picture(37, 20, 2), 2, 1).size(), 2u);
}

// Beyond its corners, a projective map is known by one more point: the diagonals still meet in the middle.
TEST(FitHomography, CornersAndCentreAreExact) {
  const Corners corners{dvec2(10, 20), dvec2(90, 10), dvec2(70, 80), dvec2(20, 60)};
  const Homography map(corners);
  const dvec2 unit[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int i = 0; i < 4; ++i) EXPECT_LT(glm::length(map(unit[i]) - corners[size_t(i)]), 1e-12) << i;
  const dvec2 a = corners[0], b = corners[2] - a, c = corners[1], d = corners[3] - c;
  const double t = ((c.x - a.x) * d.y - (c.y - a.y) * d.x) / (b.x * d.y - b.y * d.x);
  EXPECT_LT(glm::length(map({0.5, 0.5}) - (a + t * b)), 1e-12);
}

TEST(FitHomography, AnUprightRectangleIsACut) {
  const Picture picture = random_picture(40, 30, 3);
  const Corners corners{dvec2(5, 4), dvec2(35, 4), dvec2(35, 24), dvec2(5, 24)};
  const Picture cut = cropped(picture, {5, 4, 30, 20});
  for (const auto& [width, height] : {std::pair{30, 20}, {7, 9}, {45, 33}})
    EXPECT_LT(largest_difference(rectified(picture, corners, width, height), at_resolution(cut, width, height)),
              kRounding)
        << width << " x " << height;
}

TEST(FitHomography, QuarterTurn) {
  const Picture picture = random_picture(20, 12, 4);
  const Corners corners{dvec2(20, 0), dvec2(20, 12), dvec2(0, 12), dvec2(0, 0)};
  const Picture turned = painted(12, 20, [&](int x, int y, int c) { return picture.at(19 - y, x)[c]; });
  EXPECT_LT(largest_difference(rectified(picture, corners, 12, 20), turned), kRounding);
}

// Weighted with the areas that they come from, the pixels add up to the photograph's integral over the quadrilateral:
// here a plane, whose integral is its value at the centroid times the area.
TEST(FitHomography, NothingIsLostOrCountedTwice) {
  const Picture plane = painted(100, 100, [](int x, int y, int c) { return 0.01 * x + 0.02 * y * c; });
  const Corners corners{dvec2(10, 20), dvec2(90, 10), dvec2(70, 80), dvec2(20, 60)};
  const Homography map(corners);
  const auto cross = [](dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; };
  const auto area_of = [&](dvec2 a, dvec2 b, dvec2 c) { return cross(b - a, c - a) / 2; };
  for (const int size : {4, 57, 150}) {
    const Picture straight = rectified(plane, corners, size, size);
    double sum[3] = {};
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const auto at = [&](int i, int j) { return map({double(x + i) / size, double(y + j) / size}); };
        const double area = area_of(at(0, 0), at(1, 0), at(1, 1)) + area_of(at(0, 0), at(1, 1), at(0, 1));
        for (int c = 0; c < 3; ++c) sum[c] += area * double(straight.at(x, y)[c]);
      }
    // A pixel's square has its value at its centre: two triangles of the plane, and squares cut by the border.
    for (int c = 0; c < 3; ++c) {
      const auto value = [&](dvec2 p) { return 0.01 * (p.x - 0.5) + 0.02 * (p.y - 0.5) * c; };
      double integral = 0;
      for (const auto& [i, j, k] : {std::tuple{0, 1, 2}, {0, 2, 3}}) {
        const dvec2 p = corners[size_t(i)], q = corners[size_t(j)], r = corners[size_t(k)];
        integral += area_of(p, q, r) * value((p + q + r) / 3.0);
      }
      EXPECT_NEAR(sum[c] / integral, 1, 3e-5) << size << " " << c;  // steps along the border
    }
  }
}

// A chessboard photographed at an angle: 8 x 8 fields come out as 8 x 8 pixels.
TEST(FitHomography, AChessboardIsSeenStraightOn) {
  const Corners corners{dvec2(100, 75), dvec2(350, 130), dvec2(310, 360), dvec2(65, 280)};
  // The map's own inverse, by Newton's method, so that the photograph does not come from the code that is tested.
  const Homography map(corners);
  const auto board_place = [&](dvec2 p) {
    dvec2 uv(0.5, 0.5);
    for (int i = 0; i < 8; ++i) {
      const double h = 1e-5;
      const dvec2 du = (map(uv + dvec2(h, 0)) - map(uv - dvec2(h, 0))) / (2 * h);
      const dvec2 dv = (map(uv + dvec2(0, h)) - map(uv - dvec2(0, h))) / (2 * h), miss = map(uv) - p;
      const double det = du.x * dv.y - du.y * dv.x;
      uv -= dvec2(miss.x * dv.y - miss.y * dv.x, du.x * miss.y - du.y * miss.x) / det;
    }
    return uv;
  };
  const Picture photograph = painted(400, 400, [&](int x, int y, int) {
    const dvec2 p(x + 0.5, y + 0.5);
    if (!inside(corners, p)) return 0.5;
    const dvec2 uv = board_place(p);
    return double((int(8 * uv.x) + int(8 * uv.y)) % 2);
  });
  const Picture board = rectified(photograph, corners, 8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_NEAR(board.at(x, y)[0], (x + y) % 2, 0.05) << x << " " << y;
}

TEST(FitHomography, TheSizeIsThatOfTheLongerSides) {
  const ivec2 size = size_of({dvec2(10, 0), dvec2(30, 0), dvec2(40, 50), dvec2(0, 50)});
  EXPECT_EQ(size.x, 40);
  EXPECT_EQ(size.y, 51);  // of length 50.99
}

TEST(FitHomography, WrongCornersAreNamed) {
  const Corners good{dvec2(1, 1), dvec2(9, 1), dvec2(9, 9), dvec2(1, 9)};
  EXPECT_EQ(corners_fault(good, 10, 10), "");
  Corners wrong = good;
  wrong[2] = {9, 11};
  EXPECT_EQ(corners_fault(wrong, 10, 10), "the bottom right one, (9, 11), lies outside of the 10 x 10 pixels");
  wrong = good, std::swap(wrong[1], wrong[3]);  // anticlockwise
  EXPECT_NE(corners_fault(wrong, 10, 10).find("no convex turn at the top left one"), std::string::npos);
  wrong = good, std::swap(wrong[1], wrong[2]);  // crossed
  EXPECT_NE(corners_fault(wrong, 10, 10).find("no convex turn"), std::string::npos);
  wrong = good, wrong[1] = wrong[0];
  EXPECT_EQ(corners_fault(wrong, 10, 10), "the top left and the top right one are less than a pixel apart");
  wrong = good, wrong[0].x = NAN;
  EXPECT_NE(corners_fault(wrong, 10, 10).find("the top left one"), std::string::npos);
}

}  // namespace
}  // namespace wale::fit
