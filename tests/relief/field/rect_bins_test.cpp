// Rectangles in bins against the trial of all of them.
#include "relief/field/rect_bins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/relief/samples.h"

namespace relief {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::vector<Rect> random_rects(samples::Random& random, int count, double largest, int infinite) {
  std::vector<Rect> rects;
  for (int n = 0; n < count; ++n) {
    const double x = random.in(-50.0, 50.0);
    const double y = random.in(-20.0, 20.0);
    const double size = std::pow(10.0, random.in(-2.0, std::log10(largest)));
    rects.push_back({x, y, x + size, y + random.in(0.0, size)});
    if (n < infinite) rects.push_back({-kInfinite, y, kInfinite, n % 2 == 0 ? kInfinite : y + 1});
  }
  return rects;
}

void expect_all(const std::vector<Rect>& rects, samples::Random& random) {
  const RectBins bins(rects);
  for (int n = 0; n < 500; ++n) {
    const double size = n % 3 == 0 ? 0 : std::pow(10.0, random.in(-3.0, 2.5));
    const double x = random.in(-70.0, 70.0);
    const double y = random.in(-40.0, 40.0);
    const Rect rect{x, y, n % 50 == 7 ? kInfinite : x + size, y + size};
    std::vector<std::size_t> expected;
    for (std::size_t k = 0; k < rects.size(); ++k)
      if (overlap(rects[k], rect)) expected.push_back(k);
    std::vector<std::size_t> found;
    bins.visit(rect, [&](std::size_t k) { found.push_back(k); });
    EXPECT_EQ(found, expected);
  }
}

TEST(ReliefRectBins, FindWhatOverlapsInOrder) {
  samples::Random random(95);
  for (const int count : {0, 1, 3, 40, 3000}) expect_all(random_rects(random, count, 3, 0), random);
}

TEST(ReliefRectBins, FindWideAndInfiniteOnesToo) {
  samples::Random random(96);
  expect_all(random_rects(random, 2000, 100, 5), random);
  expect_all(random_rects(random, 2000, 100, 300), random);
}

TEST(ReliefRectBins, PlacesOnABorderBelongToBothSides) {
  std::vector<Rect> rects;
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i) rects.push_back({i * 1.0, j * 1.0, i + 1.0, j + 1.0});
  const RectBins bins(rects);
  int found = 0;
  bins.visit({5, 7, 5, 7}, [&](std::size_t) { ++found; });
  EXPECT_EQ(found, 4);
}

}  // namespace
}  // namespace relief
