#include "vpe/core/metrics.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/support/support.h"

namespace vpe::core {
namespace {

constexpr double kRadius_m = mars::kMarsRadius_m;
constexpr float kSky = std::numeric_limits<float>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Radius = std::function<double(const glm::dvec3&)>;

SurfaceRadius batched(const Radius& radius) {
  return [radius](std::span<const glm::dvec3> directions, std::span<double> radius_m) {
    std::transform(directions.begin(), directions.end(), radius_m.begin(), radius);
  };
}

// Returns hills of 400 m, 12 km apart, and smaller ones.
double hills(const glm::dvec3& d) {
  const glm::dvec3 p = d * kRadius_m;
  return kRadius_m + 400 * std::sin(p.y / 4000) * std::sin(p.z / 4000) + 100 * std::sin(p.y / 900 + p.z / 1300);
}

// Returns the distance to the sphere of a radius, infinity if the ray misses it. The camera is outside.
double cast_sphere(const glm::dvec3& camera, const glm::dvec3& ray, double radius_m) {
  const double along = -glm::dot(camera, ray);
  const double aside2 = glm::dot(camera, camera) - along * along;
  if (along <= 0 || aside2 > radius_m * radius_m) return kSky;
  return along - std::sqrt(radius_m * radius_m - aside2);
}

// Returns the first intersection with a surface of slopes below 1.7: half the height above it is always a safe
// step.
double cast(const glm::dvec3& camera, const glm::dvec3& ray, const Radius& radius) {
  for (double t = 0; t < 150e3;) {
    const glm::dvec3 p = camera + ray * t;
    const double r = glm::length(p);
    if (r > kRadius_m + 2000 && glm::dot(p, ray) > 0) break;
    const double height_m = r - radius(p / r);
    if (height_m < 1e-7) return t;
    t += height_m / 2;
  }
  return kSky;
}

std::vector<float> draw(const View& view, const std::function<double(const glm::dvec3&)>& range_of_ray) {
  std::vector<float> range;
  const SubRectangle part = drawn_part(view);
  for (int y = 0; y < part.height; ++y) {
    for (int x = 0; x < part.width; ++x) {
      range.push_back(static_cast<float>(range_of_ray(pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5))));
    }
  }
  return range;
}

std::vector<float> draw_surface(const View& view, const Radius& radius) {
  return draw(view, [&](const glm::dvec3& ray) { return cast(view.camera.position_m, ray, radius); });
}

View make_view(double alt_m, double pitch_deg, int width, int height, double roll_deg = 0) {
  View view;
  view.camera = mars::to_camera({0.3, 0.2, alt_m, 30, pitch_deg, roll_deg}, kRadius_m);
  view.width = width;
  view.height = height;
  return view;
}

class OnHills : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { exact_ = draw_surface(view_, hills); }

  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * view_.width + x); }
  ImageErrors measure(const std::vector<float>& drawn) const {
    return compare_to_reference(view_, drawn, exact_, surface_);
  }

  // Only the pixels whose reference is ground.
  ShiftSummary backward_on_ground(const std::vector<float>& drawn) const {
    std::vector<double> shift_px = backward_shift_px(view_, drawn, exact_);
    for (std::size_t n = 0; n < shift_px.size(); ++n) {
      if (!std::isfinite(exact_[n])) shift_px[n] = kNan;
    }
    return summarize(shift_px, view_.width);
  }

  static inline const View view_ = make_view(1500, -8, 120, 90);
  static inline const SurfaceRadius surface_ = batched(hills);
  static inline std::vector<float> exact_;
};

TEST_F(OnHills, TheImageShowsGroundAndSky) {
  const auto sky = std::count(exact_.begin(), exact_.end(), kSky);
  EXPECT_GT(sky, 1000);
  EXPECT_LT(sky, 8000);
}

TEST_F(OnHills, APerfectImageMeasuresOnlyFloatRounding) {
  const ImageErrors errors = measure(exact_);
  EXPECT_GT(errors.forward.pixels, 2000);
  // The stated rounding, for slopes up to 0.4.
  EXPECT_LE(errors.forward.max_px, 6e-8 * focal_px(view_) * 1.4 + 1e-9);
  EXPECT_GT(errors.forward.max_px, 0);
  EXPECT_EQ(errors.backward.pixels, 118 * 88);
  EXPECT_EQ(errors.backward.max_px, 0);
  EXPECT_EQ(errors.sky_for_ground + errors.false_surface + errors.invalid, 0);
  EXPECT_EQ(errors.forward.share_over_1px, 0);
}

