// Light, air and gamma against their definitions.
#include "vpe/core/appearance/shading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"
#include "vpe/core/appearance/sky.h"

namespace vpe::core {
namespace {

using test_support::Random;

const glm::dvec3 kDust = air_of(Atmosphere::kMars).haze;

constexpr double kRadius_m = mars::kMarsRadius_m;

TEST(Light, IsTheRootOfAmbientAndDiffuse) {
  EXPECT_EQ(light(0.25, 0, 1), 0.5);
  EXPECT_EQ(light(0, 1, 0.25), 0.5);
  EXPECT_DOUBLE_EQ(light(0.05, 1.235, 0.5), std::sqrt(0.6675));
  EXPECT_GT(light(0.05, 1.235, 1), 1.0);  // not cut here
  for (const double away : {0.0, -1e-300, -0.5, -1.0}) EXPECT_EQ(light(0.16, 1.2, away), std::sqrt(0.16));
  EXPECT_EQ(light(0, 0, 1), 0.0);
  double last = light(0.05, 1.235, 0);
  for (int n = 1; n <= 1000; ++n) {
    const double next = light(0.05, 1.235, n / 1000.0);
    EXPECT_GT(next, last);
    last = next;
  }
}

// Returns the integral of air_m()'s definition by adaptive Simpson's rule along the straight line.
class AirOracle {
 public:
  AirOracle(double camera_height_m, double up_sine)
      : r_(static_cast<long double>(kRadius_m) + camera_height_m),
        up_(up_sine),
        along_(std::sqrt(std::max(0.0L, 1.0L - up_ * up_))) {}

  long double height_m(long double t) const {
    return std::hypot(r_ + t * up_, t * along_) - static_cast<long double>(kRadius_m);
  }
  // Returns the sine of the line's elevation at t.
  double up_sine_at(long double t) const {
    const long double x = r_ + t * up_, y = t * along_;
    return static_cast<double>((x * up_ + y * along_) / std::hypot(x, y));
  }
  long double lowest_at() const { return std::max(0.0L, -r_ * up_); }

  // Heights fall up to lowest_at() and rise from there: each side is below the top in one interval.
  long double operator()(long double distance_m) const {
    const long double low = std::min(lowest_at(), distance_m);
    if (height_m(low) >= static_cast<long double>(kAirTop_m)) return 0;
    const auto top_between = [&](long double inside, long double outside) {
      if (height_m(outside) <= static_cast<long double>(kAirTop_m)) return outside;
      for (int n = 0; n < 90; ++n) {
        const long double middle = (inside + outside) / 2;
        (height_m(middle) < static_cast<long double>(kAirTop_m) ? inside : outside) = middle;
      }
      return inside;
    };
    return integral(top_between(low, 0), low) + integral(low, top_between(low, distance_m));
  }

 private:
  long double density(long double t) const {
    return std::exp(-height_m(t) / static_cast<long double>(kAirScale_m));
  }
  long double integral(long double a, long double b) const {
    // Pieces first, so that no narrow maximum falls between the first points.
    constexpr int kPieces = 16;
    long double sum = 0;
    for (int n = 0; n < kPieces; ++n) {
      const long double from = a + (b - a) * n / kPieces, to = a + (b - a) * (n + 1) / kPieces;
      sum += refined(from, to, density(from), density((from + to) / 2), density(to), 0);
    }
    return sum;
  }
  long double refined(long double a, long double b, long double fa, long double fm, long double fb,
                      int depth) const {
    const long double m = (a + b) / 2;
    const long double left = density((a + m) / 2), right = density((m + b) / 2);
    const long double whole = (b - a) / 6 * (fa + 4 * fm + fb);
    const long double halves = (b - a) / 12 * (fa + 4 * left + 2 * fm + 4 * right + fb);
    if (depth > 40 || std::abs(halves - whole) <= 1e-9L * halves) return halves + (halves - whole) / 15;
    return refined(a, m, fa, left, fm, depth + 1) + refined(m, b, fm, right, fb, depth + 1);
  }

