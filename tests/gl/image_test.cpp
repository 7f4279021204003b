// Images of the polygon backend: orientation, parts, modes, history, seams.
#include <gtest/gtest.h>

#include "paging/shading/terrain_shader.h"
#include "tests/gl/gl_fixture.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::Random;
using vpe::core::DrawRequest;
using vpe::core::DrawResult;

class Image : public test_support::GlTest {};

int brightness(const vpe::base::Rgb& c) { return c.r + c.g + c.b; }

TEST_F(Image, ContextNeedsNoDisplay) {
  EXPECT_NE(context_->info().version.find("4."), std::string::npos);
  EXPECT_FALSE(context_->info().renderer.empty());
}

// A mountain to the east of a camera that looks north stands on the right; up is up.
TEST_F(Image, EastIsRightAndUpIsUp) {
  const glm::dvec3 peak = mars::direction({1, 1.5});
  const auto planet = build_fake(dir_ / "p.vpe",
                                 FakeElevation(
                                     [&](const glm::dvec3& d) {
                                       const double r = glm::length(d - peak);
                                       return r < 0.01 ? 20000.0 * (1 - r / 0.01) : 0.0;
                                     },
                                     test_support::fine_around(peak, 0.02, 5000)),
                                 100000);
  DrawRequest request = test_support::request_for({0, 0, 8000, 0, 0, 0}, planet->radius_m(), 200, 100);
  const DrawResult result = renderer(planet)->draw(request);
  double x_sum = 0;
  int count = 0;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 200; ++x) {
      const float range = result.frame.range_m[static_cast<std::size_t>(y * 200 + x)];
      if (y < 50 && std::isfinite(range)) {
        // Above the horizontal only the mountain can be seen.
        x_sum += x;
        ++count;
      }
      if (y > 70) {
        ASSERT_TRUE(std::isfinite(range)) << x << " " << y;
      }
    }
  }
  ASSERT_GT(count, 20);
  const vpe::core::Projected expected = vpe::core::project(request.view, peak * (planet->radius_m() + 15000));
  EXPECT_NEAR(x_sum / count, expected.xy.x, 4);
  EXPECT_GT(x_sum / count, 110);
}

TEST_F(Image, RollOfTheRightWingDownShowsMoreGroundOnTheRight) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation([](const glm::dvec3&) { return 0.0; }), 200000);
  DrawRequest request = test_support::request_for({10, 10, 20000, 70, -6, 30}, planet->radius_m(), 100, 100);
  const DrawResult result = renderer(planet)->draw(request);
  const auto sky_in_column = [&](int x) {
    int n = 0;
    for (int y = 0; y < 100; ++y) n += std::isinf(result.frame.range_m[static_cast<std::size_t>(y * 100 + x)]);
    return n;
  };
  EXPECT_GT(sky_in_column(5), sky_in_column(95) + 20);
}

TEST_F(Image, DoesNotDependOnHistory) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height), 60000);
  const DrawRequest a = test_support::request_for({5, 40, 100000, 30, -25, 0}, planet->radius_m(), 160, 100);
  const DrawRequest b =
      test_support::request_for({-100, -70, 20000, 130, -15, 20}, planet->radius_m(), 160, 100);
  const auto fresh = renderer(planet);
  const DrawResult first = fresh->draw(a);
  // A renderer with hardly any memory that has drawn another place.
  const auto used = renderer(planet, std::size_t{4} << 20);
  used->draw(b);
  used->draw(a);
  used->draw(b);
  const DrawResult again = fresh->draw(a);
  EXPECT_EQ(first.frame.colour, again.frame.colour);
  EXPECT_EQ(first.frame.range_m, again.frame.range_m);
  EXPECT_EQ(first.frame.range_m, used->draw(a).frame.range_m);
}

TEST_F(Image, PartsOfAnImageAreTheImage) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height), 60000);
  DrawRequest request = test_support::request_for({5, 40, 100000, 30, -25, 10}, planet->radius_m(), 160, 100);
  request.settings.lod_tolerance_px = 0;  // the same meshes for both
  const auto draw = renderer(planet);
  const DrawResult whole = draw->draw(request);
  request.view.part = {40, 30, 64, 32};
  const DrawResult part = draw->draw(request);
  ASSERT_EQ(part.frame.width, 64);
  int differ = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float p = part.frame.range_m[static_cast<std::size_t>(y * 64 + x)];
      const float w = whole.frame.range_m[static_cast<std::size_t>((y + 30) * 160 + x + 40)];
      differ += std::isinf(p) != std::isinf(w) || (std::isfinite(p) && std::abs(p - w) > 1e-3F * w);
    }
  }
  EXPECT_LE(differ, 4);
}

