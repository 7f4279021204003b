// Every mode, shading and colour against an independent implementation of the definition.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <glm/geometric.hpp>

#include "tests/gl/appearance_fixture.h"
#include "tests/gl/gl_fixture.h"
#include "vpe/gl/tile_needs.h"

namespace {

namespace core = vpe::core;

constexpr int kWidth = 96;
constexpr int kHeight = 72;

void set(core::DrawRequest& request, const core::Appearance& appearance) {
  static_cast<core::Appearance&>(request.settings) = appearance;
}

class Appearance : public test_support::GlTest {
 protected:
  std::shared_ptr<const paging::PlanetFile> planet() { return test_support::wavy_planet(dir_ / "p.vpe"); }

  static core::DrawRequest request(double radius_m) {
    const mars::LonLat place = mars::lon_lat(test_support::kWavyMiddle);
    core::DrawRequest out = test_support::request_for({place.lon_deg, place.lat_deg, 60000, 40, -65, 10},
                                                      radius_m, kWidth, kHeight, 40);
    out.settings.background = core::Background::kBlack;
    out.settings.smooth_edges = false;
    out.settings.lod_tolerance_px = 0;
    return out;
  }
};

TEST_F(Appearance, EveryModeShadingAndColourAsDefined) {
  const auto file = planet();
  const paging::Surface surface(file, std::size_t{1} << 26);
  const auto draw = renderer(file);
  for (const core::Appearance& appearance : test_support::all_appearances()) {
    core::DrawRequest r = request(file->radius_m());
    set(r, appearance);
    EXPECT_GE(test_support::agreement(*draw, surface, r), 0.999) << test_support::name(appearance);
  }
}

// Returns every appearance that uses other vertices, textures or programs.
std::vector<core::Appearance> appearances() {
  std::vector<core::Appearance> all;
  for (const auto mode : {core::Mode::kWireframe, core::Mode::kMarkers, core::Mode::kUnlit, core::Mode::kLit,
                          core::Mode::kColoured, core::Mode::kTextured}) {
    for (const auto shading : {core::Shading::kFlat, core::Shading::kGouraud, core::Shading::kVertex}) {
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

// Switching a mode on and off restores the pixels and the memory.
TEST_F(Appearance, ChangedAndChangedBackLeavesNothing) {
  const auto file = planet();
  const auto draw = renderer(file);
  core::DrawRequest home = request(file->radius_m());
  home.settings.lod_tolerance_px = 2;
  // Caches of the CPU have bounds of their own and may grow: all are filled first.
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

// Bytes on the GPU by appearance, in proportion to vertices (docs/design/appearance.md has the table).
TEST_F(Appearance, AModeCostsWhatItUses) {
  const auto file = planet();
  const lod::TileInfo& tile = file->tree()[0];
  const auto needs = [&](const core::Appearance& a) {
    const auto scale = paging::needs_scale(a, true) ? std::make_shared<const core::ColourScale>(a) : nullptr;
    return vpe::gl::material(a, {1, 0, 0}, true, scale);
  };
  const auto vertex_bytes = [&](const core::Appearance& a) {
    const bool charts = vpe::gl::needs_charts(tile.key, *file, needs(a));
    return sizeof(vpe::gl::VertexPosition) + (charts ? sizeof(vpe::gl::VertexChart) : 0);
  };
  for (const core::Appearance& a : appearances()) {
    const vpe::gl::TileMaterial p = needs(a);
    EXPECT_LE(vertex_bytes(a), 20U);
    const bool textured = vpe::gl::is_textured(tile.key, *file, p);
    if (p.method != vpe::gl::PaintMethod::kPalette) {
      EXPECT_EQ(textured, p.method == vpe::gl::PaintMethod::kTexture);
    }
    EXPECT_EQ(vertex_bytes(a) == 16U, p.method == vpe::gl::PaintMethod::kTexture && !p.shading.flat);
    EXPECT_EQ(p.shading.scale != nullptr, paging::needs_scale(a, true));
    // Normals, 4 bytes a vertex more, are for light of vertices alone; textures then have no light.
    const bool is_lit =
        a.mode == core::Mode::kLit || a.mode == core::Mode::kColoured || a.mode == core::Mode::kTextured;
    EXPECT_EQ(p.light.has_value(), a.shading == core::Shading::kVertex && is_lit);
    EXPECT_EQ(p.shading.lit, a.shading != core::Shading::kVertex && is_lit);
    if (a.mode == core::Mode::kWireframe) {
      EXPECT_FALSE(textured);
      EXPECT_EQ(vertex_bytes(a), 12U);
    }
  }
  core::Appearance unlit;
  unlit.mode = core::Mode::kUnlit;
  EXPECT_EQ(vertex_bytes(unlit), 12U);
  EXPECT_EQ(needs(unlit).method, vpe::gl::PaintMethod::kPalette);
}

// Textures of light of vertices depend on no sun; meshes do, where there are shadows.
TEST_F(Appearance, TheSunOfVerticesIsNoPartOfTextures) {
  core::Appearance a;
  a.shading = core::Shading::kVertex;
  const auto material = [&a](const glm::dvec3& sun) { return vpe::gl::material(a, sun, true, nullptr); };
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0);
  EXPECT_EQ(material(x).shading, material(y).shading);
  EXPECT_FALSE(material(x) == material(y));
  EXPECT_EQ(material(y).light->sun, y);
  EXPECT_EQ(vpe::gl::shadow_sun(material(y)), std::nullopt);
  a.shadows = true;
  EXPECT_EQ(vpe::gl::shadow_sun(material(y)), y);
  EXPECT_EQ(material(x).shading, material(y).shading);
  EXPECT_FALSE(vpe::gl::normal_params(2, std::nullopt).shadows);
  const paging::ShadingParams shadowed = vpe::gl::normal_params(2, y);
  EXPECT_TRUE(shadowed.lit && shadowed.shadows);
  EXPECT_EQ(shadowed.sun, y);
  EXPECT_EQ(shadowed.exaggeration, 2);
  a.shading = core::Shading::kGouraud;
  EXPECT_EQ(vpe::gl::shadow_sun(material(y)), std::nullopt);
  EXPECT_EQ(material(y).light, std::nullopt);
}

// From orbit meshes are coarse and off by kilometres; colours of elevation must not be.
TEST_F(Appearance, UnlitElevationIsThatOfTheGroundFromOrbitToo) {
  const auto file = planet();
  const auto draw = renderer(file);
  core::DrawRequest r =
      test_support::request_for({20, 25, 3e6, 0, -90, 0}, file->radius_m(), kWidth, kHeight, 40);
  r.settings.background = core::Background::kBlack;
  r.settings.mode = core::Mode::kUnlit;
  r.settings.palette_low = -4000;
  r.settings.palette_high = 4000;
  r.settings.palette = "grey";
  r.settings.smooth_edges = false;
  const auto fine = draw->draw(r);
  ASSERT_GT(fine.certificate.geometric_error_m, 500);
  const paging::Surface surface(file, std::size_t{1} << 26);
  int known = 0, good = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto at = static_cast<std::size_t>(y * kWidth + x);
      const double range = surface.cast(r.view.camera.position_m, core::pixel_ray(r.view, x + 0.5, y + 0.5));
      if (!std::isfinite(range) || !std::isfinite(fine.frame.range_m[at])) continue;
      const glm::dvec3 hit = r.view.camera.position_m + range * core::pixel_ray(r.view, x + 0.5, y + 0.5);
      const double wanted = 255 * std::clamp((surface.at(hit).height_m + 4000) / 8000, 0.0, 1.0);
      ++known;
      good += std::abs(fine.frame.colour[at].r - wanted) < 12 ? 1 : 0;
    }
  }
  EXPECT_GT(known, 3000);
  EXPECT_GT(good, 0.97 * known);
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
