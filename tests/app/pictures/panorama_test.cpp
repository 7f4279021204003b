// Panoramas of triangles: the same ground as by rays, and no seams.
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "panorama/open_panorama.h"
#include "panorama/plan.h"
#include "tests/app/support/app_fixture.h"
#include "tests/paging/rough_planet.h"
#include "vpe/core/frame.h"
#include "vpe/core/image.h"
#include "vpe/core/metrics.h"

namespace app_test {
namespace {

std::vector<float> read_range(const std::filesystem::path& path, std::int64_t width, std::int64_t height) {
  TIFFSetWarningHandler(nullptr);
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(path.c_str(), "r"), TIFFClose);
  if (tiff == nullptr) throw std::runtime_error("cannot open " + path.string());
  constexpr std::int64_t kTile = 256;
  std::vector<float> all(static_cast<std::size_t>(width * height));
  std::vector<float> tile(kTile * kTile);
  for (std::int64_t y = 0; y < height; y += kTile) {
    for (std::int64_t x = 0; x < width; x += kTile) {
      TIFFReadTile(tiff.get(), tile.data(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0);
      for (std::int64_t j = 0; j < std::min(kTile, height - y); ++j) {
        std::copy_n(tile.begin() + j * kTile, std::min(kTile, width - x), all.begin() + (y + j) * width + x);
      }
    }
  }
  // As frames have it.
  std::replace_if(
      all.begin(), all.end(), [](float r) { return std::isnan(r); }, vpe::core::kSkyRange);
  return all;
}

class PolygonPanorama : public AppTest {
 protected:
  void make(const std::string& output, const Words& more) const {
    make(planet().string(), "10,5", "4000", output, more);
  }
  void make(const std::string& planet, const std::string& at, const std::string& height,
            const std::string& output, const Words& more) const {
    Words words{"panorama", planet, "--at", at, "--height", height, "-o", output, "-q"};
    words.insert(words.end(), {"--elevation", "-25,12", "--planes", "range"});
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
};

TEST_F(PolygonPanorama, EightFacetsAgreeWithTheCylinderOfRays) {
  make("c.png", {"--width", "1000"});
  // Three times as many columns, so that the nearest pixel is near enough.
  make("f.png", {"--width", "3000", "--backend", "polygon", "--tolerance", "0.5"});
  const panorama::PanoramaMap map = panorama::describe(dir_ / "c.png").map;
  const panorama::PanoramaMap facets = panorama::describe(dir_ / "f.png").map;
  ASSERT_EQ(facets.kind, panorama::MapKind::kFacets);
  ASSERT_EQ(facets.facets, 8);
  const auto rays = read_range(dir_ / "c.range.tif", map.width_px, map.height_px);
  const auto triangles = read_range(dir_ / "f.range.tif", facets.width_px, facets.height_px);
  std::vector<float> reprojected(rays.size());
  // Facets are lower at their corners: the outermost rows of the cylinder may lie outside of them.
  std::vector<bool> is_there(rays.size());
  for (std::int64_t y = 0; y < map.height_px; ++y) {
    for (std::int64_t x = 0; x < map.width_px; ++x) {
      const auto n = static_cast<std::size_t>(y * map.width_px + x);
      const auto at =
          facets.to_pixel(map.to_direction(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5));
      is_there[n] = at.has_value();
      if (!at) {
        reprojected[n] = rays[n];
        continue;
      }
      const auto column = std::min(static_cast<std::int64_t>(at->x), facets.width_px - 1);
      const auto row = std::min(static_cast<std::int64_t>(at->y), facets.height_px - 1);
      reprojected[n] = triangles[static_cast<std::size_t>(row * facets.width_px + column)];
    }
  }
  const auto station = *panorama::describe(dir_ / "c.png").station;
  const panorama::Standpoint stand{{station.lon_deg, station.lat_deg, *station.alt_m, 0, 0, 0},
                                   mars::kMarsRadius_m};
  vpe::core::View view = panorama::pieces_of(map, stand, panorama::strips_of(map).front(), 0).front().view;
  view.part = {};
  std::vector<double> shift_px = vpe::core::backward_shift_px(view, reprojected, rays);
  for (std::size_t n = 0; n < shift_px.size(); ++n) {
    if (!is_there[n]) shift_px[n] = std::nan("");
  }
  const vpe::core::ShiftSummary summary = vpe::core::summarize(shift_px, static_cast<int>(map.width_px));
  EXPECT_GT(summary.pixels, 100000);
  EXPECT_LE(summary.share_over_1px, 0.005);
  EXPECT_GT(summary.median_px, 0);  // they are two pictures
  RecordProperty("share_over_1px", std::to_string(summary.share_over_1px));
  RecordProperty("median_px", std::to_string(summary.median_px));
}

// Mean difference between neighbouring columns, over all rows and channels.
double step_at(const vpe::core::RgbImage& image, int column) {
  const int before = (column + image.width - 1) % image.width;
  double sum = 0;
  for (int y = 0; y < image.height; ++y) {
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    const mars::Rgb a = image.pixels[row + static_cast<std::size_t>(before)];
    const mars::Rgb b = image.pixels[row + static_cast<std::size_t>(column % image.width)];
    sum += std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
  }
  return sum / (3.0 * image.height);
}

TEST_F(PolygonPanorama, SeamsAreNotSeen) {
  test_support::build_rough(dir_ / "rough.vpe");
  for (const Words& backend :
       {Words{"--backend", "polygon", "--tolerance", "0.5"}, Words{"--projection", "facets"}}) {
    Words more{"--width", "1600", "--set", "sun.elevation=15", "--set", "shading=flat"};
    more.insert(more.end(), backend.begin(), backend.end());
    make("rough.vpe", "-70,-11.1", "3000", "f.png", more);
    const vpe::core::RgbImage image = vpe::core::read_image(dir_ / "f.png");
    ASSERT_EQ(image.width, 1600);
    // The mean step of all seams, against those of the 30 columns about each.
    constexpr int kReach = 15;
    double seam = 0;
    double inside = 0;
    double largest = 0;
    for (int n = -kReach; n <= kReach; ++n) {
      double step = 0;
      for (int k = 0; k < 8; ++k) step += step_at(image, (200 * k + n + image.width) % image.width) / 8;
      if (n == 0) {
        seam = step;
      } else {
        inside += step / (2 * kReach);
        largest = std::max(largest, step);
      }
    }
    EXPECT_GT(inside, 0.5);  // there is something to see
    EXPECT_LE(seam, largest) << backend[1];
    EXPECT_LE(seam, 1.2 * inside) << backend[1];
    RecordProperty("largest_" + backend[1], std::to_string(largest));
    RecordProperty("seam_" + backend[1], std::to_string(seam));
    RecordProperty("inside_" + backend[1], std::to_string(inside));
  }
}

}  // namespace
}  // namespace app_test
