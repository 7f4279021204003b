// Terrain volumes of a planet: their distance from the reference surface, rays over them, near and far tiles, images.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "mars/geodesy/sun.h"
#include "tests/voxel/smooth/smooth_fixture.h"
#include "vpe/core/metrics.h"
#include "vpe/voxel/cast/band_caster.h"
#include "vpe/voxel/cast/range_caster.h"
#include "vpe/voxel/ray_renderer.h"
#include "vpe/voxel/volume/grid_volume.h"

namespace vpe::voxel {
namespace {

using test_support::Random;

constexpr VolumeFilter kFilters[] = {VolumeFilter::kNone, VolumeFilter::kGaussian, VolumeFilter::kBox};
constexpr double kNone = std::numeric_limits<double>::infinity();

const char* name_of(VolumeFilter filter) {
  return filter == VolumeFilter::kNone ? "none" : filter == VolumeFilter::kGaussian ? "gaussian" : "box";
}

class PlanetVolumes : public testing::Test {
 protected:
  PlanetVolumes() : planet_(levels()), caster_(planet_, std::size_t{256} << 20) {}

  // Returns a planet with posts of several spacings, made once for all tests.
  static std::shared_ptr<const paging::PlanetFile> levels() {
    static const test_support::TempDir folder;
    static const auto planet = test_support::levels_planet(folder / "levels.vpe");
    return planet;
  }

  core::View any_view(Random& random, core::Projection projection = core::Projection::kPerspective) const {
    // Over the dense places and elsewhere.
    const glm::dvec3 places[] = {glm::normalize(glm::dvec3(1, 1, 1)), glm::normalize(glm::dvec3(1, -1, 0.3)),
                                 mars::direction({-63, 17}), random.direction()};
    const glm::dvec3 place =
        glm::normalize(places[random.integer(0, 3)] + random.log_uniform(1e-4, 3e-2) * random.direction());
    const mars::LonLat at = mars::lon_lat(place);
    const double ground_m = caster_.surface().at(place).height_m;
    core::View view;
    view.projection = projection;
    view.width = 40;
    view.height = 30;
    view.fov_deg = random.log_uniform(10, 100);
    view.camera = mars::to_camera({at.lon_deg, at.lat_deg, ground_m + random.log_uniform(2e4, 3e6),
                                   random.uniform(0, 360), random.uniform(-90, 10), random.uniform(-180, 180)},
                                  planet_->radius_m());
    return view;
  }

  std::vector<float> cast(const core::View& view, const VolumeForm& form, int threads = 2,
                          TileUsage* usage = nullptr, double exaggeration = 1) {
    base::ThreadPool pool(threads);
    std::vector<float> range_m(static_cast<std::size_t>(view.width * view.height), -1.0F);
    RangeOptions options;
    options.method = RangeOptions::Method::kVolume;
    options.volume = form;
    options.exaggeration = exaggeration;
    const TileUsage found = caster_.cast(view, options, pool, range_m);
    if (usage != nullptr) *usage = found;
    return range_m;
  }

