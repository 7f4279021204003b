// Parts of the ground in images of terrain volumes: where rays meet them, light on them, cameras in them, errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/paging/planet_fixture.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::voxel {
namespace {

using test_support::Random;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

// A ball in the body-fixed frame, met by verticals in closed form.
core::GroundPart ball(const glm::dvec3& centre_m, double radius_m, double voxel_m, double planet_radius_m,
                      bool is_cut) {
  core::GroundPart part;
  part.name = "ball";
  part.is_cut = is_cut;
  part.centre_m = centre_m;
  part.radius_m = radius_m;
  part.voxel_m = voxel_m;
  part.solids = [=](const glm::dvec3& up, std::vector<core::SolidSpan>& solids) {
    const double along = glm::dot(up, centre_m);
    const double rest = radius_m * radius_m - glm::dot(centre_m, centre_m) + along * along;
    if (!(rest > 0)) return;
    solids.push_back({along - std::sqrt(rest) - planet_radius_m, along + std::sqrt(rest) - planet_radius_m});
  };
  return part;
}

// Returns the range at which a ray enters a ball, and leaves it; infinite if it does not meet it.
std::pair<double, double> meet(const glm::dvec3& centre_m, double radius_m, const glm::dvec3& from_m,
                               const glm::dvec3& ray) {
  const double half = glm::dot(ray, from_m - centre_m);
  const double rest = half * half - glm::dot(from_m - centre_m, from_m - centre_m) + radius_m * radius_m;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  return rest > 0 ? std::pair(-half - std::sqrt(rest), -half + std::sqrt(rest)) : std::pair(kNever, kNever);
}

// A planet with hills, and a place on it.
class GroundParts : public testing::Test {
 protected:
  GroundParts()
      : renderer_(make_ray_renderer(planet(), {.memory_bytes = std::size_t{128} << 20, .threads = 2})),
        surface_(planet(), std::size_t{16} << 20) {
    up_ = mars::direction({23, 11});
    east_ = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), up_));
    north_ = glm::cross(up_, east_);
    ground_m_ = surface_.at(up_).radius_m;
  }

  static const std::shared_ptr<const paging::PlanetFile>& planet() {
    static const test_support::TempDir folder;
    const test_support::FakeElevation source(test_support::bumpy_height,
                                             test_support::fine_around(mars::direction({23, 11}), 0.006, 300));
    static const auto made = test_support::build_fake(folder / "hills.vpe", source, 400000);
    return made;
  }
  static double radius_m() { return planet()->radius_m(); }

  // A place by metres to the east, to the north and above the ground of the middle.
  glm::dvec3 world(double east_m, double north_m, double above_m) const {
    return (ground_m_ + above_m) * up_ + east_m * east_ + north_m * north_;
  }

  core::DrawRequest request(const glm::dvec3& from_m, const glm::dvec3& to_m,
                            std::vector<core::GroundPart> parts) const {
    core::DrawRequest request;
    request.view.width = kWidth;
    request.view.height = kHeight;
    request.view.fov_deg = 50;
    request.view.camera.position_m = from_m;
    const glm::dvec3 forward = glm::normalize(to_m - from_m);
    const glm::dvec3 side = std::abs(glm::dot(forward, up_)) > 0.99 ? north_ : up_;
    const glm::dvec3 right = glm::normalize(glm::cross(forward, side));
    request.view.camera.axes = {right, glm::cross(right, forward), forward};
    request.settings.samples = 1;
    request.settings.smooth_edges = false;
    request.settings.ray_mode = core::RayMode::kVolume;
    request.settings.ray_volume_filter = core::RayVolumeFilter::kBox;
    request.want_range = true;
    request.sun = glm::normalize(up_ + 0.3 * east_);
    if (!parts.empty()) request.ground_parts = std::make_shared<const core::GroundParts>(std::move(parts));
    return request;
  }

  static glm::dvec3 ray(const core::DrawRequest& request, int n) {
    return core::pixel_ray(request.view, n % kWidth + 0.5, n / kWidth + 0.5);
  }

  std::unique_ptr<core::PixelRenderer> renderer_;
  paging::Surface surface_;
  glm::dvec3 up_, east_, north_;
  double ground_m_ = 0;
};

