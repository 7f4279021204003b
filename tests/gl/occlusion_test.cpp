// Occlusion changes no pixel of complete images, and makes none coarser that lacks tiles.
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "tests/gl/certified.h"
#include "tests/paging/rough_planet.h"

namespace {

using test_support::Random;
using vpe::core::DrawRequest;
using vpe::core::DrawResult;
using vpe::core::Occlusion;
using vpe::core::Renderer;

class OcclusionBase : public test_support::GlTest {
 protected:
  void SetUp() override {
    planet_ = test_support::build_rough(dir_ / "p.vpe");
    surface_ = std::make_unique<paging::Surface>(planet_, std::size_t{1} << 28);
  }

  // Returns a view in the canyon, the crater, the basin, at the pole or anywhere, from half a metre up to
  // orbit. Some cameras are just under the ground as it is drawn: exaggerated facets are above exaggerated
  // heights.
  DrawRequest random_request(Random& random) const {
    const glm::dvec3 centres[] = {test_support::kCanyon, test_support::kCrater, test_support::kBasin,
                                  test_support::kPole, random.direction()};
    const glm::dvec3& centre = centres[random.integer(0, 4)];
    const double away = 0.004 * random.uniform(0, 1);
    const glm::dvec3 at = glm::normalize(centre + away * random.direction());
    const mars::LonLat place = mars::lon_lat(at);
    const double exaggeration = random.integer(0, 4) == 0 ? random.uniform(0.5, 4) : 1.0;
    const double height =
        random.integer(0, 3) == 0 ? random.log_uniform(1e4, 3e6) : random.log_uniform(0.5, 1e4);
    const mars::Pose pose{place.lon_deg,
                          place.lat_deg,
                          exaggeration * surface_->at(at).height_m + height,
                          random.uniform(0, 360),
                          random.uniform(-60, 10),
                          random.integer(0, 2) == 0 ? random.uniform(-180, 180) : 0.0};
    DrawRequest request =
        test_support::request_for(pose, planet_->radius_m(), 192, 108, random.integer(0, 3) == 0 ? 100 : 60);
    request.settings.exaggeration = exaggeration;
    return request;
  }

  static DrawRequest with(DrawRequest request, Occlusion occlusion) {
    request.settings.occlusion = occlusion;
    return request;
  }

  void expect_same_images(int views, unsigned seed, double least_share) {
    const auto on = renderer(planet_);
    const auto off = renderer(planet_);
    Random random(seed);
    int hidden = 0;
    int all = 0;
    for (int n = 0; n < views; ++n) {
      const DrawRequest request = random_request(random);
      const DrawResult with_it = on->draw(with(request, Occlusion::kOn));
      const DrawResult without = off->draw(with(request, Occlusion::kOff));
      ASSERT_EQ(with_it.frame.colour, without.frame.colour) << "view " << n;
      ASSERT_EQ(with_it.frame.range_m, without.frame.range_m) << "view " << n;
      EXPECT_EQ(with_it.stats.tiles_drawn + with_it.stats.tiles_culled_occlusion, without.stats.tiles_drawn);
      EXPECT_EQ(without.stats.tiles_culled_occlusion, 0);
      EXPECT_LE(with_it.certificate.shift_bound_px, without.certificate.shift_bound_px);
      hidden += with_it.stats.tiles_culled_occlusion;
      all += without.stats.tiles_drawn;
    }
    std::printf("%d views: %d of %d tiles hidden\n", views, hidden, all);
    EXPECT_GT(hidden, least_share * all);  // else the views do not test it
  }

  // Expects ground of an image, complete or not, to be within the stated shift of where it should be.
  void expect_certified_ground(const DrawRequest& request, const DrawResult& result) const {
    const vpe::core::SurfaceRadius radius = [&](std::span<const glm::dvec3> directions,
                                                std::span<double> radius_m) {
      surface_->radius(directions, radius_m, request.settings.exaggeration);
    };
    const auto shifts = vpe::core::forward_shift_px(request.view, result.frame.range_m, radius);
    const auto shift = vpe::core::summarize(shifts, vpe::core::drawn_size(request.view).x);
    EXPECT_LE(shift.max_px, result.certificate.shift_bound_px +
                                test_support::range_error_px(request.view, result.frame.range_m));
  }

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::unique_ptr<paging::Surface> surface_;
};

using Occluded = OcclusionBase;
using LongOccluded = OcclusionBase;

TEST_F(Occluded, ImagesAreTheSameWithAndWithout) { expect_same_images(40, 71, 0.2); }
TEST_F(LongOccluded, ImagesAreTheSameWithAndWithout) { expect_same_images(600, 72, 0.2); }

// Lets a number of loads pass, and holds the others back.
class Gate {
 public:
  void pass() {
    std::unique_lock lock(mutex_);
    ++waiting_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return free_ > 0; });
    --waiting_;
    --free_;
  }
  void let(int more) {
    const std::lock_guard lock(mutex_);
    free_ += more;
    changed_.notify_all();
  }
  // Waits until all that were let have passed and the next load waits, or, if there is none, for a while.
  void wait_for_loads() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(500), [this] { return free_ == 0 && waiting_ > 0; });
  }

  // A renderer that waits for its loads can end.
  struct OpenAtEnd {
    Gate& gate;
    ~OpenAtEnd() { gate.let(1 << 20); }
  };

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int free_ = 0;
  int waiting_ = 0;
};

