// What the certificate of objects says, against the image by exact rays: how far surfaces and silhouettes may lie from
// those of the models, and that nothing vanishes or jumps as the camera comes nearer.
#include <gtest/gtest.h>

#include <cstdio>
#include <glm/ext/scalar_constants.hpp>

#include "tests/objects/level_views.h"
#include "tests/support/sanitized.h"

namespace objects {
namespace {

using level_views::KnownModel;
using level_views::Random;

constexpr unsigned kViewsSeed = 20261126;
constexpr double kInf = std::numeric_limits<double>::infinity();

glm::quat any_rotation(Random& random) {
  std::normal_distribution<double> normal(0, 1);
  const auto any = [&] { return static_cast<float>(normal(random.engine())); };
  return glm::normalize(glm::quat(any(), any(), any(), any()));
}

core::DrawRequest any_request(Random& random) {
  core::DrawRequest r = request_at();
  r.view.width = 128;
  r.view.height = 96;
  r.view.fov_deg = random.log_uniform(5, 120);
  const int kind = random.integer(0, 9);
  if (kind == 0) r.view.projection = core::Projection::kCylinder;
  if (kind == 1) r.view.projection = core::Projection::kEquirectangular;
  if (kind <= 1) r.view.width = 400;
  r.view.camera.position_m = random.direction() * (kRadius_m + random.log_uniform(2, 1e8));
  const glm::dmat3 axes = glm::mat3_cast(glm::normalize(glm::dquat(any_rotation(random))));
  r.view.camera.axes.right = axes[0];
  r.view.camera.axes.up = axes[1];
  r.view.camera.axes.forward = -axes[2];
  r.settings.lod_tolerance_px = random.log_uniform(0.2, 4);
  return r;
}

// Places objects amid the image, in its corners and across its border, from where they touch the camera to where they are half
// a pixel large.
std::vector<Instance> any_instances(const core::DrawRequest& r, Random& random) {
  const std::vector<KnownModel>& models = level_views::known_models();
  std::vector<Instance> out;
  const int count = random.integer(1, 4);
  for (int n = 0; n < count; ++n) {
    Instance i;
    i.model = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(models.size()) - 1));
    i.scale = static_cast<float>(random.log_uniform(0.1, 300));
    i.rotation = any_rotation(random);
    i.is_mirrored = random.integer(0, 3) == 0;
    const Ball& ball = models[i.model].model->ball();
    const double radius_m = static_cast<double>(i.scale * ball.radius_m);
    const bool is_at_corner = random.integer(0, 2) == 0;
    const auto place = [&](int side) {
      return is_at_corner ? random.integer(0, 1) * side + random.uniform(-4, 4) : random.uniform(-4, side + 4);
    };
    const double x = place(r.view.width);
    const double y = place(r.view.height);
    const double farthest = 4 * core::focal_px(r.view) * core::corner_stretch(r.view);
    const double distance_m = radius_m * random.log_uniform(1, farthest);
    glm::dvec3 centre(ball.centre_m);
    if (i.is_mirrored) centre.x = -centre.x;
    i.position_m = r.view.camera.position_m + distance_m * core::pixel_ray(r.view, x, y) -
                   static_cast<double>(i.scale) * (glm::dquat(i.rotation) * centre);
    out.push_back(i);
  }
  return out;
}

Scene scene_of(std::vector<Instance> instances) {
  Scene::Models models;
  for (const KnownModel& known : level_views::known_models()) models.push_back(known.model);
  return Scene(models, std::move(instances));
}

// Holds how far what a view shows lies from the other view's surfaces, over what the certificate states.
struct Worst {
  double stated = 0;          // error over tolerance
  double surface = 0;         // metres over geometric_error_m
  double image = 0;           // pixels over screen_space_error_px
  std::int64_t outlines = 0;  // pixels of silhouettes
  std::int64_t places = 0;
  std::int64_t coarse = 0;  // views with a coarse level
};

