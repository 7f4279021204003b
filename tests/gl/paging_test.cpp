// Frames that do not wait have no holes, true certificates, and the same image in the end.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>

#include "paging/surface/tile_errors.h"
#include "tests/gl/certified.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::FakeImage;
using test_support::fine_around;
using test_support::Random;
namespace core = vpe::core;
using vpe::core::DrawRequest;
using vpe::core::DrawResult;
using vpe::core::Renderer;

const glm::dvec3 kFine = glm::normalize(glm::dvec3(0.3, 0.2, 1));

class Paging : public test_support::GlTest {
 protected:
  void SetUp() override {
    planet_ = build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height, fine_around(kFine, 0.05, 5000)), 50000);
  }

  std::unique_ptr<Renderer> slow_renderer(std::function<void(const lod::TileKey&)> before_load,
                                          std::size_t memory = std::size_t{256} << 20) {
    return vpe::gl::make_polygon_renderer(context_, planet_, {memory, 2, std::move(before_load)});
  }

  DrawRequest flight_at(double t) const {
    const mars::LonLat at = mars::lon_lat(kFine);
    const mars::Pose pose{at.lon_deg + 20 * t, at.lat_deg - 10 * t, 30000 + 1.5e6 * t * t,
                          40 + 90 * t,         -20 - 40 * t,        10 * t};
    return test_support::request_for(pose, planet_->radius_m(), 160, 96);
  }

  static DrawRequest without_waiting(DrawRequest request) {
    request.paging.wait = false;
    return request;
  }

  // Draws one view again and again until it is settled.
  static DrawResult settle(Renderer& renderer, const DrawRequest& request) {
    DrawResult result;
    for (int n = 0; n < 20000; ++n) {
      result = renderer.draw(request);
      if (result.settled) return result;
      std::this_thread::yield();
    }
    ADD_FAILURE() << "not settled: " << result.missing.size() << " missing";
    return result;
  }

  std::shared_ptr<const paging::PlanetFile> planet_;
};

// Returns a function that delays each load by a time of its own, up to three milliseconds.
std::function<void(const lod::TileKey&)> delays(unsigned seed) {
  return [state = std::make_shared<std::atomic<unsigned>>(seed)](const lod::TileKey&) {
    const unsigned n = state->fetch_add(0x9E3779B9U);
    std::this_thread::sleep_for(std::chrono::microseconds((n >> 20) % 3000));
  };
}

TEST_F(Paging, FramesAreCoveredAndTheirCertificatesTrue) {
  const paging::Surface surface(planet_, std::size_t{1} << 28);
  const auto draw = slow_renderer(delays(1));
  int incomplete = 0;
  for (int n = 0; n < 12; ++n) {
    const DrawRequest request = without_waiting(flight_at(n / 12.0));
    const DrawResult result = draw->draw(request);
    incomplete += result.missing.empty() ? 0 : 1;
    const auto reference = test_support::reference_ranges(surface, request.view);
    const auto errors = vpe::core::compare_to_reference(request.view, result.frame.range_m, reference,
                                                        test_support::radius_of(surface), {64, 64});
    SCOPED_TRACE("frame " + std::to_string(n) + " " + vpe::core::to_json(errors) + " " +
                 vpe::core::to_json(result.certificate).dump(2));
    EXPECT_LE(errors.forward.max_px, result.certificate.shift_bound_px);
    EXPECT_EQ(errors.invalid, 0);
    EXPECT_EQ(result.missing.empty(), result.stats.tiles_missing == 0);
    EXPECT_EQ(result.certificate.tiles_missing, result.stats.tiles_missing);
    EXPECT_GT(result.stats.tiles_drawn, 0);
  }
  EXPECT_GT(incomplete, 0);  // else the frames do not test it
}

// In views straight down there is ground behind every pixel.
TEST_F(Paging, NoFrameHasAHole) {
  const auto draw = slow_renderer(delays(2));
  Random random(3);
  for (int n = 0; n < 60; ++n) {
    const mars::Pose pose{
        random.uniform(-180, 180), random.uniform(-90, 90), random.log_uniform(30000, 1e6), 0, -90, 0};
    DrawRequest request = without_waiting(test_support::request_for(pose, planet_->radius_m(), 64, 64, 40));
    const DrawResult result = draw->draw(request);
    for (const float range : result.frame.range_m) ASSERT_TRUE(std::isfinite(range)) << "frame " << n;
  }
}

