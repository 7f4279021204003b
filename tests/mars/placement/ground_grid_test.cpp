// The parts of a placement: GDAL's transformer, metres of units, the grid, and what is read of a dataset.
#include "mars/raster/placement/ground_grid.h"

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/placement/placement.h"
#include "tests/mars/placement/placed_files.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using mars::GdalScope;

constexpr double kDegree_m = 3396190 * mars::kRadiansPerDegree;

OGRSpatialReference system(const std::string& text) {
  OGRSpatialReference crs;
  EXPECT_EQ(crs.SetFromUserInput(text.c_str()), OGRERR_NONE);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

class GroundGrid : public ::testing::Test {
 protected:
  using Handle = std::unique_ptr<GDALDataset, void (*)(GDALDataset*)>;

  // Opens a raster of 100 x 50 pixels whose corners lie at the given place and `width_deg` east of it.
  Handle open(double west_deg, double north_deg, double width_deg, double height_deg) const {
    const std::string path = source_files::write(folder_ / "g.tif", placed_files::numbers(100, 50, false));
    placed_files::set_points(path,
                             {{{0, 0}, {west_deg, north_deg}},
                              {{100, 0}, {west_deg + width_deg, north_deg}},
                              {{0, 50}, {west_deg, north_deg - height_deg}},
                              {{100, 50}, {west_deg + width_deg, north_deg - height_deg}}},
                             source_files::kSphere);
    return {GDALDataset::FromHandle(GDALOpen(path.c_str(), GA_ReadOnly)), [](GDALDataset* d) { GDALClose(d); }};
  }

  const std::vector<std::string> options_{"METHOD=GCP_POLYNOMIAL", "MAX_GCP_ORDER=1"};
  test_support::TempDir folder_;
};

TEST_F(GroundGrid, TheMapperGoesBothWays) {
  const GdalScope scope;
  const Handle dataset = open(30, 10, 2, 1);
  mars::PixelMapper mapper("g.tif", *dataset, options_);
  std::vector<glm::dvec2> points{{0, 0}, {100, 50}, {25, 40}, {std::nan(""), 0}};
  mapper.to_ground(points);
  EXPECT_NEAR(points[0].x, 30, 1e-9);
  EXPECT_NEAR(points[1].y, 9, 1e-9);
  EXPECT_NEAR(points[2].x, 30.5, 1e-9);
  EXPECT_NEAR(points[2].y, 9.2, 1e-9);
  EXPECT_TRUE(std::isnan(points[3].x));
  mapper.to_pixels(points);
  EXPECT_NEAR(points[2].x, 25, 1e-6);
  EXPECT_NEAR(points[2].y, 40, 1e-6);
  void* released = mapper.release();
  EXPECT_NE(released, nullptr);
  EXPECT_EQ(mapper.release(), nullptr);
  GDALDestroyGenImgProjTransformer(released);
  EXPECT_THROW(mars::PixelMapper("g.tif", *dataset, {"METHOD=RPC"}), mars::SourceError);
}

TEST_F(GroundGrid, UnitsInMetres) {
  const std::vector<glm::dvec2> places{{200, 60}};
  const mars::GroundUnits degrees(system(source_files::kSphere), places);
  EXPECT_EQ(degrees.latitude(), 1);
  EXPECT_NEAR(degrees.metres({200, 60}).x, kDegree_m / 2, 1e-6);
  EXPECT_NEAR(degrees.metres({200, 60}).y, kDegree_m, 1e-6);
  // The first coordinate alone can be a latitude.
  const std::vector<glm::dvec2> exchanged{{60, 200}};
  EXPECT_EQ(mars::GroundUnits(system(source_files::kSphere), exchanged).latitude(), 1);
  EXPECT_EQ(mars::GroundUnits(system("IAU_2015:49901"), exchanged).latitude(), 0);
  EXPECT_EQ(mars::GroundUnits(system("IAU_2015:49901"), places).latitude(), 1);
  const mars::GroundUnits km(system("+proj=eqc +R=3396190 +units=km +no_defs"), places);
  EXPECT_EQ(km.latitude(), -1);
  EXPECT_NEAR(km.metres({1, 2}).x, 1000, 1e-9);
  EXPECT_NEAR(km.metres({1, 2}).y, 1000, 1e-9);
}

TEST_F(GroundGrid, PixelsAreAsLargeAsTheRasters) {
  const GdalScope scope;
  // At 60 degrees a hundredth of a degree of longitude is half as long as one of latitude.
  const Handle dataset = open(30, 60.25, 2, 0.5);
  const mars::PixelMapper mapper("g.tif", *dataset, options_);
  const mars::GroundGrid grid =
      mars::choose_grid("g.tif", mapper, 100, 50, system(source_files::kSphere), "advice");
  EXPECT_NEAR(grid.pixel_m, 0.01 * kDegree_m, 0.01 * 0.01 * kDegree_m);
  EXPECT_NEAR(grid.to_ground[1], 0.02, 2e-4);
  EXPECT_NEAR(grid.to_ground[5], -0.01, 1e-4);
  EXPECT_LE(grid.to_ground[0], 30);
  EXPECT_GE(grid.to_ground[3], 60.25);
  EXPECT_GE(grid.to_ground[0] + grid.width * grid.to_ground[1], 32);
  EXPECT_LE(grid.to_ground[3] + grid.height * grid.to_ground[5], 59.75);
  EXPECT_LE(grid.width, 105);
  EXPECT_LE(grid.height, 55);
}

TEST_F(GroundGrid, NothingLiesBeyondAPole) {
  const GdalScope scope;
  const Handle dataset = open(30, 90.2, 2, 0.5);
  const mars::PixelMapper mapper("g.tif", *dataset, options_);
  try {
    mars::choose_grid("g.tif", mapper, 100, 50, system(source_files::kSphere), "advice");
    ADD_FAILURE();
  } catch (const mars::SourceError& e) {
    EXPECT_NE(
        std::string(e.what()).find("g.tif: its placement in longitude and latitude reaches beyond a pole"),
        std::string::npos)
        << e.what();
  }
}

TEST_F(GroundGrid, APlacementSaysWhatItIs) {
  const GdalScope scope;
  const Handle dataset = open(30, 10, 2, 1);
  const mars::ControlPoints points = mars::control_points("g.tif", *dataset, mars::GcpMethod::kByCount);
  EXPECT_EQ(points.points.size(), 4U);
  EXPECT_FALSE(points.is_spline);
  EXPECT_EQ(points.treatment(), "placed by its control points, polynomial of order 1");
  EXPECT_TRUE(
      points.note(100).starts_with("placed by its 4 control points with a polynomial of order 1; they lie"));
  const auto placement = mars::find_placement("g.tif", *dataset, {}, false);
  ASSERT_NE(placement, nullptr);
  EXPECT_EQ(placement->treatment(), points.treatment());
  EXPECT_EQ(placement->notes().size(), 1U);
  EXPECT_TRUE(placement->files().empty());
  const std::string plain = source_files::write(folder_ / "plain.tif", placed_files::numbers(8, 8, false));
  const Handle other(GDALDataset::FromHandle(GDALOpen(plain.c_str(), GA_ReadOnly)),
                     [](GDALDataset* d) { GDALClose(d); });
  EXPECT_EQ(mars::find_placement(plain, *other, {}, false), nullptr);
}

}  // namespace