TEST_F(OnHills, RoundingOfRangesStaysWithinItsStatedBackwardBound) {
  std::vector<float> nudged = exact_;
  for (float& range : nudged) range = std::isfinite(range) ? std::nextafter(range, 0.0F) : range;
  const double worst_px = measure(nudged).backward.max_px;
  EXPECT_LE(worst_px, 1.2e-7 * focal_px(view_));
  EXPECT_GT(worst_px, 0);
}

TEST_F(OnHills, ARaisedSurfaceShiftsByErrorTimesFocalOverRange) {
  for (const double deviation_m : {-5.0, 0.5, 20.0}) {
    const std::vector<float> drawn =
        draw_surface(view_, [deviation_m](const glm::dvec3& d) { return hills(d) + deviation_m; });
    const std::vector<double> shift_px = forward_shift_px(view_, drawn, surface_);
    for (std::size_t n = 0; n < drawn.size(); ++n) {
      if (!std::isfinite(drawn[n])) {
        EXPECT_TRUE(std::isnan(shift_px[n]));
        continue;
      }
      const double expected_px = std::abs(deviation_m) * focal_px(view_) / drawn[n];
      ASSERT_NEAR(shift_px[n], expected_px, 0.01 * expected_px);
    }
    // Backward: never more than the same displacement at the nearest ground, once the net's 8 % are off.
    const ImageErrors errors = measure(drawn);
    const double nearest_m = *std::min_element(drawn.begin(), drawn.end());
    EXPECT_LE(errors.backward.p999_px,
              std::max(1.0, 1.09 * std::abs(deviation_m) * focal_px(view_) / nearest_m));
    EXPECT_GT(errors.backward.median_px, 0);
  }
}

// Straight down, only the range shows an error.
TEST(Metrics, ARaisedSphereSeenFromAboveShiftsBackwardsByTheSame) {
  const View view = make_view(10000, -90, 60, 60);
  const double deviation_m = 30;
  const auto at_radius = [&](double radius_m) {
    return draw(view,
                [&](const glm::dvec3& ray) { return cast_sphere(view.camera.position_m, ray, radius_m); });
  };
  const std::vector<float> exact = at_radius(kRadius_m);
  const std::vector<double> shift_px = backward_shift_px(view, at_radius(kRadius_m + deviation_m), exact);
  const double expected_px = deviation_m * focal_px(view) / 10000;
  EXPECT_NEAR(shift_px[30 * 60 + 30], expected_px, 0.01 * expected_px);
}

// On an inclined plane-like patch the nearest point is the foot of the perpendicular.
TEST(Metrics, ObliqueBackwardShiftIsThePerpendicularDistance) {
  for (const double roll_deg : {0.0, 22.5, 45.0, 70.0}) {
    const View view = make_view(10000, -45, 80, 80, roll_deg);
    const auto at_radius = [&](double radius_m) {
      return draw(view,
                  [&](const glm::dvec3& ray) { return cast_sphere(view.camera.position_m, ray, radius_m); });
    };
    const std::vector<float> exact = at_radius(kRadius_m);
    const double deviation_m = 60;
    const std::vector<double> shift_px = backward_shift_px(view, at_radius(kRadius_m + deviation_m), exact);
    const std::size_t middle = 40 * 80 + 40;
    const double expected_px = deviation_m * focal_px(view) / exact[middle];
    EXPECT_GE(shift_px[middle], 0.99 * expected_px) << roll_deg;
    EXPECT_LE(shift_px[middle], 1.09 * expected_px) << roll_deg;
  }
}