TEST_F(Paging, SettledImagesDoNotDependOnHistory) {
  const DrawRequest last = flight_at(0.4);
  const DrawResult alone = renderer(planet_)->draw(last);
  EXPECT_TRUE(alone.settled);
  for (const unsigned seed : {11U, 12U, 13U}) {
    const auto draw = slow_renderer(delays(seed));
    for (int n = 0; n < 8; ++n) draw->draw(without_waiting(flight_at(0.05 * n)));
    const DrawResult result = settle(*draw, without_waiting(last));
    EXPECT_TRUE(result.missing.empty());
    EXPECT_EQ(result.frame.colour, alone.frame.colour) << seed;
    EXPECT_EQ(result.frame.range_m, alone.frame.range_m) << seed;
    EXPECT_EQ(vpe::core::to_json(result.certificate).dump(2), vpe::core::to_json(alone.certificate).dump(2));
    // And waiting, warm.
    EXPECT_EQ(draw->draw(last).frame.colour, alone.frame.colour);
  }
}

TEST_F(Paging, CloseToTheGroundToo) {
  const paging::Surface surface(planet_, std::size_t{1} << 26);
  const mars::LonLat at = mars::lon_lat(kFine);
  const auto pose = [&](double east) {
    const mars::LonLat place{at.lon_deg + east, at.lat_deg};
    return mars::Pose{
        place.lon_deg, place.lat_deg, surface.at(mars::direction(place)).height_m + 2.0, 70, -5, 0};
  };
  const DrawRequest last = test_support::request_for(pose(0.001), planet_->radius_m(), 160, 96);
  const DrawResult alone = renderer(planet_)->draw(last);
  const auto draw = slow_renderer(delays(5));
  for (int n = 0; n < 5; ++n) {
    draw->draw(without_waiting(test_support::request_for(pose(0.0002 * n), planet_->radius_m(), 160, 96)));
  }
  EXPECT_EQ(settle(*draw, without_waiting(last)).frame.range_m, alone.frame.range_m);
}

TEST_F(Paging, AnOldShadingIsDrawnUntilTheNewOneIsLoaded) {
  const auto draw = slow_renderer(delays(6));
  DrawRequest request = without_waiting(flight_at(0.1));
  // With occlusion the time it takes decides which frames use it. In a frame without, tiles are wanted that
  // were not before, and their fallbacks are drawn behind nearer ground.
  request.settings.occlusion = vpe::core::Occlusion::kOff;
  settle(*draw, request);
  request.sun = mars::sun_direction({0, 0}, 200, 20);
  const DrawResult first = draw->draw(request);
  // Nothing coarser is drawn.
  EXPECT_TRUE(first.missing.empty()) << first.missing.size() << " missing, first " << first.missing.front().tile
                                     << ": " << first.missing.front().why;
  EXPECT_FALSE(first.settled);
  const DrawResult after = settle(*draw, request);
  request.paging.wait = true;
  EXPECT_EQ(after.frame.colour, renderer(planet_)->draw(request).frame.colour);
}

TEST_F(Paging, UpcomingViewsAreLoadedAhead) {
  const auto draw = slow_renderer({});
  DrawRequest now = flight_at(0.3);
  DrawRequest next = now;  // under the same sun
  next.view = flight_at(0.5).view;
  now.paging.upcoming = {next.view};
  draw->draw(now);
  std::int64_t waiting = 1;
  for (int n = 0; n < 20000 && waiting > 0; ++n) {
    const DrawResult again = draw->draw(without_waiting(now));
    waiting = again.stats.pages_wanted + again.stats.pages_loading;
  }
  DrawRequest at_once = without_waiting(next);
  const DrawResult result = draw->draw(at_once);
  EXPECT_TRUE(result.missing.empty());
  EXPECT_EQ(result.frame.colour, renderer(planet_)->draw(next).frame.colour);
}

