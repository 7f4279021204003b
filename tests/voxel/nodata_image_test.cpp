// Where an image covers nodata ground, both backends show it in stripes, and count its pixels as nodata.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

#include "tests/gl/gl_fixture.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using test_support::bumpy_height;
using test_support::FakeElevation;

constexpr int kWidth = 240;
constexpr int kHeight = 180;

// The stripes' greys, relative to that of missing imagery.
constexpr double kBright = 150.0 / 128;
constexpr double kDark = 60.0 / 128;
constexpr double kMean = 105.0 / 128;

// Returns the image's colour, at most 190: bright stripes are not clipped.
glm::dvec3 image_at(const glm::dvec3& d) {
  return 110.0 + 80.0 * glm::sin(glm::dvec3(12 * d.x + 1, 10 * d.y, 13 * d.z + 2));
}

const glm::dvec3 kMiddle = mars::direction({10, 20});
bool is_nodata(const glm::dvec3& d) { return glm::length(d - kMiddle) < 0.25; }
// The image ends within the hole.
double image_ends(const glm::dvec3& d) { return glm::dot(d - kMiddle, mars::direction({100, 0})) - 0.1; }

class HalfImage : public test_support::FakeImage {
 public:
  void sample(std::span<const glm::dvec3> directions, double, std::span<vpe::base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const glm::dvec3 d = glm::normalize(directions[n]);
      const glm::dvec3 c = glm::round(image_at(d));
      colours[n] = {static_cast<std::uint8_t>(c.x), static_cast<std::uint8_t>(c.y),
                    static_cast<std::uint8_t>(c.z)};
      alpha[n] = image_ends(d) < 0 ? 255 : 0;
    }
  }
  double spacing_in(const mars::Cap&) const override { return 20000; }
};

// Holds what the hole's inner pixels show: those whose neighbours are alike.
struct Hole {
  glm::dvec3 seen{0, 0, 0}, image{0, 0, 0};  // means of the part with an image
  int pixels = 0, bright = 0, dark = 0;      // of that part
  int beyond = 0, neutral = 0;               // pixels without an image; those in the greys of nodata
  int nodata = 0;                            // pixels of the whole hole
};

class NodataImage : public test_support::GlTest {
 protected:
  void SetUp() override {
    paging::BuildOptions options;
    options.output = (dir_ / "hole.vpe").string();
    options.base_spacing_m = 60000;
    options.threads = 2;
    options.tile_k = 5;
    options.resampling_posts = 1000;
    const HalfImage image;
    const FakeElevation elevation([](const glm::dvec3& d) { return is_nodata(d) ? NAN : bumpy_height(d); });
    paging::build_planet(options, elevation, &image);
    planet_ = paging::PlanetFile::open(options.output);
    surface_ = std::make_unique<paging::Surface>(planet_, std::size_t{64} << 20);
    triangles_ = renderer(planet_);
    rays_ = vpe::voxel::make_ray_renderer(planet_, {std::size_t{256} << 20, 2});
  }

  core::DrawRequest request(const mars::Pose& pose) const {
    core::DrawRequest out = test_support::request_for(pose, planet_->radius_m(), kWidth, kHeight);
    out.settings.lod_tolerance_px = 0;
    out.settings.smooth_edges = false;
    out.settings.mode = core::Mode::kTextured;
    return out;
  }

  Hole hole(const core::DrawRequest& request, const core::DrawResult& result) const {
    enum Kind { kOther, kImage, kNone };
    const std::vector<float>& range_m = result.frame.range_m;
    std::vector<Kind> kinds(range_m.size(), kOther);
    std::vector<glm::dvec3> directions(range_m.size());
    Hole out;
    for (std::size_t n = 0; n < range_m.size(); ++n) {
      if (!std::isfinite(range_m[n])) continue;
      const auto x = static_cast<double>(n % kWidth), y = static_cast<double>(n / kWidth);
      const glm::dvec3 ray = glm::normalize(core::pixel_ray(request.view, x + 0.5, y + 0.5));
      directions[n] = glm::normalize(request.view.camera.position_m + double{range_m[n]} * ray);
      if (!surface_->at(directions[n]).nodata) continue;
      ++out.nodata;
      // A block of JPEG is 8 texels wide.
      const double end = image_ends(directions[n]);
      if (std::abs(end) > 9 * 20000 / planet_->radius_m()) kinds[n] = end < 0 ? kImage : kNone;
    }
    for (std::size_t y = 1; y + 1 < kHeight; ++y) {
      for (std::size_t x = 1; x + 1 < kWidth; ++x) {
        const std::size_t at = y * kWidth + x;
        const auto alike = [&](std::size_t other) { return kinds[other] == kinds[at]; };
        if (kinds[at] == kOther || !alike(at - 1) || !alike(at + 1) || !alike(at - kWidth) ||
            !alike(at + kWidth))
          continue;
        const vpe::base::Rgb& c = result.frame.colour[at];
        if (kinds[at] == kNone) {
          ++out.beyond;
          const int spread = std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b});
          out.neutral += spread <= 2 && c.r >= 58 && c.r <= 152;
          continue;
        }
        const glm::dvec3 seen(c.r, c.g, c.b), image = image_at(directions[at]);
        ++out.pixels;
        out.seen += seen;
        out.image += image;
        const double tone = (seen.x + seen.y + seen.z) / (image.x + image.y + image.z);
        out.bright += std::abs(tone - kBright) < 0.06;
        out.dark += std::abs(tone - kDark) < 0.04;
      }
    }
    out.seen /= std::max(out.pixels, 1);
    out.image /= std::max(out.pixels, 1);
    return out;
  }

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::unique_ptr<paging::Surface> surface_;
  std::unique_ptr<core::Renderer> triangles_, rays_;
};

