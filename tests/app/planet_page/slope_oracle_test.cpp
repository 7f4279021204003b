// Slopes of a planet's finest level against those of gdaldem on the same posts.
//
// gdaldem takes gradients over three by three posts (Horn 1981), ground_statistics() those of cells of two by two. On waves of
// n posts the first are less by about (2 pi / n)^2 / 6 along the gradient, and as much again by the mean across it; the second by
// a quarter of that. With n of 40 and more the difference is below one percent.
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "lod/tree/posts.h"
#include "tests/app/support/app_fixture.h"
#include "vpe/app/planet/info/ground_statistics.h"

namespace app_test {
namespace {

class SlopeOracle : public AppTest {};

struct CloseDataset {
  void operator()(void* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;

// Returns the slopes of the posts of a tile in degrees by gdaldem, without its edges; posts are square cells of a plane.
std::vector<float> gdal_slopes(const lod::Posts& posts, double spacing_m) {
  const int side = posts.side();
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDataset* raster = memory->Create("", side, side, 1, GDT_Float64, nullptr);
  const Dataset owner(raster);
  double transform[6] = {0, spacing_m, 0, 0, 0, -spacing_m};
  raster->SetGeoTransform(transform);
  std::vector<double> heights_m;
  for (int j = side - 1; j >= 0; --j)
    for (int i = 0; i < side; ++i) heights_m.push_back(posts.at(i, j));
  EXPECT_EQ(raster->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, side, side, heights_m.data(), side, side,
                                               GDT_Float64, 0, 0, nullptr),
            CE_None);
  std::string format = "-of";
  std::string name = "MEM";
  char* words[] = {format.data(), name.data(), nullptr};
  GDALDEMProcessingOptions* options = GDALDEMProcessingOptionsNew(words, nullptr);
  const Dataset slopes(GDALDEMProcessing("", raster, "slope", nullptr, options, nullptr));
  GDALDEMProcessingOptionsFree(options);
  if (slopes == nullptr) throw std::runtime_error("gdaldem failed");
  std::vector<float> inner(static_cast<std::size_t>(side - 2) * static_cast<std::size_t>(side - 2));
  EXPECT_EQ(GDALRasterIO(GDALGetRasterBand(slopes.get(), 1), GF_Read, 1, 1, side - 2, side - 2, inner.data(),
                         side - 2, side - 2, GDT_Float32, 0, 0),
            CE_None);
  return inner;
}

TEST_F(SlopeOracle, PercentilesAreThoseOfGdaldem) {
  // Fine ground where a face of the cube is nearly flat and its posts nearly square: within 1.5 degrees of its middle.
  Dem base;
  base.height_m = [](int, int) { return 0.0; };
  write_dem(dir_ / "base.tif", base);
  Dem inset;
  inset.width = inset.height = 300;
  inset.west_deg = -1.5;
  inset.north_deg = 1.5;
  inset.cell_deg = 0.01;
  inset.height_m = [](int column, int row) {
    const double window = std::sin(std::numbers::pi * column / 300) * std::sin(std::numbers::pi * row / 300);
    return window * window *
           (900 * std::sin(0.06 * column) * std::cos(0.05 * row) + 250 * std::sin(0.08 * (column + row)));
  };
  write_dem(dir_ / "inset.tif", inset);
  const Result built = vpe(
      {"build", "base.tif", "inset.tif", "-o", "p.vpe", "--base-spacing", "100000", "--feather", "1000", "-q"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  const auto planet = paging::PlanetFile::open(dir_ / "p.vpe");
  vpe::base::ThreadPool pool(2);
  const vpe::app::GroundStatistics finest = vpe::app::ground_statistics(*planet, pool).back();
  ASSERT_EQ(finest.sampled_tiles, finest.tiles);

  std::vector<float> slopes_deg;
  for (const lod::TileInfo& tile : planet->tree().tiles()) {
    if (tile.key.level != finest.level) continue;
    const std::vector<float> some = gdal_slopes(planet->heights(tile.key).posts, finest.baseline_m);
    slopes_deg.insert(slopes_deg.end(), some.begin(), some.end());
  }
  ASSERT_GT(slopes_deg.size(), 100'000U);
  std::ranges::sort(slopes_deg);
  for (const double share : {0.9, 0.95, 0.99, 0.999}) {
    const double by_gdal = static_cast<double>(
        slopes_deg[static_cast<std::size_t>(share * static_cast<double>(slopes_deg.size()))]);
    EXPECT_NEAR(finest.slopes_deg.percentile(share), by_gdal, 0.005 + 0.01 * by_gdal) << share;
  }
}

}  // namespace
}  // namespace app_test
