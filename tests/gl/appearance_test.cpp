// Every mode, shading and colour against an independent reading of the definition.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <glm/geometric.hpp>

#include "tests/gl/appearance_reference.h"
#include "tests/gl/gl_fixture.h"
#include "vpe/gl/tile_needs.h"

namespace {

namespace core = vpe::core;

constexpr int kWidth = 96;
constexpr int kHeight = 72;

// Rises and falls over some 400 km.
glm::dvec3 image_at(const glm::dvec3& d) {
  return {127 + 110 * std::sin(53 * d.x + 1), 127 + 110 * std::sin(47 * d.y),
          127 + 110 * std::sin(59 * d.z + 2)};
}

class WavyImage : public test_support::FakeImage {
 public:
  void sample(std::span<const glm::dvec3> directions, double, std::span<mars::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const glm::dvec3 c = glm::round(image_at(glm::normalize(directions[n])));
      colours[n] = {static_cast<std::uint8_t>(c.x), static_cast<std::uint8_t>(c.y),
                    static_cast<std::uint8_t>(c.z)};
      alpha[n] = 255;
    }
  }
  double spacing_in(const mars::Cap&) const override { return 20000; }
};

const glm::dvec3 kMiddle = glm::normalize(glm::dvec3(0.9, 0.3, 0.35));

class Appearance : public test_support::GlTest {
 protected:
  std::shared_ptr<const paging::PlanetFile> planet() {
    paging::BuildOptions options;
    options.output = (dir_ / "p.vpe").string();
    options.base_spacing_m = 100000;
    options.threads = 2;
    options.tile_k = 5;
    options.resampling_posts = 1000;
    const WavyImage image;
    paging::build_planet(
        options,
        test_support::FakeElevation(test_support::bumpy_height, test_support::fine_around(kMiddle, 0.06, 5000)),
        &image);
    return paging::PlanetFile::open(options.output);
  }

  static core::DrawRequest request(double radius_m) {
    const mars::LonLat place = mars::lon_lat(kMiddle);
    core::DrawRequest out = test_support::request_for({place.lon_deg, place.lat_deg, 60000, 40, -65, 10},
                                                      radius_m, kWidth, kHeight, 40);
    out.settings.background = core::Background::kBlack;
    out.settings.smooth_edges = false;
    out.settings.lod_tolerance_px = 0;
    return out;
  }

  // The share of pixels within 2 of the reference in every channel, of those that it knows.
  static double agreement(core::Renderer& draw, const paging::Surface& surface,
                          const core::DrawRequest& request) {
    const core::DrawResult result = draw.draw(request);
    const test_support::GroundReference reference(surface, request.settings, request.sun);
    int known = 0, good = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto at = static_cast<std::size_t>(y * kWidth + x);
        if (!std::isfinite(result.frame.range_m[at])) continue;
        const glm::dvec3 hit = request.view.eye.eye_m + static_cast<double>(result.frame.range_m[at]) *
                                                            core::pixel_ray(request.view, x + 0.5, y + 0.5);
        const auto wanted = reference.at(glm::normalize(hit));
        if (!wanted) continue;
        ++known;
        const mars::Rgb c = result.frame.colour[at];
        const glm::dvec3 off = glm::abs(glm::dvec3(c.r, c.g, c.b) - glm::clamp(*wanted, 0.0, 255.0));
        good += std::max({off.x, off.y, off.z}) <= 2.0 ? 1 : 0;
      }
    }
    EXPECT_GT(known, kWidth * kHeight / 2);
    return static_cast<double>(good) / known;
  }
};

TEST_F(Appearance, EveryModeShadingAndColourAsDefined) {
  const auto file = planet();
  const paging::Surface surface(file, std::size_t{1} << 26);
  const auto draw = renderer(file);
  for (const auto mode : {core::Mode::kUnlit, core::Mode::kLit, core::Mode::kColoured, core::Mode::kTextured}) {
    for (const auto shading : {core::Shading::kFlat, core::Shading::kGouraud}) {
      for (const auto colour : {core::Colour::kNone, core::Colour::kElevation, core::Colour::kSlope,
                                core::Colour::kAspect, core::Colour::kImage}) {
        for (const bool colourise : {false, true}) {
          if (colourise && (mode != core::Mode::kTextured || colour == core::Colour::kImage)) continue;
          if (mode == core::Mode::kLit && colour != core::Colour::kNone) continue;
          core::DrawRequest r = request(file->radius_m());
          r.settings.mode = mode;
          r.settings.shading = shading;
          r.settings.colour = colour;
          r.settings.colourise = colourise;
          r.settings.palette_high = colour == core::Colour::kElevation ? 4000 : 0;
          r.settings.palette_low = colour == core::Colour::kElevation ? -4000 : 0;
          r.settings.exaggeration = shading == core::Shading::kFlat ? 2 : 1;
          EXPECT_GE(agreement(*draw, surface, r), 0.999)
              << "mode " << static_cast<int>(mode) << " shading " << static_cast<int>(shading) << " colour "
              << static_cast<int>(colour) << " colourise " << colourise;
        }
      }
    }
  }
}