const std::vector<std::pair<const char*, mars::Pose>> kPoses{{"far", {10, 20, 4e6, 0, -90, 0}},
                                                             {"oblique", {5, 14, 600e3, 30, -50, 0}},
                                                             {"near", {8, 18, 60e3, 40, -30, 0}}};

TEST_F(NodataImage, IsShownInStripesByBothBackends) {
  for (const auto& [name, pose] : kPoses) {
    core::DrawRequest request = this->request(pose);
    // By night too: light would be that of ground which nobody has measured.
    for (const bool night : {false, true}) {
      if (night) request.sun = -request.sun;
      std::vector<core::DrawResult> results;
      for (core::Renderer* draw : {triangles_.get(), rays_.get()}) {
        SCOPED_TRACE(std::string(name) + (draw == rays_.get() ? " rays" : " triangles") +
                     (night ? " night" : ""));
        results.push_back(draw->draw(request));
        const Hole hole = this->hole(request, results.back());
        ASSERT_GT(hole.pixels, 1000);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(hole.seen[c], kMean * hole.image[c], 4) << c;
        EXPECT_GT(hole.bright, hole.pixels / 4);
        EXPECT_GT(hole.dark, hole.pixels / 4);
        EXPECT_GT(hole.bright + hole.dark, hole.pixels * 2 / 3);
        // Without an image, as in modes of elevation.
        EXPECT_GE(hole.neutral, hole.beyond * 0.98);
        EXPECT_NEAR(results.back().certificate.nodata_share.value(),
                    static_cast<double>(hole.nodata) / (kWidth * kHeight), 0.02);
      }
      // The stripes of both lie at the same places.
      int alike = 0, all = 0;
      for (std::size_t n = 0; n < results[0].frame.colour.size(); ++n) {
        const vpe::base::Rgb &a = results[0].frame.colour[n], &b = results[1].frame.colour[n];
        if (!std::isfinite(results[0].frame.range_m[n])) continue;
        ++all;
        alike += std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) <= 30;
      }
      EXPECT_GT(alike, all * 0.93) << name;
    }
  }
}

TEST_F(NodataImage, IsThatOfEveryModeThatShowsImagery) {
  struct Look {
    core::Mode mode;
    core::Colour colour;
    core::Shading shading;
    bool colourise;
  };
  using core::Colour;
  using core::Mode;
  using core::Shading;
  for (const Look& look : {Look{Mode::kTextured, Colour::kElevation, Shading::kFlat, false},
                           // Hues would be those of elevations that nobody has measured.
                           Look{Mode::kTextured, Colour::kElevation, Shading::kGouraud, true},
                           Look{Mode::kColoured, Colour::kImage, Shading::kGouraud, false},
                           Look{Mode::kUnlit, Colour::kImage, Shading::kFlat, false},
                           Look{Mode::kUnlit, Colour::kImage, Shading::kGouraud, false}}) {
    core::DrawRequest request = this->request(kPoses[1].second);
    request.settings.mode = look.mode;
    request.settings.colour = look.colour;
    request.settings.shading = look.shading;
    request.settings.colourise = look.colourise;
    for (core::Renderer* draw : {triangles_.get(), rays_.get()}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(look.mode)) +
                   std::to_string(static_cast<int>(look.shading)) +
                   (draw == rays_.get() ? " rays" : " triangles"));
      const Hole hole = this->hole(request, draw->draw(request));
      ASSERT_GT(hole.pixels, 1000);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(hole.seen[c], kMean * hole.image[c], 5) << c;
    }
  }
}

TEST_F(NodataImage, IsLeftOutWhereAModeShowsElevation) {
  core::DrawRequest request = this->request(kPoses[1].second);
  for (const core::Mode mode : {core::Mode::kUnlit, core::Mode::kLit, core::Mode::kColoured}) {
    request.settings.mode = mode;
    for (core::Renderer* draw : {triangles_.get(), rays_.get()}) {
      const Hole hole = this->hole(request, draw->draw(request));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(hole.seen[c], 105, 2);
    }
  }
}

}  // namespace
