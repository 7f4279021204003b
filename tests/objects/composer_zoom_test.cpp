// Objects as the camera comes nearer in small steps: none vanishes from half a pixel on, and none jumps by more than the
// tolerance.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <glm/ext/scalar_constants.hpp>

#include "tests/objects/level_views.h"
#include "tests/support/sanitized.h"

namespace objects {
namespace {

using level_views::KnownModel;
using level_views::Random;

constexpr double kStep = 1.005;
constexpr double kLargest_px = 30;

// White models, each seen from some sides.
const std::vector<KnownModel>& zoomed_models() {
  static const std::vector<KnownModel> models = [] {
    std::vector<KnownModel> out = level_views::known_models();
    out.push_back(level_views::known(level_views::levels_of(make_box({1, 1, 0.05F})), false));
    out.push_back(level_views::known(level_views::levels_of(make_cylinder(0.05F, 2, 24)), false));
    return out;
  }();
  return models;
}

// An object that covers this part of a pixel, shared by four pixels, changes one by a step of bytes at least where it shows by
// half of its area; by rays it shows wholly.
constexpr double kSeen_px = 8.0 / 255;

// Returns the area of an object's silhouette by many rays, pixels.
double silhouette_px(const core::DrawRequest& r, const PlacedObject& o, const glm::dvec2& place,
                     double diameter_px) {
  constexpr int kSide = 200;
  RayResult met;
  int hits = 0;
  const std::uint32_t first = 0;
  for (int n = 0; n < kSide * kSide; ++n) {
    const glm::dvec2 share((n % kSide + 0.5) / kSide - 0.5, (n / kSide + 0.5) / kSide - 0.5);
    const glm::dvec2 at = place + diameter_px * share;
    nearest_object({&o, 1}, {&first, 1}, {r.view.camera.position_m, core::pixel_ray(r.view, at.x, at.y)},
                   std::numeric_limits<double>::infinity(), 0, met);
    hits += met.has_front ? 1 : 0;
  }
  return diameter_px * diameter_px * hits / (kSide * kSide);
}

struct Seen {
  double covered_px = 0;  // pixels, sum of coverage
  double shown_px = 0;    // pixels that it covers, if coverage is 0
  double stated_px = 0;
  bool is_by_rays = false;
  std::size_t level = 0;
  core::Frame frame;
};

// Draws a model so that its ball is diameter_px large in the image.
Seen seen_at(const core::DrawRequest& r, const Model& model, const glm::quat& turned, const glm::dvec2& place,
             double diameter_px) {
  Instance i;
  i.rotation = turned;
  const double f = core::focal_px(r.view);
  const double distance_m =
      2 * static_cast<double>(model.ball().radius_m) * f * core::corner_stretch(r.view) / diameter_px;
  i.position_m = r.view.camera.position_m + distance_m * core::pixel_ray(r.view, place.x, place.y) -
                 glm::dquat(turned) * glm::dvec3(model.ball().centre_m);
  // Owned by the caller.
  const Scene scene({std::shared_ptr<const Model>(std::shared_ptr<const Model>(), &model)}, {i});
  Seen out;
  out.frame = paper_frame(r);
  std::fill(out.frame.colour.begin(), out.frame.colour.end(), Rgb{0, 0, 0});
  out.stated_px = draw(scene, r, out.frame).screen_space_error_px;
  for (const Rgb& c : out.frame.colour) out.covered_px += c.r / 255.0;
  const PlacedObject o = ObjectRays(scene, level_rule(r, false)).placed(0);
  out.is_by_rays = o.by_rays;
  out.level = o.level_index;
  if (!(out.covered_px > 0)) {
    out.shown_px = o.by_rays ? silhouette_px(r, o, place, diameter_px)
                             : model.mean_silhouette_m2() * f * f / (distance_m * distance_m);
  }
  return out;
}

struct WorstStep {
  double share = 0;  // of what a step may change
  double at_px = 0;
  double level_px = 0;  // largest changes between levels, and between covered area and rays
  double disc_px = 0;
};

class ObjectZoom : public ::testing::Test {
 protected:
  static core::DrawRequest zoom_request(bool is_smooth, double tolerance_px) {
    core::DrawRequest r = request_at();
    r.view.width = 64;
    r.view.height = 48;
    r.view.fov_deg = 30;
    r.settings.smooth_edges = is_smooth;
    r.settings.lod_tolerance_px = tolerance_px;
    return r;
  }

