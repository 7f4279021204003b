// Stacks of shapes: how layers are composed, their gradients and bounds.
#include "relief/field/stack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "relief/field/interval_algebra.h"
#include "tests/relief/samples.h"

namespace relief {
namespace {

std::shared_ptr<const Shape> flat(double height_m, const Rect& rect) {
  const MapLayout layout{2, 2, rect.x0_m, rect.y0_m, rect.x1_m - rect.x0_m, rect.y1_m - rect.y0_m};
  return std::make_shared<HeightMap>(layout, std::vector<float>(4, static_cast<float>(height_m)),
                                     Interpolation::kBilinear);
}

TEST(ReliefStack, ComposesLayersFromBelow) {
  const Stack stack({{flat(3, {0, 0, 10, 10}), Compose::kSum, nullptr},
                     {flat(2, {5, 0, 15, 10}), Compose::kSum, nullptr},
                     {flat(4, {0, 0, 10, 5}), Compose::kMax, nullptr},
                     {flat(10, {0, 0, 20, 20}), Compose::kReplace, flat(0.25, {0, 0, 3, 10})}});
  EXPECT_EQ(stack.height_m(4, 7), 3);
  EXPECT_EQ(stack.height_m(7, 7), 5);
  EXPECT_EQ(stack.height_m(4, 2), 4);
  EXPECT_EQ(stack.height_m(7, 2), 5);
  EXPECT_EQ(stack.height_m(1, 7), 0.75 * 3 + 0.25 * 10);
  EXPECT_EQ(stack.height_m(1, 12), 0);
  EXPECT_EQ(stack.support().x1_m, 15);
  EXPECT_EQ(stack.support().y1_m, 10);
  EXPECT_EQ(stack.layers().size(), 4U);
}

TEST(ReliefStack, MaxRaisesAHollowToZeroBeyondItsOwnSupport) {
  const Stack stack(
      {{flat(-3, {0, 0, 10, 10}), Compose::kSum, nullptr}, {flat(4, {20, 0, 30, 5}), Compose::kMax, nullptr}});
  EXPECT_EQ(stack.height_m(5, 5), 0);
  EXPECT_EQ(stack.height_m(25, 2), 4);
  EXPECT_GE(stack.bounds_m({1, 1, 2, 2}).high, 0);
}

TEST(ReliefStack, AMaskBeyondItsRangeCountsAsTheNearestShare) {
  const auto low = flat(2, {0, 0, 1, 1});
  const auto high = flat(8, {0, 0, 1, 1});
  EXPECT_EQ(Stack({{low, Compose::kSum, nullptr}, {high, Compose::kReplace, flat(7, {0, 0, 1, 1})}})
                .height_m(0.5, 0.5),
            8);
  EXPECT_EQ(Stack({{low, Compose::kSum, nullptr}, {high, Compose::kReplace, flat(-7, {0, 0, 1, 1})}})
                .height_m(0.5, 0.5),
            2);
}

Stack rough_stack() {
  return Stack({{samples::rough_map(20, 20, 3, Interpolation::kBicubic, 21), Compose::kSum, nullptr},
                {samples::rough_map(9, 9, 1, Interpolation::kBilinear, 22, 1.7, 1.2), Compose::kSum, nullptr},
                {samples::rough_map(9, 9, 2, Interpolation::kBicubic, 23, 2, 2), Compose::kMax, nullptr},
                {samples::rough_map(12, 12, 2, Interpolation::kBicubic, 24), Compose::kReplace,
                 samples::rough_map(10, 10, 1, Interpolation::kBilinear, 25)}});
}

TEST(ReliefStack, BoundsHoldTheHeightsOfARectangle) {
  const Stack stack = rough_stack();
  samples::Random random(26);
  for (int n = 0; n < 3000; ++n) {
    const double size = std::pow(10.0, random.in(-6.0, 1.3));
    const Rect rect{random.in(-12.0, 11.0), random.in(-12.0, 11.0), 0, 0};
    const Rect part{rect.x0_m, rect.y0_m, rect.x0_m + size, rect.y0_m + size};
    const Interval found = widened(stack.bounds_m(part), 1e-13);
    for (int m = 0; m < 10; ++m)
      EXPECT_TRUE(
          holds(found, stack.height_m(random.in(part.x0_m, part.x1_m), random.in(part.y0_m, part.y1_m))));
  }
}

TEST(ReliefStack, GradientsAreThoseOfDifferences) {
  const Stack stack = rough_stack();
  samples::Random random(27);
  int agree = 0;
  const int count = 1000;
  for (int n = 0; n < count; ++n) {
    const double x = random.in(-10.0, 10.0);
    const double y = random.in(-10.0, 10.0);
    const double h = 1e-6;
    const glm::dvec2 slope{(stack.height_m(x + h, y) - stack.height_m(x - h, y)) / (2 * h),
                           (stack.height_m(x, y + h) - stack.height_m(x, y - h)) / (2 * h)};
    const glm::dvec2 found = stack.gradient(x, y);
    agree += std::abs(found.x - slope.x) + std::abs(found.y - slope.y) < 1e-6 ? 1 : 0;
  }
  // All but differences across a crease or a border.
  EXPECT_GE(agree, count - 3);
}

TEST(ReliefStack, ThousandsOfLayersAddUp) {
  std::vector<StackLayer> layers;
  std::vector<Rect> rects;
  samples::Random random(28);
  for (int n = 0; n < 10000; ++n) {
    const double x = random.in(-500.0, 500.0);
    const double y = random.in(-500.0, 500.0);
    rects.push_back({x, y, x + random.in(1.0, 10.0), y + random.in(1.0, 10.0)});
    layers.push_back({flat(n % 7, rects.back()), Compose::kSum, nullptr});
  }
  const Stack stack(layers);
  for (int n = 0; n < 300; ++n) {
    const double x = random.in(-510.0, 510.0);
    const double y = random.in(-510.0, 510.0);
    double expected = 0;
    for (std::size_t k = 0; k < rects.size(); ++k)
      if (overlap(rects[k], {x, y, x, y})) expected += static_cast<double>(k % 7);
    EXPECT_EQ(stack.height_m(x, y), expected);
    EXPECT_TRUE(holds(stack.bounds_m({x, y, x + 5, y + 1}), expected));
  }
}

TEST(ReliefStack, AnEmptyStackIsFlat) {
  const Stack stack({});
  EXPECT_EQ(stack.height_m(3, 4), 0);
  EXPECT_EQ(stack.bounds_m({0, 0, 1, 1}).high, 0);
}

TEST(ReliefStack, BadLayersAreRefused) {
  const auto shape = flat(1, {0, 0, 1, 1});
  EXPECT_THROW(Stack({{nullptr, Compose::kSum, nullptr}}), std::invalid_argument);
  EXPECT_THROW(Stack({{shape, Compose::kReplace, nullptr}}), std::invalid_argument);
  EXPECT_THROW(Stack({{shape, Compose::kMax, shape}}), std::invalid_argument);
  EXPECT_THROW(Stack(std::vector<StackLayer>(kMaxStackLayers + 1, {shape, Compose::kSum, nullptr})),
               std::invalid_argument);
}

}  // namespace
}  // namespace relief
