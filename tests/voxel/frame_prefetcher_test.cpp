// Tests that prefetched frames are the same images, and that prefetching changes nothing else.
#include "vpe/voxel/frame_prefetcher.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/gl/appearance_fixture.h"
#include "tests/gl/gl_fixture.h"
#include "vpe/voxel/downsampled_view.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using test_support::Random;
using test_support::request_for;
using vpe::voxel::FramePrefetcher;
using vpe::voxel::ImagePainter;
using vpe::voxel::RangeCaster;

constexpr std::size_t kBudget = std::size_t{1} << 28;

// Returns a request over the place where the planet is finest.
core::DrawRequest wavy_request(double lon_off_deg, double yaw_deg, int width = 800, int height = 450) {
  const mars::LonLat place = mars::lon_lat(test_support::kWavyMiddle);
  core::DrawRequest request = request_for({place.lon_deg + lon_off_deg, place.lat_deg, 60000, yaw_deg, -35, 5},
                                          mars::kMarsRadius_m, width, height);
  request.settings.mode = core::Mode::kTextured;
  return request;
}

core::DrawRequest with_next(core::DrawRequest request, const core::DrawRequest& next) {
  request.paging.next = std::make_shared<const core::DrawRequest>(next);
  request.paging.upcoming = {next.view};
  return request;
}

struct Backend {
  explicit Backend(const std::shared_ptr<const paging::PlanetFile>& planet, int threads = 2,
                   std::size_t budget = kBudget, std::size_t whole_budget = kBudget)
      : caster(planet, budget),
        painter(planet, budget),
        pool(threads),
        prefetcher(caster, painter, pool, whole_budget) {}

  std::vector<float> cast(const core::DrawRequest& request) {
    const glm::ivec2 size = core::drawn_size(request.view);
    std::vector<float> range(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    caster.cast(request.view, vpe::voxel::range_options(request, caster.surface().planet_radius_m()), pool,
                range);
    return range;
  }
  void paint(const core::DrawRequest& request, const std::vector<float>& range) {
    std::vector<vpe::base::Rgb> colour(range.size());
    painter.paint(request, range, colour, {}, pool);
  }
  auto take(const core::DrawRequest& request) {
    return prefetcher.take(request.view, vpe::voxel::range_options(request, caster.surface().planet_radius_m()),
                           taken);
  }
  std::int64_t tiles() const { return caster.store().build_totals().tiles; }

  RangeCaster caster;
  ImagePainter painter;
  vpe::base::ThreadPool pool;
  FramePrefetcher prefetcher;
  std::vector<float> taken;
};

void damage(const std::filesystem::path& path, std::int64_t tile) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.string().c_str(), &database), SQLITE_OK);
  const std::string statement =
      "UPDATE heights SET data = zeroblob(length(data)) WHERE key = " + std::to_string(tile);
  EXPECT_EQ(sqlite3_exec(database, statement.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_EQ(sqlite3_changes(database), 1);
  sqlite3_close(database);
}

class FramePrefetch : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = std::make_unique<test_support::TempDir>();
    planet_ = test_support::wavy_planet(*dir_ / "wavy.vpe");
  }
  static void TearDownTestSuite() {
    planet_.reset();
    dir_.reset();
  }
  static inline std::unique_ptr<test_support::TempDir> dir_;
  static inline std::shared_ptr<const paging::PlanetFile> planet_;
};