// Whatever is resident, and whatever replaces the rest. A tile that is missing and hidden needs no fallback with
// occlusion; without, its fallback may take the place of neighbours that are resident. Then the image with occlusion
// is the finer one, and keeps its certificate.
TEST_F(Occluded, UnfinishedImagesAreTheSameOrFiner) {
  Random random(73);
  int unfinished = 0;
  int finer = 0;
  for (int n = 0; n < 6; ++n) {
    Gate gate;
    const auto draw =
        vpe::gl::make_polygon_renderer(context_, planet_, {std::size_t{256} << 20, 1, [&](const auto& tile) {
                                                             if (tile.level > 0) gate.pass();
                                                           }});
    const Gate::OpenAtEnd at_end{gate};
    DrawRequest request = random_request(random);
    request.paging.wait = false;
    request.paging.upload_ms = 1e6;
    for (int step = 0; step < 12; ++step) {
      draw->draw(with(request, Occlusion::kOn));
      gate.let(random.integer(0, 12));
      gate.wait_for_loads();
      // The first frame takes what has been loaded, the others draw the same.
      draw->draw(with(request, Occlusion::kOff));
      const DrawResult without = draw->draw(with(request, Occlusion::kOff));
      const DrawResult with_it = draw->draw(with(request, Occlusion::kOn));
      if (without.settled && with_it.settled && without.missing.empty()) break;
      if (without.stats.pages_uploaded + with_it.stats.pages_uploaded > 0) continue;
      unfinished += without.missing.empty() ? 0 : 1;
      SCOPED_TRACE("view " + std::to_string(n) + " step " + std::to_string(step));
      EXPECT_LE(with_it.missing.size(), without.missing.size());
      EXPECT_LE(with_it.certificate.shift_bound_px, without.certificate.shift_bound_px);
      expect_certified_ground(request, with_it);
      if (with_it.stats.tiles_drawn + with_it.stats.tiles_culled_occlusion != without.stats.tiles_drawn &&
          with_it.stats.tiles_substituted < without.stats.tiles_substituted) {
        ++finer;
        continue;
      }
      ASSERT_EQ(with_it.frame.range_m, without.frame.range_m);
      ASSERT_EQ(with_it.frame.colour, without.frame.colour);
    }
  }
  std::printf("%d unfinished images, %d finer with occlusion\n", unfinished, finer);
  EXPECT_GT(unfinished - finer, 10);
}

TEST_F(Occluded, SettledImagesDoNotDependOnHistory) {
  Random random(74);
  const auto draw = renderer(planet_);
  for (int n = 0; n < 10; ++n) {
    DrawRequest request = random_request(random);
    const DrawResult alone = renderer(planet_)->draw(request);
    request.paging.wait = false;
    request.settings.occlusion = Occlusion::kOn;
    DrawResult result = draw->draw(request);
    for (int k = 0; k < 20000 && !result.settled; ++k) result = draw->draw(request);
    ASSERT_TRUE(result.settled) << n;
    EXPECT_TRUE(result.missing.empty());
    EXPECT_EQ(result.frame.colour, alone.frame.colour) << n;
    EXPECT_EQ(result.frame.range_m, alone.frame.range_m) << n;
    EXPECT_EQ(result.stats.tiles_culled_occlusion, alone.stats.tiles_culled_occlusion) << n;
    EXPECT_EQ(result.stats.tiles_drawn, alone.stats.tiles_drawn) << n;
  }
}

// Without occlusion meshes are made without occluder profiles.
TEST_F(Occluded, SwitchedOnItHidesWhatANewOneHides) {
  Random random(75);
  const auto draw = renderer(planet_);
  int hidden = 0;
  for (int n = 0; n < 10; ++n) {
    const DrawRequest request = random_request(random);
    const DrawResult alone = renderer(planet_)->draw(with(request, Occlusion::kOn));
    const DrawResult off = draw->draw(with(request, Occlusion::kOff));
    const DrawResult on = draw->draw(with(request, Occlusion::kOn));
    EXPECT_EQ(off.stats.tiles_culled_occlusion, 0);
    EXPECT_EQ(on.stats.tiles_culled_occlusion, alone.stats.tiles_culled_occlusion) << n;
    EXPECT_EQ(on.stats.tiles_drawn, alone.stats.tiles_drawn) << n;
    ASSERT_EQ(on.frame.colour, alone.frame.colour) << n;
    hidden += on.stats.tiles_culled_occlusion;
  }
  EXPECT_GT(hidden, 0);
}

}  // namespace