TEST_F(OnHills, OnePixelAsideMeasuresOnePixel) {
  View moved = view_;
  const auto move_down = [&](double rows) {
    moved.principal_offset_px = {0, rows};
    return draw_surface(moved, hills);
  };
  const std::vector<float> one = move_down(1);
  EXPECT_NEAR(measure(one).backward.max_px, 1, 1e-3);
  EXPECT_GT(backward_on_ground(one).median_px, 0.85);
  EXPECT_EQ(measure(one).sky_for_ground, 0);
  EXPECT_EQ(measure(one).false_surface, 0);

  const std::vector<float> three = move_down(3);
  EXPECT_NEAR(measure(three).backward.p999_px, 3, 0.05);
  EXPECT_GT(backward_on_ground(three).median_px, 2);
  EXPECT_GT(backward_on_ground(three).share_over_1px, 0.9);

  const std::vector<float> quarter = move_down(0.25);
  EXPECT_NEAR(backward_on_ground(quarter).median_px, 0.25, 0.04);
  EXPECT_LE(measure(quarter).backward.max_px, 1 + 1e-3);  // pixels on the skyline change sides
}

TEST_F(OnHills, AMissingRidgeIsFoundBackwardsAndOnlyThere) {
  // A wall of 300 m, 1 km thick, 12 km from the camera.
  const glm::dvec3 ahead = glm::normalize(view_.camera.axes.forward -
                                          mars::direction({0.3, 0.2}) *
                                              glm::dot(view_.camera.axes.forward, mars::direction({0.3, 0.2})));
  const Radius with_ridge = [ahead](const glm::dvec3& d) {
    const double along_m = glm::dot(d, ahead) * kRadius_m;
    const double across = (along_m - glm::dot(mars::direction({0.3, 0.2}), ahead) * kRadius_m - 12000) / 500;
    return hills(d) + 800 * std::exp(-across * across);
  };
  const std::vector<float> reference = draw_surface(view_, with_ridge);
  // The drawn image lacks the ridge where it hides the far ground: its ranges are on S, but behind the ridge.
  const ImageErrors errors =
      compare_to_reference(view_, draw_surface(view_, hills), reference, batched(with_ridge));
  EXPECT_GT(errors.backward.max_px, 10);
  EXPECT_GT(errors.backward.share_over_1px, 0.03);
  const int worst_x = errors.backward.worst_x;
  const int worst_y = errors.backward.worst_y;
  ASSERT_GE(worst_x, 0);
  EXPECT_NE(reference[at(worst_x, worst_y)], exact_[at(worst_x, worst_y)]);
  // With the ridge drawn there is no error.
  EXPECT_EQ(compare_to_reference(view_, reference, reference, batched(with_ridge)).backward.max_px, 0);
}

TEST_F(OnHills, HolesAndFalseSurfaceAreCounted) {
  std::vector<float> drawn = exact_;
  ASSERT_TRUE(std::isfinite(exact_[at(60, 80)]));
  ASSERT_FALSE(std::isfinite(exact_[at(60, 5)]));
  drawn[at(60, 80)] = kSky;
  for (int x = 10; x < 13; ++x) drawn[at(x, 85)] = kSky;
  drawn[at(0, 89)] = kSky;  // corners: what lies beside them is not known
  drawn[at(60, 5)] = 5000;
  drawn[at(0, 0)] = 5000;
  const ImageErrors errors = measure(drawn);
  EXPECT_EQ(errors.sky_for_ground, 4);
  EXPECT_EQ(errors.false_surface, 1);
  EXPECT_EQ(errors.invalid, 0);
  EXPECT_GT(errors.forward.max_px, 10);  // the false surface hangs in the air
}

TEST_F(OnHills, SkyThatMovesAlongTheSkylineIsNoHole) {
  std::vector<float> drawn = exact_;
  int changed = 0;
  for (int x = 0; x < view_.width; ++x) {
    for (int y = 1; y < view_.height; ++y) {
      if (!std::isfinite(exact_[at(x, y - 1)]) && std::isfinite(exact_[at(x, y)])) {
        drawn[at(x, y)] = kSky;
        ++changed;
        break;
      }
    }
  }
  ASSERT_EQ(changed, view_.width);
  const ImageErrors errors = measure(drawn);
  EXPECT_EQ(errors.sky_for_ground, 0);
  EXPECT_LE(errors.backward.max_px, 1);
  EXPECT_GT(errors.backward.max_px, 0);
}