class ObjectCertificate : public ::testing::Test {
 protected:
  static void compare(int views, unsigned seed) {
    Random random(seed);
    Worst worst;
    for (int n = 0; n < views; ++n) {
      const core::DrawRequest r = any_request(random);
      const Scene scene = scene_of(any_instances(r, random));
      compare_view(r, scene, worst);
      if (::testing::Test::HasFailure()) {
        ADD_FAILURE() << "view " << n;
        break;
      }
    }
    std::printf(
        "%d views, %lld with coarse levels, %lld places, %lld pixels; stated over tolerance %.3f; "
        "distance over stated %.3f, in the image %.3f\n",
        views, static_cast<long long>(worst.coarse), static_cast<long long>(worst.places),
        static_cast<long long>(worst.outlines), worst.stated, worst.surface, worst.image);
    EXPECT_GT(worst.coarse, views / 4);
  }

  static void compare_view(const core::DrawRequest& r, const Scene& scene, Worst& worst) {
    vpe::base::ThreadPool pool(1);
    const LevelRule rule = level_rule(r, false);
    const LevelRule exact_rule = level_rule(r, true);
    core::Frame coarse = paper_frame(r);
    core::Frame exact = paper_frame(r);
    const ComposedObjects drawn = compose(scene, {r, kRadius_m, nullptr}, rule, pool, coarse);
    const ComposedObjects truth = compose(scene, {r, kRadius_m, nullptr}, exact_rule, pool, exact);
    EXPECT_EQ(truth.geometric_error_m, 0);
    worst.stated = std::max(worst.stated, drawn.screen_space_error_px / r.settings.lod_tolerance_px);
    EXPECT_LE(drawn.screen_space_error_px, r.settings.lod_tolerance_px);

    if (drawn.geometric_error_m > 0) ++worst.coarse;
    const ObjectRays coarse_rays(scene, rule);
    const ObjectRays exact_rays(scene, exact_rule);
    check_places(r, exact, coarse_rays, drawn, worst);
    check_places(r, coarse, exact_rays, drawn, worst);
    if (r.view.projection != core::Projection::kPerspective) return;  // whose pixels are not square
    check_outline(coarse, exact, drawn.screen_space_error_px * rule.stretch, worst);
    check_outline(exact, coarse, drawn.screen_space_error_px * rule.stretch, worst);
  }

  // Each place that one image shows has a place of the other image's levels within the stated error, in space and in the image.
  static void check_places(const core::DrawRequest& r, const core::Frame& frame, const ObjectRays& other,
                           const ComposedObjects& drawn, Worst& worst) {
    constexpr std::size_t kEvery = 11;
    const glm::dvec3 camera_m = r.view.camera.position_m;
    const double focal_px = core::focal_px(r.view);
    const double stretch = core::corner_stretch(r.view);
    // A place at depth z has its neighbour at no less than z - error.
    const double beside = drawn.screen_space_error_px / focal_px * std::sqrt(stretch);
    const double most_px = drawn.screen_space_error_px * stretch / (1 - beside);
    for (std::size_t n = 0; n < frame.range_m.size(); n += kEvery) {
      const auto range_m = static_cast<double>(frame.range_m[n]);
      if (std::isinf(range_m)) continue;
      const int x = static_cast<int>(n) % frame.width;
      const int y = static_cast<int>(n) / frame.width;
      const glm::dvec3 direction = ray_at(r, x, y);
      const glm::dvec3 place_m = camera_m + range_m * direction;
      double least_m = kInf;
      double least_px = kInf;
      double rounding_m = 0;
      for (std::uint32_t k = 0; k < other.scene().size(); ++k) {
        const PlacedObject o = other.placed(k);
        if (glm::distance(o.around.centre_m, place_m) > o.around.radius_m * 1.001 + 1e-6 * range_m) continue;
        const KnownModel& known = level_views::known_models()[other.scene().instance(k).model];
        // Ranges are floats, and hits are of rays in floats from the ball on; grazing ones are off by more.
        rounding_m = std::max(rounding_m, 1.2e-7 * range_m + 1e-5 * o.around.radius_m);
        const glm::dvec3 near_m =
            level_views::nearest_on(known, o, o.level_index, place_m, drawn.geometric_error_m + 2 * rounding_m);
        if (!std::isfinite(near_m.x)) continue;  // none within reach
        if (glm::distance(near_m, place_m) >= least_m) continue;
        least_m = glm::distance(near_m, place_m);
        if (r.view.projection != core::Projection::kPerspective) {
          least_px = focal_px * glm::length(glm::cross(glm::normalize(near_m - camera_m), direction));
        } else {
          const core::Projected at = core::project(r.view, near_m);
          least_px = at.behind ? kInf : glm::distance(at.xy, glm::dvec2(x + 0.5, y + 0.5));
        }
      }
      const double rounding_px = rounding_m * focal_px * stretch / range_m * 1.1;
      ++worst.places;
      if (drawn.geometric_error_m > 0) {
        worst.surface = std::max(worst.surface, (least_m - rounding_m) / drawn.geometric_error_m);
        worst.image = std::max(worst.image, (least_px - rounding_px) / most_px);
      }
      EXPECT_LE(least_m, drawn.geometric_error_m + rounding_m) << x << " " << y;
      EXPECT_LE(least_px, most_px + rounding_px) << x << " " << y;
    }
  }

