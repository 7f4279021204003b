// Tests that colours of the ground stand still while the camera moves. Looks each pixel's ground up in the
// frame before.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "mars/geodesy/sun.h"
#include "tests/voxel/swim.h"
#include "vpe/core/frame.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using test_support::RangeImage;

double grey(const vpe::base::Rgb& c) { return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b; }

// Interpolates bilinearly between the four pixels about a position.
double grey_at(const core::Frame& frame, const glm::dvec2& xy) {
  const double x = xy.x - 0.5 - std::floor(xy.x - 0.5);
  const double y = xy.y - 0.5 - std::floor(xy.y - 0.5);
  const auto at = [&](int dx, int dy) {
    const int column = static_cast<int>(std::floor(xy.x - 0.5)) + dx;
    const int row = static_cast<int>(std::floor(xy.y - 0.5)) + dy;
    return grey(frame.colour[static_cast<std::size_t>(row * frame.width + column)]);
  };
  return (1 - y) * ((1 - x) * at(0, 0) + x * at(1, 0)) + y * ((1 - x) * at(0, 1) + x * at(1, 1));
}

// Accumulates how far the grey of pixels moved, in steps of 1/255.
class Steps {
 public:
  void add(double step) {
    ++bins_[std::min<std::size_t>(255, static_cast<std::size_t>(std::abs(step)))];
    ++count_;
    squares_ += step * step;
  }
  std::int64_t count() const { return count_; }
  double rms() const { return std::sqrt(squares_ / static_cast<double>(std::max<std::int64_t>(1, count_))); }
  double share_from(std::size_t step) const {
    std::int64_t sum = 0;
    for (std::size_t k = step; k < bins_.size(); ++k) sum += bins_[k];
    return static_cast<double>(sum) / static_cast<double>(std::max<std::int64_t>(1, count_));
  }
  void print(const char* name) const {
    std::printf("  %-22s %9lld px, RMS %.2f, from 4 on %.3f %%, from 8 %.3f %%, from 16 %.4f %%\n", name,
                static_cast<long long>(count_), rms(), 100 * share_from(4), 100 * share_from(8),
                100 * share_from(16));
  }

 private:
  std::vector<std::int64_t> bins_ = std::vector<std::int64_t>(256);
  std::int64_t count_ = 0;
  double squares_ = 0;
};

// Holds steps of colour. Colours have a level whose posts and texels are at most a pixel wide. It changes where
// the range passes a power of two of some length, all around the camera. `crossing`: pixels whose ground has
// passed one since the frame before; `beside`: those within a tenth of one that have not.
struct ColourSwim {
  Steps all, beside, crossing;
};

// $VPE_GALE_PLANET names a planet file with fine ground at Gale.
class LongColourSwim : public testing::TestWithParam<core::RayMode> {
 protected:
  void SetUp() override {
    const char* ready = std::getenv("VPE_GALE_PLANET");
    if (ready == nullptr) GTEST_SKIP() << "skipped: $VPE_GALE_PLANET names no planet file";
    planet_ = paging::PlanetFile::open(ready);
  }

  ColourSwim measure(core::Mode mode, double alt_m, double pitch_deg, double metres_a_frame) const {
    constexpr int kFrames = 40;
    const auto renderer = vpe::voxel::make_ray_renderer(planet_);
    vpe::base::ThreadPool pool(2);
    ColourSwim swim;
    core::DrawResult before;
    RangeImage before_range;
    for (int n = 0; n < kFrames; ++n) {
      core::DrawRequest request;
      const double travelled_deg = metres_a_frame * n / planet_->radius_m() * 57.29577951308232;
      const mars::Pose pose{
          137.38 + 0.94 * travelled_deg, -4.62 + 0.34 * travelled_deg, alt_m, 70, pitch_deg, 0};
      request.view.camera = mars::to_camera(pose, planet_->radius_m());
      request.view.width = 640;
      request.view.height = 360;
      request.settings.ray_mode = GetParam();
      request.settings.mode = mode;
      request.settings.smooth_edges = false;
      request.settings.samples = 1;
      request.sun = mars::sun_direction({137.4, -4.6}, 300, 30);
      request.want_range = true;
      core::DrawResult now = renderer->draw(request);
      RangeImage now_range{request.view, now.frame.range_m};
      if (n > 0) add(swim, before, before_range, now, now_range, pool);
      before = std::move(now);
      before_range = std::move(now_range);
    }
    return swim;
  }

  std::shared_ptr<const paging::PlanetFile> planet_;

 private:
  void add(ColourSwim& swim, const core::DrawResult& before, const RangeImage& before_range,
           const core::DrawResult& now, const RangeImage& now_range, vpe::base::ThreadPool& pool) const {
    const core::View& view = now_range.view;
    const double root = lod::nominal_side_m(0, planet_->radius_m()) / planet_->meta().tile.intervals();
    const auto level = [&](double range_m) { return std::log2(root * core::focal_px(view) / range_m); };
    const std::vector<float> pops = test_support::pops_px(before_range, now_range, pool);
    for (std::size_t k = 0; k < pops.size(); ++k) {
      if (std::isnan(pops[k])) continue;
      const auto x = static_cast<double>(k % static_cast<std::size_t>(view.width)) + 0.5;
      const auto y = static_cast<double>(k / static_cast<std::size_t>(view.width)) + 0.5;
      const auto range = static_cast<double>(now_range.range_m[k]);
      const glm::dvec3 place = view.camera.position_m + range * core::pixel_ray(view, x, y);
      const core::Projected at = core::project(before_range.view, place);
      const double step = grey(now.frame.colour[k]) - grey_at(before.frame, at.xy);
      const double is = level(range);
      const double was = level(glm::length(place - before_range.view.camera.position_m));
      swim.all.add(step);
      if (std::ceil(is) != std::ceil(was)) {
        swim.crossing.add(step);
      } else if (std::abs(is - std::round(is)) < 0.14) {
        swim.beside.add(step);
      }
    }
  }
};

TEST_P(LongColourSwim, OverGale) {
  struct Case {
    const char* name;
    core::Mode mode;
    double alt_m, pitch_deg, metres_a_frame;
  };
  for (const Case& c : {Case{"textured, low", core::Mode::kTextured, -2300, -8, 6},
                        Case{"lit, low", core::Mode::kLit, -2300, -8, 6},
                        Case{"textured, high", core::Mode::kTextured, 11000, -25, 40},
                        Case{"lit, high", core::Mode::kLit, 11000, -25, 40}}) {
    const ColourSwim swim = measure(c.mode, c.alt_m, c.pitch_deg, c.metres_a_frame);
    std::printf("%s\n", c.name);
    swim.all.print("all");
    swim.beside.print("beside a change");
    swim.crossing.print("level changed");
    EXPECT_GT(swim.crossing.count(), 1000);
    // A change of levels is a step about as large as what motion by parts of a pixel makes of textures anyhow.
    EXPECT_LE(swim.crossing.rms(), 2 * swim.beside.rms());
    EXPECT_LE(swim.crossing.share_from(16), 0.03);
  }
}

INSTANTIATE_TEST_SUITE_P(LongModes, LongColourSwim,
                         testing::Values(core::RayMode::kExact, core::RayMode::kMultires));

}  // namespace