  static void zoom(const core::DrawRequest& r, const Model& model, Random& random, WorstStep& worst) {
    const glm::dvec3 axis = random.direction();
    const glm::quat turned(glm::angleAxis(random.uniform(0, 6), axis));
    const glm::dvec2 place(32 + random.uniform(-3, 3), 24 + random.uniform(-3, 3));
    Seen before = seen_at(r, model, turned, place, kLeastDiameter_px / kStep);
    EXPECT_EQ(before.covered_px, 0);
    for (double diameter_px = kLeastDiameter_px * 1.000001; diameter_px < kLargest_px; diameter_px *= kStep) {
      Seen now = seen_at(r, model, turned, place, diameter_px);
      if (!(now.covered_px > 0)) {
        EXPECT_LT(now.shown_px, kSeen_px) << diameter_px << " by rays " << now.is_by_rays;
      }
      const double most_px = most_change(r, diameter_px, before, now);
      const double change_px = std::abs(now.covered_px - before.covered_px);
      EXPECT_LE(change_px, most_px) << diameter_px << " by rays " << now.is_by_rays;
      if (change_px / most_px > worst.share) {
        worst.share = change_px / most_px;
        worst.at_px = diameter_px;
      }
      if (before.is_by_rays != now.is_by_rays) {
        worst.disc_px = std::max(worst.disc_px, change_px);
      } else if (before.level != now.level) {
        worst.level_px = std::max(worst.level_px, change_px / diameter_px);
      }
      before = std::move(now);
    }
  }

  // Returns how much the sum of coverage may change in a step, pixels.
  static double most_change(const core::DrawRequest& r, double diameter_px, const Seen& before,
                            const Seen& now) {
    // The image grows by a step, which is at most a hundredth of its area.
    const double grown_px = 0.011 * std::max(before.covered_px, now.covered_px);
    // An edge along a row of rays lets all of the row change at once; two edges may at a time. With smooth edges a row of
    // rays is an eighth of a pixel.
    const double row_px = r.settings.smooth_edges ? 0.125 : 1;
    const double sampled_px = (2 * diameter_px + 2) * row_px;
    if (before.is_by_rays == now.is_by_rays && before.level == now.level) return grown_px + sampled_px;
    // The outline, which is at most that of a disc inside and outside, moves by what both images state.
    const double outline_px = 2 * glm::pi<double>() * diameter_px;
    return grown_px + sampled_px + outline_px * std::max(before.stated_px, now.stated_px);
  }

  static void zoom_all(int turns, unsigned seed) {
    Random random(seed);
    for (std::size_t m = 0; m < zoomed_models().size(); ++m) {
      for (const bool is_smooth : {true, false}) {
        WorstStep worst;
        for (int turn = 0; turn < turns; ++turn) {
          const std::array tolerances{0.1, 0.5, 1.0, 2.0};
          const core::DrawRequest r =
              zoom_request(is_smooth, tolerances[static_cast<std::size_t>(random.integer(0, 3))]);
          zoom(r, *zoomed_models()[m].model, random, worst);
        }
        std::printf(
            "model %zu, %s edges: largest change %.3f of what is allowed, at %.1f px; between levels %.3f px a "
            "pixel of diameter, to rays %.3f px2\n",
            m, is_smooth ? "smooth" : "hard", worst.share, worst.at_px, worst.level_px, worst.disc_px);
      }
    }
  }
};

TEST_F(ObjectZoom, NothingVanishesOrJumps) { zoom_all(::test_support::kIsSanitized ? 1 : 2, 20261126); }

class LongObjectZoom : public ObjectZoom {};

TEST_F(LongObjectZoom, NothingVanishesOrJumpsFromManySides) { zoom_all(20, 20261127); }

}  // namespace
}  // namespace objects