TEST_F(FramePrefetch, DownsampledViewsSeeTheSame) {
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    core::DrawRequest request = wavy_request(0, random.uniform(0, 360));
    core::View& view = request.view;
    view.projection = static_cast<core::Projection>(random.integer(0, 2));
    const bool round = view.projection != core::Projection::kPerspective;
    // Cylindrical and equirectangular images keep their azimuths only if the factor divides their width.
    view.width = round ? 16 * random.integer(2, 60) : random.integer(17, 900);
    view.height = random.integer(17, 700);
    view.fov_deg = random.uniform(1, 100);
    view.principal_offset_px = {random.uniform(-50, 50), random.uniform(-50, 50)};
    const core::View downsampled = vpe::voxel::downsampled_view(view, 16);
    ASSERT_EQ(core::check(downsampled), "");
    EXPECT_EQ(downsampled.width, (view.width + 15) / 16);
    for (int k = 0; k < 8; ++k) {
      const double x = random.uniform(0, view.width);
      const double y = random.uniform(0, view.height);
      EXPECT_LE(glm::distance(core::pixel_ray(downsampled, x / 16, y / 16), core::pixel_ray(view, x, y)),
                1e-12);
    }
    view.part = {random.integer(0, view.width - 2), random.integer(0, view.height - 2), 1, 1};
    view.part.width = random.integer(1, view.width - view.part.x);
    view.part.height = random.integer(1, view.height - view.part.y);
    const core::View part = vpe::voxel::downsampled_view(view, 16);
    ASSERT_EQ(core::check(part), "");
    EXPECT_LE(part.part.x * 16, view.part.x);
    EXPECT_GE((part.part.x + part.part.width) * 16, view.part.x + view.part.width);
    EXPECT_GE((part.part.y + part.part.height) * 16, view.part.y + view.part.height);
  }
}

TEST_F(FramePrefetch, TilesOfUpcomingViewsAreRead) {
  Backend backend(planet_);
  const core::DrawRequest now = wavy_request(0, 0);
  const core::DrawRequest later = wavy_request(1, 90);
  std::vector<float> range = backend.cast(now);
  backend.paint(now, range);
  const std::int64_t before = backend.tiles();
  core::DrawRequest request = now;
  request.paging.upcoming = {later.view};
  backend.prefetcher.begin(request);
  backend.prefetcher.wait();
  const std::int64_t read_early = backend.tiles() - before;
  const std::size_t painted_ahead = backend.painter.bytes_resident();
  range = backend.cast(later);
  backend.paint(later, range);
  const std::int64_t missed = backend.tiles() - before - read_early;
  EXPECT_GE(read_early, 20);
  EXPECT_LE(missed, read_early / 10);
  const std::size_t painted = backend.painter.bytes_resident();

  Backend without(planet_);
  range = without.cast(now);
  without.paint(now, range);
  // At least three quarters of what is new to the later image was read early.
  const std::size_t new_bytes = painted - without.painter.bytes_resident();
  EXPECT_GT(new_bytes, without.painter.bytes_resident() / 10);
  EXPECT_LE(painted - painted_ahead, new_bytes / 4);
}

TEST_F(FramePrefetch, TheNextImageIsCast) {
  for (const auto projection :
       {core::Projection::kPerspective, core::Projection::kCylinder, core::Projection::kEquirectangular}) {
    for (const auto mode : {core::RayMode::kExact, core::RayMode::kMultires, core::RayMode::kReference}) {
      Backend backend(planet_);
      core::DrawRequest next = wavy_request(0.5, 45, 96, 60);
      next.view.projection = projection;
      next.settings.ray_mode = mode;
      backend.prefetcher.begin(with_next(wavy_request(0, 0), next));
      backend.prefetcher.wait();
      const std::int64_t before = backend.tiles();
      const auto used = backend.take(next);
      ASSERT_TRUE(used);
      EXPECT_EQ(backend.tiles(), before);
      Backend other(planet_);
      EXPECT_EQ(backend.taken, other.cast(next));
      // Ranges are handed over once.
      EXPECT_FALSE(backend.take(next));
    }
  }
}

// A cast that is taken at any moment is whole, or not handed over.
TEST_F(FramePrefetch, ACastUnderWayIsWaitedFor) {
  Backend backend(planet_, 3);
  const core::DrawRequest next = wavy_request(0.5, 45);
  const std::vector<float> whole = backend.cast(next);
  Random random(2);
  int taken = 0;
  for (int n = 0; n < 60; ++n) {
    backend.prefetcher.begin(with_next(wavy_request(0, 0), next));
    std::this_thread::sleep_for(std::chrono::microseconds(random.integer(0, 30000)));
    if (!backend.take(next)) continue;
    ++taken;
    ASSERT_EQ(backend.taken, whole);
    backend.taken.assign(backend.taken.size(), -1.0F);
  }
  backend.prefetcher.begin(with_next(wavy_request(0, 0), next));
  backend.prefetcher.wait();
  EXPECT_TRUE(backend.take(next));
  EXPECT_EQ(backend.taken, whole);
}