TEST_F(OnHills, InvalidRangesAreCountedAndHurt) {
  std::vector<float> drawn = exact_;
  drawn[at(50, 80)] = static_cast<float>(kNan);
  drawn[at(51, 80)] = 0;
  drawn[at(52, 80)] = -3;
  drawn[at(53, 80)] = -kSky;
  const ImageErrors errors = measure(drawn);
  EXPECT_EQ(errors.invalid, 4);
  EXPECT_EQ(errors.forward.pixels,
            std::count_if(exact_.begin(), exact_.end(), [](float r) { return std::isfinite(r); }) - 4);
  EXPECT_GT(errors.backward.max_px, 0.4);
}

TEST_F(OnHills, ThreadsDoNotMatter) {
  const std::vector<float> drawn = draw_surface(view_, [](const glm::dvec3& d) { return hills(d) + 7; });
  const std::vector<double> one = forward_shift_px(view_, drawn, surface_);
  const std::vector<double> four = forward_shift_px(view_, drawn, surface_, {.threads = 4});
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  EXPECT_TRUE(std::equal(one.begin(), one.end(), four.begin(), same));
  const std::vector<double> back_one = backward_shift_px(view_, drawn, exact_);
  const std::vector<double> back_four = backward_shift_px(view_, drawn, exact_, {.threads = 4});
  EXPECT_TRUE(std::equal(back_one.begin(), back_one.end(), back_four.begin(), same));
}

TEST_F(OnHills, APartMeasuresAsInTheWhole) {
  const std::vector<float> drawn = draw_surface(view_, [](const glm::dvec3& d) { return hills(d) + 7; });
  const std::vector<double> whole_px = forward_shift_px(view_, drawn, surface_);
  View part = view_;
  part.part = {30, 60, 40, 20};
  const std::vector<float> drawn_part = draw_surface(part, [](const glm::dvec3& d) { return hills(d) + 7; });
  const std::vector<double> part_px = forward_shift_px(part, drawn_part, surface_);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 40; ++x) {
      ASSERT_EQ(part_px[static_cast<std::size_t>(y * 40 + x)], whole_px[at(x + 30, y + 60)]);
    }
  }
}

TEST_F(OnHills, WrongSizesAreRefused) {
  const std::vector<float> small(17);
  EXPECT_THROW(forward_shift_px(view_, small, surface_), std::invalid_argument);
  EXPECT_THROW(backward_shift_px(view_, small, exact_), std::invalid_argument);
  EXPECT_THROW(backward_shift_px(view_, exact_, small), std::invalid_argument);
  EXPECT_THROW(compare_to_reference(view_, exact_, small, surface_), std::invalid_argument);
  EXPECT_THROW(check_horizon(view_, small, kRadius_m, kRadius_m), std::invalid_argument);
}

// The same image through other projections: the measure uses their focal length.
TEST(Metrics, RoundProjections) {
  for (const Projection projection : {Projection::kCylinder, Projection::kEquirectangular}) {
    View view = make_view(1500, 0, 360, 57);
    view.projection = projection;
    view.fov_deg = projection == Projection::kCylinder ? 53.0 : 57.0;
    const std::vector<float> drawn = draw(
        view, [&](const glm::dvec3& ray) { return cast_sphere(view.camera.position_m, ray, kRadius_m + 10); });
    const std::vector<double> shift_px =
        forward_shift_px(view, drawn, batched([](const glm::dvec3&) { return kRadius_m; }));
    int measured = 0;
    for (std::size_t n = 0; n < drawn.size(); ++n) {
      if (!std::isfinite(drawn[n])) continue;
      const double expected_px = 10 * focal_px(view) / drawn[n];
      ASSERT_NEAR(shift_px[n], expected_px, 0.001 * expected_px);
      ++measured;
    }
    EXPECT_GT(measured, 360 * 20);
  }
}

