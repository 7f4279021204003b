// Colours of tiles that are small in the image: those of posts as far apart as pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <optional>

#include "tests/gl/gl_fixture.h"
#include "vpe/gl/tile_needs.h"

namespace {

namespace core = vpe::core;
namespace gl = vpe::gl;
using test_support::bumpy_height;
using test_support::FakeElevation;

constexpr int kWidth = 128;
constexpr int kHeight = 96;
const glm::dvec3 kMiddle = glm::normalize(glm::dvec3(0.3, -0.5, 1));

// Rough down to the finest posts.
double rough_height(const glm::dvec3& d) {
  return bumpy_height(d) + 250 * std::sin(2300 * d.x) * std::sin(1900 * d.y) * std::sin(2100 * d.z);
}

class SmallTextures : public test_support::GlTest {
 protected:
  std::shared_ptr<const paging::PlanetFile> planet(const FakeElevation::Height& height) {
    return test_support::build_fake(
        dir_ / "p.vpe", FakeElevation(height, test_support::fine_around(kMiddle, 0.08, 1200)), 200000);
  }
  static core::DrawRequest request(double height_m, double pitch_deg, double tolerance_px) {
    const mars::LonLat place = mars::lon_lat(kMiddle);
    core::DrawRequest out = test_support::request_for(
        {place.lon_deg, place.lat_deg, height_m, 40, pitch_deg, 10}, mars::kMarsRadius_m, kWidth, kHeight, 30);
    out.settings.mode = core::Mode::kLit;
    out.settings.background = core::Background::kBlack;
    out.settings.smooth_edges = false;
    out.settings.lod_tolerance_px = tolerance_px;
    return out;
  }
  // Returns the root of the mean square by which an image differs from colours of the width of a pixel, where it shows
  // ground.
  double rms(const paging::TerrainShader& shader, core::Renderer& draw, const core::DrawRequest& asked) {
    const core::DrawResult result = draw.draw(asked);
    const paging::ShadingParams params = paging::shading_params(asked.settings, asked.sun, false, nullptr);
    paging::TerrainShader::Cursor cursor;
    double sum = 0;
    int pixels = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto at = static_cast<std::size_t>(y * kWidth + x);
        const double range_m = static_cast<double>(result.frame.range_m[at]);
        if (std::isinf(range_m)) continue;
        const glm::dvec3 place =
            asked.view.camera.position_m + range_m * core::pixel_ray(asked.view, x + 0.5, y + 0.5);
        const auto wanted =
            shader.colour_at(glm::normalize(place), range_m / core::focal_px(asked.view), params, cursor);
        if (!wanted) continue;
        const double off = std::clamp(wanted->x, 0.0, 255.0) - result.frame.colour[at].r;
        sum += off * off;
        ++pixels;
      }
    }
    EXPECT_GT(pixels, kWidth * kHeight / 2);
    return std::sqrt(sum / pixels);
  }
};

TEST_F(SmallTextures, HaveTheColoursOfAPixelsWidth) {
  const auto file = planet(rough_height);
  const paging::TerrainShader shader(file, std::size_t{64} << 20);
  const auto draw = renderer(file);
  for (const double height_m : {150e3, 600e3, 3000e3}) {
    // Here 0.4; with a texel for each post 3.2 and 1.9 from the two greater heights.
    const double fine = rms(shader, *draw, request(height_m, -80, 0.01));
    std::printf("from %.0f km: %.2f steps of colour\n", height_m / 1000, fine);
    EXPECT_LT(fine, 1);
  }
}

TEST_F(SmallTextures, HaveATexelAPixelUnlessPostsAreCoarser) {
  const auto file = planet(rough_height);
  const paging::TerrainShader shader(file, std::size_t{64} << 20);
  const core::DrawRequest asked = request(600e3, -80, 1);
  gl::NeedOptions options;
  options.material = gl::material(asked.settings, asked.sun, false, nullptr);
  options.texture_bytes = std::size_t{1} << 30;
  const int posts = file->meta().tile.intervals();
  int coarse = 0;
  for (const lod::TileInfo& info : file->tree().tiles()) {
    for (const double distance_m : {1e3, 1e5, 3e6}) {
      lod::SelectedTile tile;
      tile.key = info.key;
      tile.min_distance_m = distance_m;
      const int texels = gl::tile_needs({&tile, 1}, asked.view, *file, shader, options).front().texture;
      const double side_px =
          lod::nominal_side_m(info.key.level, file->radius_m()) * core::focal_px(asked.view) / distance_m;
      if (texels >= posts) continue;
      ++coarse;
      EXPECT_GE(texels, side_px) << lod::to_string(info.key);
      EXPECT_GE(texels << info.key.level, posts) << "no tile is above level 0";
      // Those of tiles above level 5 are interpolated once more, and finer.
      EXPECT_LT(texels,
                std::max((info.key.level < 5 ? 4 : 2) * side_px, 1.0 + std::max(1, posts >> info.key.level)))
          << lod::to_string(info.key);
    }
  }
  EXPECT_GT(coarse, 20);
}

// Stripes show which posts have no data, as finely as the tile has them.
TEST_F(SmallTextures, AreAsFineAsPostsWhereDataLacks) {
  const auto file = planet(
      [](const glm::dvec3& d) { return glm::length(d - kMiddle) < 0.01 ? std::nan("") : rough_height(d); });
  const paging::TerrainShader shader(file, std::size_t{64} << 20);
  const core::DrawRequest asked = request(600e3, -80, 1);
  gl::NeedOptions options;
  options.material = gl::material(asked.settings, asked.sun, false, nullptr);
  options.texture_bytes = std::size_t{1} << 30;
  int without = 0;
  for (const lod::TileInfo& info : file->tree().tiles()) {
    if (!file->has_nodata(info.key)) continue;
    lod::SelectedTile tile;
    tile.key = info.key;
    tile.min_distance_m = 1e7;
    EXPECT_GE(gl::tile_needs({&tile, 1}, asked.view, *file, shader, options).front().texture,
              file->meta().tile.intervals());
    ++without;
  }
  EXPECT_GT(without, 2);
}

}  // namespace