TEST_F(FramePrefetch, AnythingElseIsDropped) {
  Backend backend(planet_);
  const core::DrawRequest next = wavy_request(0.5, 45, 64, 40);
  std::vector<core::DrawRequest> others(8, next);
  double& x = others[0].view.camera.position_m.x;
  x = std::nextafter(x, 0.0);
  others[1].view.width = 65;
  others[2].view.part = {0, 0, 64, 39};
  others[3].settings.exaggeration = 2;
  others[4].settings.ray_mode = core::RayMode::kMultires;
  others[5].coarsening = 2;
  others[6].view.principal_offset_px.y = 1e-9;
  others[7].view.projection = core::Projection::kCylinder;
  for (const core::DrawRequest& other : others) {
    backend.prefetcher.begin(with_next(wavy_request(0, 0), next));
    backend.prefetcher.wait();
    EXPECT_FALSE(backend.take(other));
    EXPECT_FALSE(backend.take(next));
  }
}

TEST_F(FramePrefetch, NotWithOneThreadNorLargeImagesNorSeveralSamples) {
  core::DrawRequest next = wavy_request(0.5, 45, 64, 40);
  Backend one(planet_, 1);
  one.prefetcher.begin(with_next(wavy_request(0, 0), next));
  one.prefetcher.wait();
  EXPECT_GT(one.tiles(), 0);  // tiles are read all the same
  EXPECT_FALSE(one.take(next));

  Backend small(planet_, 2, kBudget, 8 * 64 * 40 * sizeof(float) - 1);
  small.prefetcher.begin(with_next(wavy_request(0, 0), next));
  small.prefetcher.wait();
  EXPECT_FALSE(small.take(next));

  Backend large(planet_, 2, kBudget, 8 * 64 * 40 * sizeof(float));
  large.prefetcher.begin(with_next(wavy_request(0, 0), next));
  large.prefetcher.wait();
  EXPECT_TRUE(large.take(next));

  next.settings.samples = 2;
  Backend several(planet_);
  several.prefetcher.begin(with_next(wavy_request(0, 0), next));
  several.prefetcher.wait();
  EXPECT_FALSE(several.take(next));
}

// The current image keeps all its tiles.
TEST_F(FramePrefetch, CachesKeepWhatTheImageUses) {
  const core::DrawRequest now = wavy_request(0, 0);
  Backend roomy(planet_);
  const std::vector<float> range = roomy.cast(now);
  const std::size_t set = roomy.caster.store().build_totals().bytes;
  // A budget of which the image fills half of the height grids' part.
  const auto budget = static_cast<std::size_t>(static_cast<double>(set) / 0.55 / 0.75 / 0.95);
  Backend backend(planet_, 2, budget);
  for (int n = 0; n < 6; ++n) {
    backend.cast(now);
    const std::int64_t cast = backend.tiles();
    backend.cast(now);
    const std::int64_t before = backend.tiles();
    const std::int64_t always = before - cast;  // grids in double below the camera, of which few are kept
    core::DrawRequest request = now;
    for (int k = 1; k <= 3; ++k) request.paging.upcoming.push_back(wavy_request(n, 60.0 * k).view);
    backend.prefetcher.begin(request);
    backend.prefetcher.wait();
    const std::int64_t read_early = backend.tiles() - before;
    backend.cast(now);
    EXPECT_LE(backend.tiles() - before, read_early + always + 4) << n;
    EXPECT_GT(read_early, 10);
    EXPECT_LE(always, 12);
    EXPECT_LE(backend.caster.store().bytes_resident(), backend.caster.store().budget_bytes());
  }
  EXPECT_EQ(backend.cast(now), range);
}

