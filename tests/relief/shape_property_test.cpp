// What every shape and weight of every kind promises: support, continuity, gradients, bounds.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <rapidcheck/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "relief/interval_math.h"
#include "relief/placed.h"
#include "tests/relief/random_relief.h"

namespace relief {
namespace {

using test_support::Random;

// Returns height and weight of a random relief, and a rectangle about as large as it.
struct AnyShapes {
  std::vector<std::shared_ptr<const Shape>> shapes;
  double reach_m = 0;
};

AnyShapes any_shapes(Random& random, ReliefKind kind) {
  const PlacedRelief placed(random_relief(random, kind), mars::kMarsRadius_m);
  AnyShapes all{{placed.shapes().height}, placed.shapes().reach_m};
  if (placed.shapes().weight) all.shapes.push_back(placed.shapes().weight);
  return all;
}

// Returns the largest height of a shape near its origin, as a unit for its errors.
double scale_of(const Shape& shape, double reach_m) {
  const Interval all = shape.bounds_m(centred_rect(2 * reach_m, 2 * reach_m));
  return std::max({std::abs(all.low), std::abs(all.high), 1e-300});
}

TEST(ReliefShapes, AreZeroOutsideOfTheirSupport) {
  Random random(1);
  for (const ReliefKind kind : kEveryKind) {
    for (int n = 0; n < 200; ++n) {
      const AnyShapes any = any_shapes(random, kind);
      for (const auto& shape : any.shapes) {
        const Rect support = shape->support();
        for (int k = 0; k < 30; ++k) {
          double x_m = random.uniform(-2, 2) * any.reach_m;
          double y_m = random.uniform(-2, 2) * any.reach_m;
          if (k % 3 == 0) x_m = std::nextafter(support.x1_m, 1e300);
          if (k % 3 == 1) y_m = std::nextafter(support.y0_m, -1e300);
          if (contains(support, x_m, y_m)) continue;
          ASSERT_EQ(shape->height_m(x_m, y_m), 0) << kind_word(kind);
          ASSERT_EQ(shape->gradient(x_m, y_m), glm::dvec2(0, 0)) << kind_word(kind);
        }
      }
    }
  }
}

TEST(ReliefShapes, AreContinuousAndHaveTheGradientThatTheyState) {
  Random random(2);
  for (const ReliefKind kind : kEveryKind) {
    std::size_t checked = 0;
    std::size_t creased = 0;
    for (int n = 0; n < 100; ++n) {
      const AnyShapes any = any_shapes(random, kind);
      for (const auto& shape : any.shapes) {
        const double scale = scale_of(*shape, any.reach_m);
        const double step_m = 1e-5 * any.reach_m;
        for (int k = 0; k < 100; ++k) {
          const double x_m = random.uniform(-1.1, 1.1) * any.reach_m;
          const double y_m = random.uniform(-1.1, 1.1) * any.reach_m;
          const glm::dvec2 gradient = shape->gradient(x_m, y_m);
          const glm::dvec2 found(
              (shape->height_m(x_m + step_m, y_m) - shape->height_m(x_m - step_m, y_m)) / (2 * step_m),
              (shape->height_m(x_m, y_m + step_m) - shape->height_m(x_m, y_m - step_m)) / (2 * step_m));
          ++checked;
          const double off = std::max(std::abs(found.x - gradient.x), std::abs(found.y - gradient.y));
          const double size = std::max(std::abs(gradient.x), std::abs(gradient.y)) + scale / any.reach_m;
          if (off > 1e-2 * size) ++creased;
          // A jump of a thousandth of the height within this step would be a slope of 100 heights per reach.
          const double jump =
              std::abs(shape->height_m(x_m + 1e-9 * any.reach_m, y_m) - shape->height_m(x_m, y_m));
          ASSERT_LE(jump, 1e-3 * scale) << kind_word(kind) << " at " << x_m << " " << y_m;
        }
      }
    }
    // The finite difference is another one only across a crease.
    EXPECT_LE(static_cast<double>(creased), 0.01 * static_cast<double>(checked)) << kind_word(kind);
  }
}

RC_GTEST_PROP(ReliefShapesProperty, BoundsHoldEverywhere, (unsigned seed)) {
  Random random(seed);
  for (const ReliefKind kind : kEveryKind) {
    const AnyShapes any = any_shapes(random, kind);
    for (const auto& shape : any.shapes) {
      const double scale = scale_of(*shape, any.reach_m);
      for (int k = 0; k < 20; ++k) {
        const double side_m = any.reach_m * random.log_uniform(1e-7, 4);
        const double x_m = random.uniform(-1.2, 1.2) * any.reach_m;
        const double y_m = random.uniform(-1.2, 1.2) * any.reach_m;
        const Rect rect{x_m, y_m, x_m + side_m * random.uniform(0, 1), y_m + side_m * random.uniform(0, 1)};
        const Interval bounds = shape->bounds_m(rect);
        RC_ASSERT(bounds.low <= bounds.high);
        double low_m = std::numeric_limits<double>::infinity();
        double high_m = -low_m;
        for (int i = 0; i <= 6; ++i) {
          for (int j = 0; j <= 6; ++j) {
            const double px_m = std::min(rect.x1_m, rect.x0_m + (rect.x1_m - rect.x0_m) * i / 6);
            const double py_m = std::min(rect.y1_m, rect.y0_m + (rect.y1_m - rect.y0_m) * j / 6);
            const double height_m = shape->height_m(px_m, py_m);
            low_m = std::min(low_m, height_m);
            high_m = std::max(high_m, height_m);
          }
        }
        RC_ASSERT(bounds.low <= low_m);
        RC_ASSERT(bounds.high >= high_m);
      }
      // A rectangle of one point has the height of the point.
      for (int k = 0; k < 20; ++k) {
        const double x_m = random.uniform(-1.2, 1.2) * any.reach_m;
        const double y_m = random.uniform(-1.2, 1.2) * any.reach_m;
        const Interval bounds = shape->bounds_m({x_m, y_m, x_m, y_m});
        const double height_m = shape->height_m(x_m, y_m);
        RC_ASSERT(bounds.low <= height_m);
        RC_ASSERT(bounds.high >= height_m);
        RC_ASSERT(bounds.high - bounds.low <= 1e-10 * scale);
      }
    }
  }
}

TEST(ReliefShapes, BoundsShrinkWithTheRectangle) {
  Random random(4);
  for (const ReliefKind kind : kEveryKind) {
    for (int n = 0; n < 100; ++n) {
      const AnyShapes any = any_shapes(random, kind);
      for (const auto& shape : any.shapes) {
        const double scale = scale_of(*shape, any.reach_m);
        const double x_m = random.uniform(-1, 1) * any.reach_m;
        const double y_m = random.uniform(-1, 1) * any.reach_m;
        const auto width = [&](double side) {
          const double side_m = side * any.reach_m;
          const Interval bounds = shape->bounds_m({x_m, y_m, x_m + side_m, y_m + side_m});
          return bounds.high - bounds.low;
        };
        ASSERT_LE(width(1e-7), 0.02 * width(1e-5) + 1e-10 * scale) << kind_word(kind);
        ASSERT_LE(width(1e-5), 0.2 * scale) << kind_word(kind);
      }
    }
  }
}

TEST(ReliefShapes, HugeRectanglesHaveTheBoundsOfTheWhole) {
  Random random(5);
  for (const ReliefKind kind : kEveryKind) {
    const AnyShapes any = any_shapes(random, kind);
    for (const auto& shape : any.shapes) {
      const Interval all = shape->bounds_m(whole_plane());
      EXPECT_FALSE(std::isnan(all.low) || std::isnan(all.high)) << kind_word(kind);
      for (int k = 0; k < 200; ++k) {
        const double height_m =
            shape->height_m(random.uniform(-2, 2) * any.reach_m, random.uniform(-2, 2) * any.reach_m);
        EXPECT_LE(all.low, height_m) << kind_word(kind);
        EXPECT_GE(all.high, height_m) << kind_word(kind);
      }
    }
  }
}

TEST(ReliefWeights, AreSharesOfOne) {
  Random random(6);
  for (const ReliefKind kind : kEveryKind) {
    for (int n = 0; n < 100; ++n) {
      const PlacedRelief placed(random_relief(random, kind), mars::kMarsRadius_m);
      const Shape* weight = placed.shapes().weight.get();
      if (weight == nullptr) {
        EXPECT_EQ(placed.mode(), Mode::kAdd);
        continue;
      }
      for (int k = 0; k < 50; ++k) {
        const double reach_m = placed.shapes().reach_m;
        const double value = weight->height_m(random.uniform(-1, 1) * reach_m, random.uniform(-1, 1) * reach_m);
        EXPECT_GE(value, 0);
        EXPECT_LE(value, 1);
      }
      const Interval all = weight->bounds_m(whole_plane());
      EXPECT_EQ(all.low, 0);
      EXPECT_LE(all.high, 1);
    }
  }
}

}  // namespace
}  // namespace relief