  // Returns a 1 for each pixel that lies in a square of `side` pixels that all show an object.
  static std::vector<std::uint8_t> thick_parts(const core::Frame& frame, int side) {
    std::vector<std::uint8_t> out(frame.range_m.size(), 0);
    std::vector<int> columns(static_cast<std::size_t>(frame.width), 0);  // pixels up from here that show one
    for (int y = 0; y < frame.height; ++y) {
      int beside = 0;  // columns to the left that are high enough
      for (int x = 0; x < frame.width; ++x) {
        int& high = columns[static_cast<std::size_t>(x)];
        high = std::isinf(frame.range_m[at(frame, x, y)]) ? 0 : high + 1;
        beside = high >= side ? beside + 1 : 0;
        if (beside < side) continue;
        for (int j = 0; j < side; ++j)
          for (int i = 0; i < side; ++i) out[at(frame, x - i, y - j)] = 1;
      }
    }
    return out;
  }

  // A silhouette that has a place within s of a pixel's centre, and is not thinner than a pixel there, holds a corner of the
  // square of pixel centres around that place: less than s + 1 away along each axis. A part of the other silhouette that is
  // wider than 2 s + 1 says that it is not thinner.
  static void check_outline(const core::Frame& frame, const core::Frame& other, double shift_px, Worst& worst) {
    const int reach = static_cast<int>(std::ceil(shift_px + 1)) - 1;
    const std::vector<std::uint8_t> is_thick =
        thick_parts(frame, static_cast<int>(std::ceil(2 * shift_px)) + 2);
    const auto shows = [&](const core::Frame& f, int x, int y) {
      return x >= 0 && y >= 0 && x < f.width && y < f.height && !std::isinf(f.range_m[at(f, x, y)]);
    };
    int missing = 0;
    int all = 0;
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        if (is_thick[at(frame, x, y)] == 0) continue;
        // Beyond the border nothing is known.
        if (x < reach || y < reach || x + reach >= frame.width || y + reach >= frame.height) continue;
        ++all;
        bool is_found = false;
        for (int j = -reach; j <= reach && !is_found; ++j)
          for (int i = -reach; i <= reach && !is_found; ++i) is_found = shows(other, x + i, y + j);
        missing += is_found ? 0 : 1;
      }
    }
    worst.outlines += all;
    EXPECT_EQ(missing, 0) << "of " << all << ", shift " << shift_px;
  }
};

TEST_F(ObjectCertificate, HoldsInEveryView) { compare(::test_support::kIsSanitized ? 50 : 500, kViewsSeed); }

class LongObjectCertificate : public ObjectCertificate {};

TEST_F(LongObjectCertificate, HoldsInThousandsOfViews) { compare(5000, kViewsSeed + 1); }

}  // namespace
}  // namespace objects