TEST_F(GroundParts, ABallInTheAirIsMetWhereItIs) {
  constexpr double kVoxel_m = 4;
  const glm::dvec3 centre = world(0, 0, 400);
  const core::GroundPart part = ball(centre, 150, kVoxel_m, radius_m(), false);
  Random random(51);
  int on_ball = 0;
  double worst_m = 0;
  for (int n = 0; n < 6; ++n) {
    const double angle = random.uniform(0, 6.28);
    const glm::dvec3 from = world(1500 * std::cos(angle), 1500 * std::sin(angle), random.uniform(200, 1500));
    const core::DrawRequest with = request(from, centre, {part});
    const core::DrawResult drawn = renderer_->draw(with);
    const core::DrawResult bare = renderer_->draw(request(from, centre, {}));
    EXPECT_GE(drawn.certificate.geometric_error_m, bare.certificate.geometric_error_m);
    for (int k = 0; k < kWidth * kHeight; ++k) {
      const auto found = static_cast<double>(drawn.frame.range_m[static_cast<std::size_t>(k)]);
      const auto ground = static_cast<double>(bare.frame.range_m[static_cast<std::size_t>(k)]);
      const glm::dvec3 way = ray(with, k);
      const double nearest = glm::length(glm::cross(way, centre - from));
      if (nearest < 150 - 2 * kVoxel_m) {
        ++on_ball;
        worst_m = std::max(worst_m, std::abs(glm::length(from + found * way - centre) - 150));
      } else if (nearest > 150 + 2 * kVoxel_m) {
        // The ground beside it and below it is that of the bands, but for a voxel of the brick.
        if (std::isfinite(ground) && std::isfinite(found)) {
          const double height_m = glm::length(from + found * way) - glm::length(from + ground * way);
          EXPECT_LT(std::abs(height_m), 2 * kVoxel_m) << k;
        } else {
          EXPECT_EQ(std::isfinite(ground), std::isfinite(found)) << k;
        }
      }
    }
  }
  std::printf("%d rays on the ball, at most %.2f voxels from it\n", on_ball, worst_m / kVoxel_m);
  EXPECT_GT(on_ball, 200);
  EXPECT_LT(worst_m, kVoxel_m);
}

TEST_F(GroundParts, APitIsAsDeepAsWhatIsCutOut) {
  constexpr double kVoxel_m = 2;
  const glm::dvec3 centre = world(0, 0, 0);
  const core::GroundPart part = ball(centre, 80, kVoxel_m, radius_m(), true);
  const glm::dvec3 from = world(0, 30, 500);
  const core::DrawRequest with = request(from, centre, {part});
  const core::DrawResult drawn = renderer_->draw(with);
  const core::DrawResult bare = renderer_->draw(request(from, centre, {}));
  int in_pit = 0;
  for (int k = 0; k < kWidth * kHeight; ++k) {
    const auto found = static_cast<double>(drawn.frame.range_m[static_cast<std::size_t>(k)]);
    const auto ground = static_cast<double>(bare.frame.range_m[static_cast<std::size_t>(k)]);
    const glm::dvec3 way = ray(with, k);
    const auto [enters, leaves] = meet(centre, 80, from, way);
    const double on_ground = glm::length(from + ground * way - centre);
    if (on_ground < 80 - 3 * kVoxel_m) {
      // Through the opening to the other side of the ball.
      EXPECT_NEAR(found, leaves, 2 * kVoxel_m) << k;
      ++in_pit;
    } else if (on_ground > 80 + 3 * kVoxel_m) {
      EXPECT_NEAR(found, ground, 4 * kVoxel_m) << k;
    }
  }
  EXPECT_GT(in_pit, 100);
  // A camera in the pit is above the ground there, and sees its walls and the sky.
  const glm::dvec3 inside = world(0, 0, -40);
  const core::DrawRequest out = request(inside, world(60, 0, -10), {part});
  const core::DrawResult seen = renderer_->draw(out);
  EXPECT_FALSE(seen.certificate.is_below_ground);
  int walls = 0;
  for (int k = 0; k < kWidth * kHeight; ++k) {
    const auto found = static_cast<double>(seen.frame.range_m[static_cast<std::size_t>(k)]);
    const glm::dvec3 way = ray(out, k);
    const double leaves = meet(centre, 80, inside, way).second;
    const glm::dvec3 end = inside + leaves * way;
    if (glm::length(end) - surface_.at(glm::normalize(end)).radius_m < -3 * kVoxel_m) {
      EXPECT_NEAR(found, leaves, 2 * kVoxel_m) << k;
      ++walls;
    }
  }
  EXPECT_GT(walls, 500);
  EXPECT_TRUE(renderer_->draw(request(inside, world(60, 0, -10), {})).certificate.is_below_ground);
}