// What is expected takes more than there is room for: what is loaded of it stays, and the rest is not loaded again and again.
TEST_F(Paging, UpcomingViewsAreNotLoadedForEver) {
  const auto draw = slow_renderer({}, std::size_t{128} << 20);
  DrawRequest now = without_waiting(flight_at(0.1));
  for (int n = 1; n <= 9; ++n) {
    core::View& later = now.paging.upcoming.emplace_back(flight_at(0.1 * n).view);
    later.width = 640;
    later.height = 384;
  }
  DrawResult result = settle(*draw, now);
  for (int n = 0; n < 20000 && (n < 50 || result.stats.pages_wanted + result.stats.pages_loading > 0); ++n) {
    result = draw->draw(now);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(result.stats.pages_wanted + result.stats.pages_loading, 0);
  std::int64_t uploaded = 0;
  for (int n = 0; n < 100; ++n) {
    result = draw->draw(now);
    uploaded += result.stats.pages_uploaded;
    EXPECT_TRUE(result.missing.empty());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(uploaded, 0);
}

TEST_F(Paging, ATileThatCannotBeReadIsDrawnCoarserAndReportedOnce) {
  const DrawRequest request = flight_at(0.0);
  const DrawResult whole = renderer(planet_)->draw(request);
  const int deepest = static_cast<int>(whole.stats.tiles_by_level.size()) - 1;
  ASSERT_GT(deepest, 1);
  std::mutex mutex;
  std::set<lod::TileKey> broken;
  const auto draw = slow_renderer([&](const lod::TileKey& tile) {
    const std::lock_guard lock(mutex);
    if (tile.level != deepest || (!broken.empty() && broken.count(tile) == 0)) return;
    broken.insert(tile);
    throw std::runtime_error("p.vpe: tile " + lod::to_string(tile) + " is damaged");
  });
  const DrawResult result = draw->draw(request);
  ASSERT_EQ(broken.size(), 1U);
  ASSERT_EQ(result.failures.size(), 1U);
  EXPECT_NE(result.failures[0].find("is damaged"), std::string::npos);
  ASSERT_FALSE(result.missing.empty());
  bool named = false;
  for (const auto& m : result.missing)
    named |= m.why == result.failures[0] && m.tile == lod::to_string(*broken.begin());
  EXPECT_TRUE(named);
  EXPECT_GT(result.certificate.tiles_substituted, 0);
  EXPECT_LT(result.stats.tiles_drawn, whole.stats.tiles_drawn);
  const DrawResult again = draw->draw(request);
  EXPECT_TRUE(again.failures.empty());
  EXPECT_EQ(again.missing.size(), result.missing.size());
  EXPECT_EQ(again.frame.colour, result.frame.colour);
  // Frames that do not wait end in the same image.
  EXPECT_EQ(settle(*draw, without_waiting(request)).frame.colour, result.frame.colour);
}

TEST_F(Paging, WaitingEndsAndReportsWhatIsMissing) {
  std::atomic<bool> go{false};
  const auto draw = slow_renderer([&](const lod::TileKey& tile) {
    while (tile.level > 0 && !go) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  DrawRequest request = flight_at(0.2);
  request.paging.timeout_s = 0.1;
  const DrawResult result = draw->draw(request);
  EXPECT_FALSE(result.settled);
  ASSERT_FALSE(result.missing.empty());
  EXPECT_EQ(result.missing[0].why, "not loaded yet");
  EXPECT_GT(result.stats.tiles_drawn, 0);  // coarse ground
  go = true;
  request.paging.timeout_s = 60;
  const DrawResult whole = draw->draw(request);
  EXPECT_TRUE(whole.missing.empty());
  EXPECT_EQ(whole.frame.colour, renderer(planet_)->draw(request).frame.colour);
}

// What only certificates need is memory too.
TEST_F(Paging, ErrorsOfBlocksAreCounted) {
  DrawRequest request = flight_at(0.5);
  request.want_range = false;
  const auto draw = renderer(planet_);
  const std::int64_t without = draw->draw(request).stats.bytes_resident;
  EXPECT_EQ(draw->draw(request).stats.bytes_resident, without);
  request.want_range = true;
  const std::int64_t with = draw->draw(request).stats.bytes_resident;
  EXPECT_GT(with, without);
  EXPECT_LE(with, without + static_cast<std::int64_t>(paging::TileErrors::kUsualBytes));
}

TEST_F(Paging, MemoryStaysWithinTheBudgetOnAFlight) {
  constexpr std::size_t kMemory = std::size_t{64} << 20;
  const auto draw = slow_renderer({}, kMemory);
  std::int64_t evicted = 0;
  // On a busy machine one round loads too little to fill the memory.
  for (int n = 0; n < 60 || (evicted == 0 && n < 6000); ++n) {
    const DrawRequest request = without_waiting(flight_at(n % 60 / 60.0));
    const DrawResult result = draw->draw(request);
    evicted += result.stats.pages_evicted;
    EXPECT_LE(result.stats.bytes_resident, static_cast<std::int64_t>(kMemory)) << n;
  }
  EXPECT_GT(evicted, 0);
}

}  // namespace