TEST(Metrics, SummaryOfKnownShifts) {
  std::vector<double> shift_px;
  for (int n = 1; n <= 1000; ++n) shift_px.push_back(n / 500.0);
  shift_px.insert(shift_px.begin() + 10, std::numeric_limits<double>::quiet_NaN());
  const ShiftSummary s = summarize(shift_px, 100);
  EXPECT_EQ(s.pixels, 1000);
  EXPECT_EQ(s.median_px, 1.0);
  EXPECT_EQ(s.p90_px, 1.8);
  EXPECT_EQ(s.p99_px, 1.98);
  EXPECT_EQ(s.p999_px, 1.998);
  EXPECT_EQ(s.max_px, 2.0);
  EXPECT_EQ(s.share_over_1px, 0.5);
  EXPECT_EQ(s.worst_x, 0);
  EXPECT_EQ(s.worst_y, 10);
  EXPECT_EQ(summarize({}, 1).pixels, 0);
  EXPECT_EQ(summarize({}, 1).worst_x, -1);
  const std::vector<double> with_infinity{1, std::numeric_limits<double>::infinity(), 2};
  EXPECT_EQ(summarize(with_infinity, 3).worst_x, 1);
}

TEST(Metrics, JsonHasEveryFigure) {
  ImageErrors errors;
  errors.forward.max_px = 0.5;
  errors.backward.worst_x = 7;
  errors.sky_for_ground = 3;
  const nlohmann::json json = nlohmann::json::parse(to_json(errors));
  EXPECT_EQ(json.at("forward").at("max_px"), 0.5);
  EXPECT_EQ(json.at("backward").at("worst_x"), 7);
  EXPECT_EQ(json.at("holes"), 3);
  EXPECT_EQ(json.at("forward").size(), 9U);
}

class Horizon : public ::testing::TestWithParam<double> {};

TEST_P(Horizon, ASphereDrawnExactlyHasNone) {
  const double alt_m = GetParam();
  for (const double roll_deg : {0.0, 35.0}) {
    const double dip_deg = mars::horizon_dip_rad(alt_m, kRadius_m) / mars::kRadiansPerDegree;
    const View view = make_view(alt_m, -dip_deg, 64, 64, roll_deg);
    std::vector<float> range =
        draw(view, [&](const glm::dvec3& ray) { return cast_sphere(view.camera.position_m, ray, kRadius_m); });
    const HorizonErrors none = check_horizon(view, range, kRadius_m, kRadius_m);
    EXPECT_EQ(none.sky_below, 0);
    EXPECT_EQ(none.surface_above, 0);
    // Sky about 3 degrees below the horizon, surface as much above it.
    const auto at = [roll_deg](double up_px) {
      const double roll_rad = roll_deg * mars::kRadiansPerDegree;
      const int x = static_cast<int>(32 - up_px * std::sin(roll_rad));
      const int y = static_cast<int>(32 - up_px * std::cos(roll_rad));
      return static_cast<std::size_t>(y * 64 + x);
    };
    range[at(-3)] = kSky;
    range[at(3)] = 1000;
    const HorizonErrors both = check_horizon(view, range, kRadius_m, kRadius_m);
    EXPECT_EQ(both.sky_below, 1);
    EXPECT_EQ(both.surface_above, 1);
  }
}
INSTANTIATE_TEST_SUITE_P(Altitudes, Horizon, ::testing::Values(0.1, 2.0, 1e3, 3e5, 3e7));

TEST(Metrics, BetweenLowestAndHighestSphereAnythingMayBe) {
  const View view = make_view(1000, -1.4, 64, 64);
  const std::vector<float> sky(64 * 64, kSky);
  const std::vector<float> ground(64 * 64, 1000.0F);
  const auto low_sky = check_horizon(view, sky, kRadius_m - 8000, kRadius_m).sky_below;
  const auto sphere_sky = check_horizon(view, sky, kRadius_m, kRadius_m).sky_below;
  EXPECT_GT(low_sky, 0);
  EXPECT_LT(low_sky, sphere_sky);
  EXPECT_GT(check_horizon(view, ground, kRadius_m, kRadius_m + 500).surface_above, 0);
  // Inside the highest sphere surface may be anywhere; below the lowest one there is no sky.
  EXPECT_EQ(check_horizon(view, ground, kRadius_m, kRadius_m + 2000).surface_above, 0);
  EXPECT_EQ(check_horizon(view, sky, kRadius_m + 1500, kRadius_m + 2000).sky_below, 64 * 64);
}

}  // namespace
}  // namespace vpe::core