TEST_F(GroundParts, ShadowsFallFromPartsAndIntoPits) {
  constexpr double kVoxel_m = 4;
  const glm::dvec3 over = world(0, 0, 400);
  const core::GroundPart roof = ball(over, 150, kVoxel_m, radius_m(), false);
  core::DrawRequest with = request(world(0, -900, 900), world(0, 0, 100), {roof});
  with.settings.mode = core::Mode::kLit;
  with.sun = up_;
  with.settings.shadows = true;
  const core::DrawResult shaded = renderer_->draw(with);
  with.settings.shadows = false;
  const core::DrawResult lit = renderer_->draw(with);
  EXPECT_EQ(shaded.frame.range_m, lit.frame.range_m);
  int hidden = 0;
  int open = 0;
  for (int k = 0; k < kWidth * kHeight; ++k) {
    const auto n = static_cast<std::size_t>(k);
    const auto found = static_cast<double>(lit.frame.range_m[n]);
    if (!std::isfinite(found)) continue;
    const glm::dvec3 place = with.view.camera.position_m + found * ray(with, k);
    const double aside = glm::length(glm::cross(up_, place - over));
    const bool is_below = glm::dot(place - over, up_) < 0;
    // The lower half of the ball, and the ground below it, do not see the sun.
    if (is_below && aside < 150 - 3 * kVoxel_m) {
      hidden += shaded.frame.colour[n].r < lit.frame.colour[n].r || lit.frame.colour[n].r < 90;
      EXPECT_LE(shaded.frame.colour[n].r, lit.frame.colour[n].r) << k;
    } else if (aside > 150 + 3 * kVoxel_m) {
      EXPECT_EQ(shaded.frame.colour[n], lit.frame.colour[n]) << k;
      ++open;
    }
  }
  EXPECT_GT(hidden, 20);
  EXPECT_GT(open, 500);
}