TEST_F(Image, ModesDrawWhatTheySay) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height), 100000);
  DrawRequest request = test_support::request_for({5, 40, 400000, 30, -60, 0}, planet->radius_m(), 64, 48);
  const auto draw = renderer(planet);
  std::vector<std::vector<vpe::base::Rgb>> images;
  for (const auto mode : {vpe::core::Mode::kWireframe, vpe::core::Mode::kUnlit, vpe::core::Mode::kLit,
                          vpe::core::Mode::kColoured}) {
    request.settings.mode = mode;
    images.push_back(draw->draw(request).frame.colour);
    for (std::size_t n = 0; n + 1 < images.size(); ++n) EXPECT_NE(images[n], images.back());
  }
  // Without an image, textured falls back to the colours.
  request.settings.mode = vpe::core::Mode::kTextured;
  EXPECT_EQ(draw->draw(request).frame.colour, images.back());
}

TEST_F(Image, NightIsDark) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation([](const glm::dvec3&) { return 0.0; }), 200000);
  DrawRequest request = test_support::request_for({0, 0, 2e6, 0, -90, 0}, planet->radius_m(), 32, 32, 20);
  const auto draw = renderer(planet);
  request.sun = {1, 0, 0};
  const int day = brightness(draw->draw(request).frame.colour[16 * 32 + 16]);
  request.sun = {-1, 0, 0};
  const int night = brightness(draw->draw(request).frame.colour[16 * 32 + 16]);
  EXPECT_GT(day, 2 * night);
}

// Texels on shared borders are equal from both sides, across cube edges and corners too.
TEST_F(Image, ShadingMeetsAtBorders) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height), 100000);
  const paging::TerrainShader shader(planet, std::size_t{64} << 20);
  paging::ShadingParams params;
  params.sun = glm::normalize(glm::dvec3(0.3, 0.5, 0.8));
  params.scale = std::make_shared<const vpe::core::ColourScale>(vpe::core::Appearance());
  const int level = planet->meta().finest_level;
  const int n = planet->meta().tile.intervals();
  const auto texel = [&](const paging::ShadedTile& tile, lod::Edge edge, int along) {
    const int last = tile.intervals;
    const int x = edge == lod::Edge::kWest ? 0 : edge == lod::Edge::kEast ? last : along;
    const int y = edge == lod::Edge::kSouth ? 0 : edge == lod::Edge::kNorth ? last : along;
    const std::size_t at = 4 * static_cast<std::size_t>(y * (last + 1) + x);
    return std::array<int, 3>{tile.texels[at], tile.texels[at + 1], tile.texels[at + 2]};
  };
  const int tiles = 1 << level;
  for (int f = 0; f < mars::kFaces; ++f) {
    for (const auto& [i, j] :
         {std::pair{0, 0}, {tiles - 1, tiles - 1}, {0, tiles - 1}, {tiles / 2, tiles / 3}}) {
      const lod::TileKey key{static_cast<mars::Face>(f), level, i, j};
      const paging::ShadedTile own = shader.shade(key, n, params);
      for (const lod::Edge edge : lod::kEdges) {
        const lod::Neighbour across = lod::neighbour(key, edge);
        const paging::ShadedTile other = shader.shade(across.key, n, params);
        for (int a = 1; a < n; ++a) {  // corners of the cube have three tiles: their normals may differ
          const auto p = texel(own, edge, a);
          const auto q = texel(other, across.edge, across.reversed ? n - a : a);
          for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(p[c], q[c], 1) << lod::to_string(key) << " " << a;
        }
      }
    }
  }
}

TEST_F(Image, RefusesWhatItCannotDraw) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height), 400000);
  const auto draw = renderer(planet);
  DrawRequest request = test_support::request_for({0, 0, 1e6, 0, -90, 0}, planet->radius_m(), 64, 64);
  request.view.fov_deg = 180;
  EXPECT_THROW(draw->draw(request), std::runtime_error);
  request.view.fov_deg = 60;
  request.view.projection = vpe::core::Projection::kCylinder;
  EXPECT_THROW(draw->draw(request), std::runtime_error);
  request.view.projection = vpe::core::Projection::kPerspective;
  request.view.camera.position_m.x = std::nan("");
  EXPECT_THROW(draw->draw(request), std::runtime_error);
}

}  // namespace