TEST_F(FramePrefetch, LittleMemoryIsNotExceeded) {
  Backend backend(planet_, 2, std::size_t{2} << 20);
  // A cache keeps its newest value whatever its size.
  const std::size_t most = 2 * (std::size_t{2} << 20) + (std::size_t{2} << 20);
  for (int n = 0; n < 8; ++n) {
    backend.prefetcher.begin(with_next(wavy_request(n, 0), wavy_request(n + 1, 40.0 * n)));
    backend.prefetcher.wait();
    EXPECT_LE(backend.caster.bytes_resident() + backend.painter.bytes_resident(), most);
  }
}

TEST_F(FramePrefetch, EndsAtAnyMoment) {
  Random random(3);
  for (int n = 0; n < 40; ++n) {
    Backend backend(planet_, random.integer(1, 4));
    for (int k = random.integer(1, 3); k > 0; --k) {
      backend.prefetcher.begin(with_next(wavy_request(0, 0), wavy_request(0.3 * k, 10.0 * n)));
      std::this_thread::sleep_for(std::chrono::microseconds(random.integer(0, 8000)));
      if (random.integer(0, 3) != 0) continue;
      backend.prefetcher.stop();
      EXPECT_FALSE(backend.take(wavy_request(0.3 * k, 10.0 * n)));
    }
  }
}

// Draws a film whose requests name the next frame, rightly or wrongly.
TEST_F(FramePrefetch, ImagesAreTheSame) {
  std::vector<core::DrawRequest> film;
  for (int n = 0; n < 10; ++n) {
    core::DrawRequest request = wavy_request(0.05 * n, 3.0 * n, 160, 90);
    request.settings.exaggeration = n < 5 ? 1 : 3;
    if (n == 7) request.settings.samples = 2;
    if (n == 8) request.settings.ray_mode = core::RayMode::kMultires;
    film.push_back(request);
  }
  std::vector<core::DrawResult> expected;
  const auto alone = vpe::voxel::make_ray_renderer(planet_, {kBudget, 1});
  for (const core::DrawRequest& request : film) expected.push_back(alone->draw(request));
  for (const int threads : {1, 2, 3}) {
    for (const std::size_t wrong_every : {0U, 3U}) {
      for (const std::size_t budget : {kBudget, std::size_t{4} << 20}) {
        const auto renderer = vpe::voxel::make_ray_renderer(planet_, {budget, threads});
        for (std::size_t n = 0; n < film.size(); ++n) {
          const std::size_t next =
              wrong_every != 0 && n % wrong_every == 0 ? 0 : std::min(n + 1, film.size() - 1);
          const core::DrawResult result = renderer->draw(with_next(film[n], film[next]));
          ASSERT_EQ(result.frame.colour, expected[n].frame.colour) << n;
          ASSERT_EQ(result.frame.range_m, expected[n].frame.range_m) << n;
          EXPECT_EQ(result.stats.tiles_by_level, expected[n].stats.tiles_by_level);
          EXPECT_EQ(core::to_json(result.certificate).dump(2), core::to_json(expected[n].certificate).dump(2));
        }
      }
    }
  }
}

TEST_F(FramePrefetch, DamageInTheNextFrameDoesNotAffectThisOne) {
  const auto path = *dir_ / "damaged.vpe";
  std::filesystem::copy_file(*dir_ / "wavy.vpe", path);
  const core::DrawRequest now = wavy_request(0, 0, 96, 60);
  core::DrawRequest next = wavy_request(180, 0, 96, 60);
  next.view.camera = mars::to_camera({40, -60, 200000, 0, -60, 0}, planet_->radius_m());
  // Damages the tile below the next camera.
  const paging::Surface surface(planet_, kBudget);
  const std::int64_t tile = lod::pack(surface.at(next.view.camera.position_m).tile);
  damage(path, tile);
  const auto damaged = paging::PlanetFile::open(path.string());
  const auto renderer = vpe::voxel::make_ray_renderer(damaged, {kBudget, 2});
  const auto whole = vpe::voxel::make_ray_renderer(planet_, {kBudget, 2});
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(renderer->draw(with_next(now, next)).frame.colour, whole->draw(now).frame.colour);
    const core::DrawResult of_damaged = renderer->draw(with_next(next, now));
    EXPECT_FALSE(of_damaged.missing.empty());
    EXPECT_EQ(of_damaged.failures.empty(), n > 0);
  }
}

}  // namespace