// Compares the light of a ball with that of its normals.
TEST_F(GroundParts, PartsAreLitByTheirOwnNormals) {
  constexpr double kVoxel_m = 3;
  const glm::dvec3 centre = world(0, 0, 500);
  core::DrawRequest with =
      request(world(0, -900, 700), centre, {ball(centre, 150, kVoxel_m, radius_m(), false)});
  with.settings.mode = core::Mode::kLit;
  const core::DrawResult drawn = renderer_->draw(with);
  // The square of a colour is linear in the cosine of incidence (vpe/core/appearance/shading.h).
  std::vector<std::pair<double, double>> lights;
  for (int k = 0; k < kWidth * kHeight; ++k) {
    const auto n = static_cast<std::size_t>(k);
    const glm::dvec3 way = ray(with, k);
    const double nearest = glm::length(glm::cross(way, centre - with.view.camera.position_m));
    if (nearest > 145) continue;
    const glm::dvec3 place = with.view.camera.position_m + static_cast<double>(drawn.frame.range_m[n]) * way;
    const double cosine = std::max(0.0, glm::dot(glm::normalize(place - centre), with.sun));
    lights.emplace_back(cosine, static_cast<double>(drawn.frame.colour[n].r) * drawn.frame.colour[n].r);
  }
  ASSERT_GT(lights.size(), 100U);
  const auto [darkest, brightest] = std::ranges::minmax(lights);
  const double slope = (brightest.second - darkest.second) / (brightest.first - darkest.first);
  EXPECT_GT(brightest.first - darkest.first, 0.7);
  double worst = 0;
  for (const auto& [cosine, square] : lights)
    worst = std::max(worst, std::abs(square - darkest.second - slope * (cosine - darkest.first)) / slope);
  std::printf("%zu pixels; cosines of incidence are off by at most %.3f\n", lights.size(), worst);
  EXPECT_LT(worst, 0.1);
}

TEST_F(GroundParts, EveryWayOfDrawingGivesTheSamePixels) {
  const glm::dvec3 centre = world(0, 0, 60);
  core::DrawRequest with =
      request(world(0, -500, 200), centre,
              {ball(centre, 60, 2, radius_m(), false), ball(world(150, 100, 0), 50, 2, radius_m(), true)});
  with.settings.shadows = true;
  const core::DrawResult whole = renderer_->draw(with);
  // One thread.
  const auto other = make_ray_renderer(planet(), {.memory_bytes = std::size_t{128} << 20, .threads = 1});
  const core::DrawResult alone = other->draw(with);
  EXPECT_EQ(alone.frame.range_m, whole.frame.range_m);
  EXPECT_EQ(alone.frame.colour, whole.frame.colour);
  // Single pixels.
  std::vector<std::uint8_t> wanted(kWidth * kHeight);
  for (std::size_t n = 0; n < wanted.size(); n += 3) wanted[n] = 1;
  const std::vector<float> clear_m(wanted.size());
  core::Frame frame{kWidth, kHeight, {}, {}};
  frame.range_m.assign(wanted.size(), -1.0F);
  frame.colour.resize(wanted.size());
  renderer_->draw_pixels(with, {wanted, clear_m}, frame);
  for (std::size_t n = 0; n < wanted.size(); n += 3) {
    EXPECT_EQ(frame.range_m[n], whole.frame.range_m[n]) << n;
    EXPECT_EQ(frame.colour[n], whole.frame.colour[n]) << n;
  }
  // As the next frame of a film.
  core::DrawRequest before = with;
  before.view.camera.position_m += 20.0 * east_;
  before.paging.next = std::make_shared<const core::DrawRequest>(with);
  renderer_->draw(before);
  const core::DrawResult after = renderer_->draw(with);
  EXPECT_EQ(after.frame.range_m, whole.frame.range_m);
  EXPECT_EQ(after.frame.colour, whole.frame.colour);
  // Several samples have the range of the pixel's centre.
  core::DrawRequest smooth = with;
  smooth.settings.samples = 2;
  EXPECT_EQ(renderer_->draw(smooth).frame.range_m, whole.frame.range_m);
}