// Every appearance that uses other vertices, textures or programs.
std::vector<core::Appearance> appearances() {
  std::vector<core::Appearance> all;
  for (const auto mode : {core::Mode::kWireframe, core::Mode::kMarkers, core::Mode::kUnlit, core::Mode::kLit,
                          core::Mode::kColoured, core::Mode::kTextured}) {
    for (const auto shading : {core::Shading::kFlat, core::Shading::kGouraud}) {
      for (const auto colour : {core::Colour::kNone, core::Colour::kElevation, core::Colour::kSlope}) {
        core::Appearance& a = all.emplace_back();
        a.mode = mode;
        a.shading = shading;
        a.colour = colour;
        a.background = core::Background::kBlack;
      }
    }
  }
  core::Appearance& hazy = all.emplace_back();
  hazy.haze_visibility_m = 1e5;
  core::Appearance& shadowed = all.emplace_back();
  shadowed.shadows = true;
  core::Appearance& exaggerated = all.emplace_back();
  exaggerated.exaggeration = 3;
  core::Appearance& bright = all.emplace_back();
  bright.gamma = 2;
  return all;
}

void set(core::DrawRequest& request, const core::Appearance& appearance) {
  static_cast<core::Appearance&>(request.settings) = appearance;
}

// A mode on, then off, leaves the pixels and the memory of before.
TEST_F(Appearance, ChangedAndChangedBackLeavesNothing) {
  const auto file = planet();
  const auto draw = renderer(file);
  core::DrawRequest home = request(file->radius_m());
  home.settings.lod_tolerance_px = 2;
  // Caches of the CPU, bounded by themselves, may hold more than before: all are filled first.
  for (const core::Appearance& a : appearances()) {
    core::DrawRequest other = home;
    set(other, a);
    draw->draw(other);
  }
  const core::DrawResult before = draw->draw(home);
  for (const core::Appearance& a : appearances()) {
    core::DrawRequest other = home;
    set(other, a);
    draw->draw(other);
    const core::DrawResult after = draw->draw(home);
    EXPECT_EQ(after.frame.colour, before.frame.colour);
    EXPECT_EQ(after.stats.bytes_resident, before.stats.bytes_resident);
  }
}

// Bytes on the GPU by appearance, in proportion to vertices (docs/appearance.md has the table).
TEST_F(Appearance, AModeCostsWhatItUses) {
  const auto file = planet();
  const lod::TileInfo& tile = file->tree()[0];
  const auto needs = [&](const core::Appearance& a) {
    const auto scale = paging::needs_scale(a, true) ? std::make_shared<const core::ColourScale>(a) : nullptr;
    return vpe::gl::painting(a, {1, 0, 0}, true, scale);
  };
  const auto vertex_bytes = [&](const core::Appearance& a) {
    const bool charts = vpe::gl::needs_charts(tile.key, *file, needs(a));
    return sizeof(vpe::gl::VertexPosition) + (charts ? sizeof(vpe::gl::VertexChart) : 0);
  };
  for (const core::Appearance& a : appearances()) {
    const vpe::gl::Painting p = needs(a);
    EXPECT_LE(vertex_bytes(a), 20U);
    const bool textured = vpe::gl::is_textured(tile.key, *file, p);
    EXPECT_EQ(textured, p.by == vpe::gl::PaintBy::kTexture);
    EXPECT_EQ(vertex_bytes(a) == 16U, textured && !p.look.flat);
    EXPECT_EQ(p.look.scale != nullptr, paging::needs_scale(a, true));
    if (a.mode == core::Mode::kWireframe) {
      EXPECT_FALSE(textured);
      EXPECT_EQ(vertex_bytes(a), 12U);
    }
  }
  core::Appearance unlit;
  unlit.mode = core::Mode::kUnlit;
  EXPECT_EQ(vertex_bytes(unlit), 12U);
  EXPECT_EQ(needs(unlit).by, vpe::gl::PaintBy::kPalette);
}

using LongAppearance = Appearance;
TEST_F(LongAppearance, TenThousandSwitchesLeakNothing) {
  const auto file = planet();
  const auto draw = renderer(file);
  core::DrawRequest r = request(file->radius_m());
  r.settings.lod_tolerance_px = 2;
  const std::vector<core::Appearance> all = appearances();
  const auto one = [&](std::size_t n) {
    set(r, all[n % all.size()]);
    draw->draw(r);
  };
  const auto resident_mb = [] {
    std::ifstream in("/proc/self/statm");
    double size = 0, resident = 0;
    in >> size >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
  };
  constexpr std::size_t kSwitches = 10000;
  for (std::size_t n = 0; n < kSwitches / 10; ++n) one(n);
  const double early_mb = resident_mb();
  for (std::size_t n = kSwitches / 10; n < kSwitches; ++n) one(n);
  const double late_mb = resident_mb();
  std::printf("%.1f MB after 1000 switches, %.1f MB after 10 000\n", early_mb, late_mb);
  EXPECT_LE(late_mb, early_mb + 8);
}

}  // namespace