  std::shared_ptr<const paging::PlanetFile> planet_;
  RangeCaster caster_;
};

// Returns how far the surfaces of a planet's volumes lie from the reference surface along the vertical: at most so much of what
// is stated, and so many voxels.
struct Nearness {
  double of_stated = 0;
  double voxels = 0;
  int tiles = 0;
};

Nearness nearness(const paging::PlanetFile& planet, const RangeCaster& caster, VolumeFilter filter,
                  Random& random) {
  const paging::Surface& surface = caster.surface();
  const double radius_m = planet.radius_m();
  const lod::TileTree& tree = planet.tree();
  const int intervals = tree.shape().intervals();
  Nearness found;
  for (lod::TileTree::Index index = 0; index < tree.size(); ++index) {
    const lod::TileKey& key = tree[index].key;
    if (tree[index].has_children || grids_per_side(key.level, intervals) > 1) continue;
    ++found.tiles;
    const auto grids = caster.store().any_grids(index, 1);
    const mars::ChartRect rect = lod::chart_rect(key);
    const HeightGridFrame frame{intervals, rect.u0, (rect.u1 - rect.u0) / intervals, rect.v0,
                                (rect.v1 - rect.v0) / intervals};
    const GridVolume volume =
        make_grid_volume(key.face, frame, grids->lines(0, 0), grids->family(), radius_m, {.filter = filter});
    EXPECT_GE(volume.boundary_deviation_m, volume.deviation_m);
    EXPECT_LT(volume.boundary_deviation_m, 12 * volume.voxel_m);
    EXPECT_GT(volume.bytes(), sizeof(GridVolume));
    for (int n = 0; n < 60; ++n) {
      const double u = frame.u0 + random.uniform(0, intervals) * frame.du;
      const double v = frame.v0 + random.uniform(0, intervals) * frame.dv;
      const glm::dvec3 up = mars::chart_direction(key.face, u, v);
      const double ground_m = surface.at(up).radius_m;
      EXPECT_GT(volume.highest_m(radius_m), ground_m);
      // Where the density passes the surface on the vertical.
      double low = ground_m - 4 * volume.voxel_m;
      double high = ground_m + 4 * volume.voxel_m;
      for (int step = 0; step < 40; ++step) {
        const double middle = 0.5 * (low + high);
        const bool is_ground =
            volume.voxels.density(volume.voxel_of(middle * up, radius_m)) > volume.voxels.surface();
        (is_ground ? low : high) = middle;
      }
      found.of_stated = std::max(found.of_stated, std::abs(low - ground_m) / volume.deviation_m);
      found.voxels = std::max(found.voxels, std::abs(low - ground_m) / volume.voxel_m);
    }
  }
  return found;
}

// Waves as long as two voxels and a half, with slopes of more than 45 degrees.
double rough_height(const glm::dvec3& d) {
  return test_support::bumpy_height(d) + 2000 * std::sin(1800 * d.x) * std::sin(1700 * d.y + d.z);
}

TEST_F(PlanetVolumes, SurfacesAreAsNearToTheReferenceAsIsStated) {
  const test_support::TempDir folder;
  const auto rough = test_support::levels_planet(folder / "rough.vpe", rough_height);
  const RangeCaster rough_caster(rough, std::size_t{256} << 20);
  Random random(11);
  for (const VolumeFilter filter : kFilters) {
    const Nearness smooth = nearness(*planet_, caster_, filter, random);
    const Nearness steep = nearness(*rough, rough_caster, filter, random);
    std::printf(
        "filter %s: %d tiles, at most %.3f of the stated deviation, %.3f voxels; rough: %d, %.3f, %.3f\n",
        name_of(filter), smooth.tiles, smooth.of_stated, smooth.voxels, steep.tiles, steep.of_stated,
        steep.voxels);
    EXPECT_GT(smooth.tiles, 20);
    EXPECT_LE(smooth.of_stated, 1);
    EXPECT_LE(steep.of_stated, 1);
    EXPECT_GT(steep.of_stated, 0.2);
    // Half a voxel, and what the ground rises in a voxel beside a step.
    EXPECT_LT(smooth.voxels, filter == VolumeFilter::kNone ? 0.6 : 0.1);
  }
}

// Follows rays in steps of a twentieth of a voxel by the test of single points. The caster may have passed what is thinner than
// its interval.
TEST_F(PlanetVolumes, RaysMeetTheFirstGround) {
  Random random(12);
  int hits = 0;
  int skies = 0;
  for (const bool is_far : {false, true}) {
    VolumeForm form;
    form.interval = 0.3;
    if (is_far) form.near_m = 0;
    RangeOptions options;
    options.method = RangeOptions::Method::kVolume;
    options.volume = form;
    for (int n = 0; n < 12; ++n) {
      const core::View view = any_view(random);
      const std::vector<float> range_m = cast(view, form);
      for (int k = n; k < view.width * view.height; k += 97) {
        const auto found = static_cast<double>(range_m[static_cast<std::size_t>(k)]);
        const glm::dvec3 ray = core::pixel_ray(view, k % view.width + 0.5, k / view.width + 0.5);
        const glm::dvec3& camera_m = view.camera.position_m;
        // Voxels are at least this wide.
        constexpr double kVoxel_m = 1500;
        constexpr double kWidest_m = 120000;
        const double half = glm::dot(camera_m, ray);
        const double top_m = planet_->radius_m() + 30000;
        const double rest = half * half - glm::dot(camera_m, camera_m) + top_m * top_m;
        if (!(rest > 0) || -half + std::sqrt(rest) < 0) {
          EXPECT_EQ(found, kNone);
          continue;
        }
        const double end = std::min(found, -half + std::sqrt(rest));
        double in_ground = 0;
        for (double t = std::max(0.0, -half - std::sqrt(rest)); t < end; t += 0.05 * kVoxel_m) {
          in_ground = caster_.is_in_volume(camera_m + t * ray, options) ? in_ground + 0.05 * kVoxel_m : 0;
          ASSERT_LE(in_ground, 0.3 * kWidest_m) << k;
        }
        (std::isfinite(found) ? hits : skies) += 1;
        if (!std::isfinite(found)) continue;
        // Just behind it is ground, but for a ridge that ends there.
        EXPECT_TRUE(caster_.is_in_volume(camera_m + (found + 1) * ray, options) ||
                    caster_.is_in_volume(camera_m + (found + 50) * ray, options))
            << k;
      }
    }
  }
  EXPECT_GT(hits, 60);
  EXPECT_GT(skies, 10);
}

TEST_F(PlanetVolumes, NearAllIsVolumeAndNearNothingIsBoundary) {
  Random random(13);
  int between = 0;
  for (int n = 0; n < 8; ++n) {
    const core::View view = any_view(random);
    TileUsage usage;
    const std::vector<float> volume = cast(view, {}, 2, &usage);
    const std::vector<float> boundary = cast(view, {.near_m = 0});
    // Beyond the farthest tile nothing is left to be far.
    double farthest = 0;
    for (const TileUse& use : usage.tiles) farthest = std::max(farthest, use.min_distance_m);
    EXPECT_EQ(cast(view, {.near_m = std::nextafter(farthest, kNone)}), volume);
    const std::vector<float> mixed = cast(view, {.near_m = 0.5 * farthest});
    for (std::size_t k = 0; k < mixed.size(); ++k) between += mixed[k] != volume[k] && mixed[k] == boundary[k];
    // The first boundary cell is no farther than the surface in it.
    for (std::size_t k = 0; k < mixed.size(); ++k) ASSERT_LE(boundary[k], volume[k] + 0.7F * 120000) << k;
  }
  EXPECT_GT(between, 50);
}

TEST_F(PlanetVolumes, ImagesDoNotDependOnThreadsPartsOrProjections) {
  Random random(14);
  for (const core::Projection projection : {core::Projection::kPerspective, core::Projection::kCylinder}) {
    const core::View view = any_view(random, projection);
    const std::vector<float> whole = cast(view, {});
    EXPECT_EQ(cast(view, {}, 1), whole);
    RangeOptions options;
    options.method = RangeOptions::Method::kVolume;
    base::ThreadPool pool(1);
    std::vector<float> part(whole.size(), -1.0F);
    options.only = {5, 7, 11, 13};
    caster_.cast(view, options, pool, part);
    for (int y = 0; y < view.height; ++y) {
      for (int x = 0; x < view.width; ++x) {
        const auto n = static_cast<std::size_t>(y * view.width + x);
        const bool is_in = x >= 5 && x < 16 && y >= 7 && y < 20;
        EXPECT_EQ(part[n], is_in ? whole[n] : -1.0F);
      }
    }
    for (std::size_t n = 0; n < whole.size(); ++n) {
      const core::View& v = view;
      const glm::dvec3 ray =
          core::pixel_ray(v, static_cast<double>(n % 40) + 0.5, static_cast<double>(n / 40) + 0.5);
      const double exact_m = caster_.surface().cast(v.camera.position_m, ray);
      if (n % 13 == 0 && std::isfinite(exact_m) && std::isfinite(whole[n])) {
        EXPECT_NEAR(static_cast<double>(whole[n]) / exact_m, 1, 0.5);
      }
    }
  }
}

TEST_F(PlanetVolumes, RefuseOptionsBeyondTheirLimits) {
  Random random(15);
  const core::View view = any_view(random);
  EXPECT_THROW(cast(view, {.interval = 0}), std::invalid_argument);
  EXPECT_THROW(cast(view, {.interval = NAN}), std::invalid_argument);
  EXPECT_THROW(cast(view, {.near_m = -1}), std::invalid_argument);
  EXPECT_THROW(cast(view, {.band = {.sigma = 0}}), std::invalid_argument);
}

core::DrawRequest volume_request(const mars::Pose& pose, double radius_m) {
  core::DrawRequest request;
  request.view.camera = mars::to_camera(pose, radius_m);
  request.view.width = 96;
  request.view.height = 64;
  request.view.fov_deg = 60;
  request.settings.samples = 1;
  request.settings.ray_mode = core::RayMode::kVolume;
  request.settings.smooth_edges = false;
  request.sun = mars::sun_direction({pose.lon_deg, pose.lat_deg}, 315, 40);
  request.want_range = true;
  return request;
}

TEST_F(PlanetVolumes, CertificatesHold) {
  const auto draw = make_ray_renderer(planet_, {.memory_bytes = std::size_t{256} << 20, .threads = 2});
  const paging::Surface& surface = caster_.surface();
  Random random(16);
  double worst = 0;
  int certified = 0;
  for (int n = 0; n < 60; ++n) {
    core::DrawRequest request = volume_request({}, planet_->radius_m());
    const core::View view = any_view(random);
    request.view.camera = view.camera;
    request.view.fov_deg = view.fov_deg;
    request.view.width = 48;
    request.view.height = 36;
    request.settings.exaggeration = n % 3 == 0 ? random.log_uniform(0.5, 5) : 1;
    request.settings.ray_mode = n % 2 == 0 ? core::RayMode::kVolume : core::RayMode::kBoundary;
    request.settings.ray_volume_filter = n % 5 == 0   ? core::RayVolumeFilter::kNone
                                         : n % 5 == 1 ? core::RayVolumeFilter::kBox
                                                      : core::RayVolumeFilter::kGaussian;
    const core::DrawResult result = draw->draw(request);
    if (result.certificate.tiles_drawn == 0) continue;
    EXPECT_GT(result.certificate.geometric_error_m, 0);
    if (!std::isfinite(result.certificate.shift_bound_px)) continue;
    const double x = request.settings.exaggeration;
    const core::SurfaceRadius radius = [&](std::span<const glm::dvec3> directions, std::span<double> radius_m) {
      surface.radius(directions, radius_m, x);
    };
    const core::ShiftSummary shift =
        core::summarize(core::forward_shift_px(request.view, result.frame.range_m, radius), request.view.width);
    if (shift.pixels == 0) continue;
    ++certified;
    worst = std::max(worst, shift.max_px / result.certificate.image_bound_px.value());
  }
  std::printf("%d images, worst shift %.3f of the certificate\n", certified, worst);
  EXPECT_GT(certified, 20);
  EXPECT_LE(worst, 1);
}

TEST_F(PlanetVolumes, RenderersDrawThem) {
  const auto draw = make_ray_renderer(planet_, {.memory_bytes = std::size_t{256} << 20, .threads = 2});
  core::DrawRequest request = volume_request({12, 34, 60000, 30, -20, 0}, planet_->radius_m());
  const core::DrawResult volume = draw->draw(request);
  EXPECT_EQ(volume.frame.range_m, [&] {
    core::View view = request.view;
    base::ThreadPool pool(1);
    std::vector<float> range_m(96 * 64);
    caster_.cast(view, range_options(request, planet_->radius_m()), pool, range_m);
    return range_m;
  }());
  // Single pixels are those of the image.
  std::vector<std::uint8_t> wanted(96 * 64);
  for (std::size_t n = 0; n < wanted.size(); n += 7) wanted[n] = 1;
  const std::vector<float> clear_m(wanted.size());
  core::Frame frame{96, 64, {}, {}};
  frame.range_m.assign(wanted.size(), -1.0F);
  frame.colour.resize(wanted.size());
  draw->draw_pixels(request, {wanted, clear_m}, frame);
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    EXPECT_EQ(frame.range_m[n], n % 7 == 0 ? volume.frame.range_m[n] : -1.0F);
    if (n % 7 == 0) {
      EXPECT_EQ(frame.colour[n], volume.frame.colour[n]);
    }
  }
  request.settings.ray_mode = core::RayMode::kBoundary;
  const core::DrawResult boundary = draw->draw(request);
  EXPECT_NE(boundary.frame.range_m, volume.frame.range_m);
  EXPECT_GT(boundary.certificate.shift_bound_px, volume.certificate.shift_bound_px);
  // Coarser images take the cells of the tiles.
  request.coarsening = 4;
  core::DrawRequest cells = request;
  cells.settings.ray_mode = core::RayMode::kMultires;
  EXPECT_EQ(draw->draw(request).frame.range_m, draw->draw(cells).frame.range_m);
}

TEST_F(PlanetVolumes, ACameraInTheVolumeIsBelowTheGround) {
  const auto draw = make_ray_renderer(planet_, {.memory_bytes = std::size_t{256} << 20, .threads = 2});
  const glm::dvec3 up = mars::direction({12, 34});
  const double ground_m = caster_.surface().at(up).height_m;
  const core::DrawResult below =
      draw->draw(volume_request({12, 34, ground_m - 40000, 30, -20, 0}, planet_->radius_m()));
  EXPECT_EQ(below.frame.range_m.front(), 0);
  const core::DrawResult above =
      draw->draw(volume_request({12, 34, ground_m + 40000, 30, -20, 0}, planet_->radius_m()));
  EXPECT_GT(above.frame.range_m.back(), 0);
}

}  // namespace
}  // namespace vpe::voxel