TEST_F(GroundParts, OtherModesLeaveThemOutAndFarOnesAreCells) {
  // Above the cells of the ground, which are as high as wide.
  const glm::dvec3 centre = world(0, 0, 1500);
  const glm::dvec3 from = world(0, -2500, 2500);
  core::DrawRequest with = request(from, centre, {ball(centre, 400, 8, radius_m(), false)});
  const core::DrawRequest bare = request(from, centre, {});
  const core::DrawResult volume = renderer_->draw(with);
  EXPECT_NE(volume.frame.range_m, renderer_->draw(bare).frame.range_m);
  core::DrawRequest boundary = with;
  boundary.settings.ray_mode = core::RayMode::kBoundary;
  const core::DrawResult cells = renderer_->draw(boundary);
  const auto middle = static_cast<std::size_t>(kHeight / 2 * kWidth + kWidth / 2);
  EXPECT_NEAR(cells.frame.range_m[middle], volume.frame.range_m[middle], 3 * 8);
  EXPECT_NE(cells.frame.range_m[middle], volume.frame.range_m[middle]);
  // Coarser images, and other modes, have the ground alone.
  for (const core::RayMode mode : {core::RayMode::kExact, core::RayMode::kMultires, core::RayMode::kVolume}) {
    core::DrawRequest a = with;
    core::DrawRequest b = bare;
    a.settings.ray_mode = b.settings.ray_mode = mode;
    if (mode == core::RayMode::kVolume) a.coarsening = b.coarsening = 2;
    EXPECT_FALSE(draws_ground_parts(a));
    const core::DrawResult left = renderer_->draw(a);
    const core::DrawResult right = renderer_->draw(b);
    EXPECT_EQ(left.frame.range_m, right.frame.range_m);
    EXPECT_EQ(left.frame.colour, right.frame.colour);
  }
  EXPECT_TRUE(draws_ground_parts(with));
}

TEST_F(GroundParts, TheCertificateIncludesTheirVoxels) {
  const glm::dvec3 centre = world(0, 0, 3000);
  // Voxels that are large in the image.
  const core::DrawRequest coarse =
      request(world(0, -4000, 3000), centre, {ball(centre, 1500, 200, radius_m(), false)});
  const core::DrawRequest fine =
      request(world(0, -4000, 3000), centre, {ball(centre, 1500, 20, radius_m(), false)});
  const core::Certificate rough = renderer_->draw(coarse).certificate;
  const core::Certificate good = renderer_->draw(fine).certificate;
  EXPECT_GT(rough.screen_space_error_px, good.screen_space_error_px);
  EXPECT_GE(rough.geometric_error_m, 200);
  // Surfaces in the image are within what is stated.
  const core::DrawResult drawn = renderer_->draw(coarse);
  double worst_m = 0;
  for (int k = 0; k < kWidth * kHeight; ++k) {
    const glm::dvec3 way = ray(coarse, k);
    if (glm::length(glm::cross(way, centre - coarse.view.camera.position_m)) > 1300) continue;
    const double found = static_cast<double>(drawn.frame.range_m[static_cast<std::size_t>(k)]);
    worst_m =
        std::max(worst_m, std::abs(glm::length(coarse.view.camera.position_m + found * way - centre) - 1500));
  }
  std::printf("at most %.0f m from the ball, stated %.0f m\n", worst_m, rough.geometric_error_m);
  EXPECT_LT(worst_m, rough.geometric_error_m);
  EXPECT_GT(worst_m, 1);
}

TEST_F(GroundParts, FaultsInPartsReachTheCaller) {
  const glm::dvec3 centre = world(0, 0, 0);
  core::GroundPart part = ball(centre, 60, 2, radius_m(), false);
  part.solids = [](const glm::dvec3&, std::vector<core::SolidSpan>&) {
    throw std::runtime_error("the part fails");
  };
  const core::DrawRequest bad = request(world(0, -500, 200), centre, {part});
  EXPECT_THROW(renderer_->draw(bad), std::runtime_error);
  part.solids = [](const glm::dvec3&, std::vector<core::SolidSpan>& s) { s.push_back({0, NAN}); };
  EXPECT_THROW(renderer_->draw(request(world(0, -500, 200), centre, {part})), std::invalid_argument);
  // What was refused leaves nothing behind.
  const core::DrawRequest good = request(world(0, -500, 200), centre, {ball(centre, 60, 2, radius_m(), false)});
  EXPECT_EQ(renderer_->draw(good).frame.range_m,
            make_ray_renderer(planet(), {.memory_bytes = std::size_t{64} << 20})->draw(good).frame.range_m);
}

}  // namespace
}  // namespace vpe::voxel