  long double r_, up_, along_;
};

// Heights of cameras from the deepest ground to ten radii; lines in any direction that stay above that ground.
struct Line {
  double camera_height_m, up_sine, distance_m;
};
constexpr double kDeepest_m = -8000;
Line random_line(Random& random, int trial) {
  Line out{};
  switch (trial % 3) {
    case 0: out.camera_height_m = random.uniform(kDeepest_m, kAirTop_m); break;
    case 1: out.camera_height_m = random.log_uniform(0.1, 10 * kRadius_m); break;
    default: out.camera_height_m = random.uniform(0, 10 * kRadius_m); break;
  }
  const double r = kRadius_m + out.camera_height_m, deepest = kRadius_m + kDeepest_m;
  // Half of the lines pass near the limb, where the air is longest.
  const double graze = std::clamp((deepest + random.uniform(0, 1.1 * (kAirTop_m - kDeepest_m))) / r, 0.0, 1.0);
  out.up_sine = trial % 2 == 0 ? random.uniform(-1, 1) : -std::sqrt(1 - graze * graze);
  const AirOracle line(out.camera_height_m, out.up_sine);
  // Up to the deepest ground, or behind the limb to beyond the air.
  double farthest = 3 * r;
  if (line.height_m(line.lowest_at()) < static_cast<long double>(kDeepest_m)) {
    const double half = -r * out.up_sine;
    farthest = half - std::sqrt(std::max(0.0, half * half - (r * r - deepest * deepest)));
  }
  out.distance_m = trial % 5 == 0 ? farthest : random.log_uniform(1e-9, 1.0) * farthest;
  return out;
}

TEST(Air, IsTheIntegralOfItsDensity) {
  Random random(1);
  double worst = 0, worst_over_limb = 0;
  int in_air = 0, over_limbs = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Line at = random_line(random, trial);
    const AirOracle line(at.camera_height_m, at.up_sine);
    const auto exact = static_cast<double>(line(at.distance_m));
    const double got = air_m(kRadius_m, at.camera_height_m, at.up_sine, at.distance_m);
    const double off_m = std::abs(got - exact);
    SCOPED_TRACE(testing::Message() << "eye at " << at.camera_height_m << ", sine " << at.up_sine << ", "
                                    << at.distance_m << " m: " << got << " for " << exact);
    const bool limb = line.lowest_at() > 0 && line.lowest_at() < static_cast<long double>(at.distance_m);
    ASSERT_LE(off_m, (limb ? kAirLimbError : kAirError) * exact + 1e-6);
    if (exact < 1.0) continue;
    ++in_air;
    over_limbs += limb ? 1 : 0;
    (limb ? worst_over_limb : worst) = std::max(limb ? worst_over_limb : worst, off_m / exact);
  }
  std::printf("%d ways through air, %.2g off at most; %d of them over a limb, %.2g off at most\n", in_air,
              worst, over_limbs, worst_over_limb);
  EXPECT_GT(in_air - over_limbs, 5000);
  EXPECT_GT(over_limbs, 1000);
  // The stated bounds are not much too large.
  EXPECT_GT(worst, 0.3 * kAirError);
  EXPECT_GT(worst_over_limb, 0.3 * kAirLimbError);
}

TEST(Air, AWayIsTheSumOfItsParts) {
  Random random(2);
  for (int trial = 0; trial < 20000; ++trial) {
    const Line at = random_line(random, trial);
    const AirOracle line(at.camera_height_m, at.up_sine);
    const double first_m = random.uniform(0, 1) * at.distance_m;
    const auto height_m = static_cast<double>(line.height_m(first_m));
    const double whole = air_m(kRadius_m, at.camera_height_m, at.up_sine, at.distance_m);
    const double first = air_m(kRadius_m, at.camera_height_m, at.up_sine, first_m);
    const double rest = air_m(kRadius_m, height_m, line.up_sine_at(first_m), at.distance_m - first_m);
    // A direction far out is rounded to metres beside the limb.
    const bool limb = line.lowest_at() > 0 && line.lowest_at() < static_cast<long double>(at.distance_m);
    EXPECT_NEAR(first + rest, whole, 2 * (limb ? kAirLimbError : kAirError) * whole + 0.01)
        << at.camera_height_m << " " << at.up_sine << " " << at.distance_m << " in " << first_m;
    EXPECT_GE(first, 0);
    EXPECT_GE(whole, first * (1 - 2 * kAirLimbError) - 1e-6);
  }
}

TEST(Air, ThereIsNoneOutsideOfIt) {
  const double r = kRadius_m + 1e6;
  const double top = kRadius_m + kAirTop_m;
  const double graze = -std::sqrt(1 - (top / r) * (top / r));
  EXPECT_EQ(air_m(kRadius_m, 1e6, graze * (1 - 1e-9), 1e9), 0);  // past the air
  EXPECT_GT(air_m(kRadius_m, 1e6, graze * (1 + 1e-6), 1e9), 0);
  EXPECT_EQ(air_m(kRadius_m, 1e6, 1, 1e9), 0);  // away from it
  EXPECT_EQ(air_m(kRadius_m, kAirTop_m + 1, 0, 1e9), 0);
  EXPECT_EQ(air_m(kRadius_m, 1e6, -1, 1e6 - kAirTop_m - 1), 0);  // not yet in it
  EXPECT_NEAR(air_m(kRadius_m, 1e6, -1, 1e6 - kAirTop_m + 1), std::exp(-6.0), 1e-4);
  EXPECT_EQ(air_m(kRadius_m, 10, -0.5, 0), 0);
  // From the ground straight up through all the air.
  EXPECT_NEAR(air_m(kRadius_m, 0, 1, 1e7), kAirScale_m * (1 - std::exp(-6.0)), 0.01);
}

TEST(Haze, TwoPercentOfContrastAreLeftAtTheVisibility) {
  for (const double visibility_m : {10.0, 100.0, 1000.0}) {
    const double air = air_m(kRadius_m, 0, 0, visibility_m);
    EXPECT_NEAR(air, visibility_m, 1e-4 * visibility_m);
    EXPECT_NEAR(transmittance(air, visibility_m), 0.02, 2e-5);
  }
  EXPECT_EQ(transmittance(1e6, 0), 1);  // clear air
  EXPECT_EQ(transmittance(0, 5000), 1);
  EXPECT_DOUBLE_EQ(transmittance(3000, 5000) * transmittance(4000, 5000), transmittance(7000, 5000));
}

TEST(Haze, IsLightByDayAndDarkByNight) {
  EXPECT_EQ(haze_colour(kDust, 1), kDust);
  EXPECT_EQ(haze_colour(kDust, 0.3), kDust);
  EXPECT_EQ(haze_colour(kDust, -0.15), haze_colour(kDust, -1));
  EXPECT_GT(haze_colour(kDust, -1).r, 0);
  double last = haze_colour(kDust, -1).r;
  for (int n = -999; n <= 1000; ++n) {
    const glm::dvec3 here = haze_colour(kDust, n / 1000.0);
    EXPECT_GE(here.r, last);
    EXPECT_LE(here.r, last + 1);  // no step
    // All have one hue.
    EXPECT_NEAR(here.g * kDust.r, here.r * kDust.g, 1e-9);
    EXPECT_NEAR(here.b * kDust.r, here.r * kDust.b, 1e-9);
    last = here.r;
  }
}

std::vector<vpe::base::Rgb> every_byte() {
  std::vector<vpe::base::Rgb> out;
  for (int n = 0; n < 256; ++n) {
    const auto byte = static_cast<std::uint8_t>(n);
    out.push_back({byte, static_cast<std::uint8_t>(255 - n), static_cast<std::uint8_t>(n ^ 0x55)});
  }
  return out;
}

TEST(Gamma, OneChangesNothing) {
  std::vector<vpe::base::Rgb> colours = every_byte();
  apply_gamma(colours, 1);
  EXPECT_EQ(colours, every_byte());
  // The table does not change that either.
  apply_gamma(colours, 1 + 1e-12);
  EXPECT_EQ(colours, every_byte());
}

TEST(Gamma, KeepsEndsAndOrder) {
  for (const double gamma : {0.1, 0.45, 0.9, 1.1, 1.8, 2.2, 10.0}) {
    std::vector<vpe::base::Rgb> colours = every_byte();
    apply_gamma(colours, gamma);
    EXPECT_EQ(colours.front(), (vpe::base::Rgb{0, 255, colours[0].b}));
    EXPECT_EQ(colours.back(), (vpe::base::Rgb{255, 0, colours[255].b}));
    for (std::size_t n = 0; n < 256; ++n) {
      EXPECT_NEAR(colours[n].r, 255 * std::pow(static_cast<double>(n) / 255, 1 / gamma), 0.5 + 1e-9);
      EXPECT_GE(colours[n].r, colours[n == 0 ? 0 : n - 1].r);
      EXPECT_EQ(colours[255 - n].g, colours[n].r);
      EXPECT_EQ(colours[n ^ 0x55].b, colours[n].r);
      if (gamma > 1) {
        EXPECT_GE(colours[n].r, n);
      } else {
        EXPECT_LE(colours[n].r, n);
      }
    }
  }
}

}  // namespace
}  // namespace vpe::core
