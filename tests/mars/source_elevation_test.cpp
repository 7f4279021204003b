#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <sstream>
#include <thread>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_raster.h"
#include "mars/sources/source.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using source_files::box;
using source_files::height_at;
using source_files::Raster;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// 36 x 18 pixels of 10 degrees.
Raster coarse_globe(double west) {
  Raster raster;
  raster.width = 36;
  raster.height = 18;
  raster.geotransform = box(west, 90, west + 360, -90, 36, 18);
  raster.value = [west](int, int column, int row) {
    const double lon = std::remainder(west + 10 * column, 360.0);
    return 100 * std::cos(lon / 40) + 7 * row + lon;
  };
  return raster;
}

class Globe : public ::testing::TestWithParam<double> {};

TEST_P(Globe, IsSeamlessWhereverItsColumnsStart) {
  const test_support::TempDir folder;
  const auto source = mars::open_elevation(source_files::write(folder / "g.tif", coarse_globe(GetParam())));
  const Raster same = coarse_globe(GetParam());
  const auto value = [&](int column, int row) { return same.value(1, (column % 36 + 36) % 36, row); };
  test_support::Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const mars::LonLat p{random.uniform(-180, 180), random.uniform(-84.9, 84.9)};
    const double x = (p.lon_deg - GetParam()) / 10 - 0.5;
    const double y = (90 - p.lat_deg) / 10 - 0.5;
    const int column = static_cast<int>(std::floor(x));
    const int row = static_cast<int>(std::floor(y));
    const double fx = x - column;
    const double fy = y - row;
    const double expected = (value(column, row) * (1 - fx) + value(column + 1, row) * fx) * (1 - fy) +
                            (value(column, row + 1) * (1 - fx) + value(column + 1, row + 1) * fx) * fy;
    EXPECT_NEAR(height_at(*source, p), expected, 1e-4) << p.lon_deg << " " << p.lat_deg;
  }
  EXPECT_EQ(height_at(*source, {180, 12}), height_at(*source, {-180, 12}));
  EXPECT_NEAR(height_at(*source, {-179.9999999, 12}), height_at(*source, {179.9999999, 12}), 1e-4);
  EXPECT_NEAR(height_at(*source, {-1e-8, 12}), height_at(*source, {1e-8, 12}), 1e-4);
}

TEST_P(Globe, HasOneValueAtEachPoleAndNoStepAroundIt) {
  const test_support::TempDir folder;
  const auto source = mars::open_elevation(source_files::write(folder / "g.tif", coarse_globe(GetParam())));
  const Raster same = coarse_globe(GetParam());
  for (const bool north : {true, false}) {
    double mean = 0;
    for (int column = 0; column < 36; ++column) mean += same.value(1, column, north ? 0 : 17) / 36;
    const double pole = north ? 90 : -90;
    for (int lon = -180; lon < 180; lon += 15) {
      const auto lon_deg = static_cast<double>(lon);
      EXPECT_NEAR(height_at(*source, {lon_deg, pole}), mean, 1e-4);
      EXPECT_NEAR(height_at(*source, {lon_deg, pole * (1 - 1e-9)}), mean, 1e-3);
      const double edge = north ? 85 : -85;
      EXPECT_NEAR(height_at(*source, {lon_deg, edge - 1e-9}), height_at(*source, {lon_deg, edge + 1e-9}), 1e-4);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(West, Globe, ::testing::Values(0.0, -180.0, -40.0, 100.0, 175.0));

TEST(GdalElevation, PolesOfGridRegisteredMaps) {
  // 0 and 360 both present, and rows on the poles themselves: the polar rows must not be blended twice.
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 37;
  raster.height = 19;
  raster.geotransform = box(-5, 95, 365, -95, 37, 19);
  raster.value = [](int, int column, int row) {
    return row == 0 ? 50.0 : row == 18 ? -50.0 : (column % 36) + 100.0 * row;
  };
  const auto source = mars::open_elevation(source_files::write(folder / "g.tif", raster));
  EXPECT_NEAR(height_at(*source, {33, 90}), 50, 1e-9);
  EXPECT_NEAR(height_at(*source, {-71, -90}), -50, 1e-9);
  EXPECT_NEAR(height_at(*source, {20, 85}), (50 + 102) / 2.0, 1e-6);
  EXPECT_NEAR(height_at(*source, {-5, 0}), 900 + 35.0 / 2, 1e-6);
}

// GDAL 3.6 reads them as unsigned and tells the sign in the metadata of the band.
TEST(GdalElevation, SignedBytes) {
  const test_support::TempDir folder;
  const auto stored = [](int column, int row) { return 10 * column - 10 * row; };
  Raster raster;
  raster.width = 8;
  raster.height = 8;
  raster.type = GDT_Byte;
  raster.options = {"PIXELTYPE=SIGNEDBYTE"};
  raster.geotransform = box(0, 8, 8, 0, 8, 8);
  raster.value = [&](int, int column, int row) { return (stored(column, row) + 256) % 256; };
  for (const double nodata : {-40.0, 216.0}) {
    raster.nodata = nodata;
    const std::string path = source_files::write(folder / "s.tif", raster);
    const auto source = mars::open_elevation(path);
    for (int row = 0; row < 8; ++row) {
      for (int column = 0; column < 8; ++column) {
        const double height_m = height_at(*source, {column + 0.5, 7.5 - row});
        if (stored(column, row) == -40) {
          EXPECT_TRUE(std::isnan(height_m)) << height_m;
        } else {
          EXPECT_NEAR(height_m, stored(column, row), 1e-9) << column << " " << row;
        }
      }
    }
  }
}

TEST(GdalElevation, LinearPathAgreesWithProj) {
  const test_support::TempDir folder;
  test_support::Random random(31);
  for (const char* crs :
       {"+proj=longlat +R=3396190", "IAU_2015:49900", "IAU_2015:49901", "IAU_2015:49902", "IAU_2015:49910",
        "IAU_2015:49911", "IAU_2015:49912", "IAU_2015:49915", "EPSG:4326", "EPSG:32662",
        "+proj=eqc +lat_ts=-35 +lon_0=137.31 +x_0=1000 +y_0=-500 +R=3396190 +units=km",
        "GEOGCS[\"Mars in "
        "grads\",DATUM[\"D\",SPHEROID[\"S\",3396190,0]],PRIMEM[\"Airy\",0],UNIT[\"grad\",0.01570796326794897]"
        "]"}) {
    // Some part of any of these maps, the second one turned and sheared.
    for (const auto& g :
         {std::array<double, 6>{3, 0.5, 0, 20, 0, -0.4}, std::array<double, 6>{3, 0.5, 0.1, 20, -0.2, -0.4}}) {
      // A VRT keeps any CRS; GeoTIFF cannot say planetocentric on an ellipsoid.
      std::ostringstream text;
      text << "<VRTDataset rasterXSize=\"60\" rasterYSize=\"40\"><SRS>" << crs << "</SRS><GeoTransform>" << g[0]
           << "," << g[1] << "," << g[2] << "," << g[3] << "," << g[4] << "," << g[5]
           << "</GeoTransform><VRTRasterBand dataType=\"Byte\" band=\"1\"/></VRTDataset>";
      source_files::write_text(folder / "l.vrt", text.str());
      const mars::GdalRaster opened((folder / "l.vrt").string());
      const mars::Georeference& reference = opened.georeference();
      // PROJ takes planetocentric latitudes on an ellipsoid through planetographic ones: no linear map.
      EXPECT_EQ(reference.is_linear(), std::string(crs) != "IAU_2015:49912") << crs;
      std::vector<glm::dvec3> directions;
      for (int i = 0; i < 500; ++i) directions.push_back(random.direction());
      std::vector<glm::dvec2> fast(directions.size());
      std::vector<glm::dvec2> proj(directions.size());
      reference.to_pixels(directions, fast);
      reference.to_pixels_by_proj(directions, proj);
      const double period = g[1] == 0.5 && g[2] == 0 ? opened.grid().period : 0;
      for (std::size_t i = 0; i < directions.size(); ++i) {
        glm::dvec2 off = fast[i] - proj[i];
        // PROJ returns longitudes to its own range.
        if (period > 0) off.x = std::remainder(off.x, period);
        if (period == 0 && std::max(std::abs(off.x), std::abs(off.y)) > 1) continue;
        EXPECT_LE(glm::length(off), 1.5 * mars::Georeference::kLinearError_px) << crs << " " << i;
      }
      std::vector<glm::dvec3> back(fast.size());
      reference.to_directions(fast, back);
      for (std::size_t i = 0; i < back.size(); ++i)
        EXPECT_LE(glm::distance(back[i], directions[i]), 1e-12) << crs;
    }
  }
}

TEST(GdalElevation, LatitudesOfAnEllipsoidAreItsOwn) {
  // facts: 45 degrees planetographic is 44.66177 planetocentric on Mars.
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 10;
  raster.height = 10;
  raster.type = GDT_Float64;
  raster.value = [](int, int, int row) { return static_cast<double>(row); };
  raster.geotransform = box(10, 50, 20, 40, 10, 10);
  raster.crs =
      "GEOGCS[\"Mars 2000\",DATUM[\"D_Mars_2000\",SPHEROID[\"Mars_2000_IAU_IAG\",3396190,169.8944472236118]],"
      "PRIMEM[\"Reference_Meridian\",0],UNIT[\"Degree\",0.0174532925199433]]";
  const auto graphic = mars::open_elevation(source_files::write(folder / "graphic.tif", raster));
  EXPECT_NEAR(height_at(*graphic, {15, 44.66177}), 4.5, 1e-5);
  raster.crs = "+proj=longlat +R=3396190";
  const auto centric = mars::open_elevation(source_files::write(folder / "centric.tif", raster));
  EXPECT_NEAR(height_at(*centric, {15, 45}), 4.5, 1e-9);
}

TEST(GdalElevation, AnyBodyAndDatumNameOpens) {
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 8;
  raster.height = 8;
  raster.value = [](int, int column, int row) { return column + 10.0 * row; };
  raster.geotransform = box(0, 8, 8, 0, 8, 8);
  for (const char* crs :
       {"EPSG:4326", "+proj=longlat +R=1737400", "+proj=longlat +R=3396000",
        "GEOGCS[\"x\",DATUM[\"Planet "
        "nine\",SPHEROID[\"s\",5e6,0]],PRIMEM[\"m\",0],UNIT[\"degree\",0.0174532925199433]]"}) {
    raster.crs = crs;
    const auto source = mars::open_elevation(source_files::write(folder / "b.tif", raster));
    EXPECT_NEAR(height_at(*source, {2.5, 5.5}), 22, crs == std::string("EPSG:4326") ? 0.4 : 1e-9) << crs;
  }
}

TEST(GdalElevation, RegionalEdgeReachesHalfAPixelBeyondTheOuterCentres) {
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 4;
  raster.height = 3;
  raster.value = [](int, int column, int row) { return column + 10.0 * row; };
  raster.geotransform = box(178, 3, 182, 0, 4, 3);  // across the antimeridian
  const auto source = mars::open_elevation(source_files::write(folder / "e.tif", raster));
  EXPECT_NEAR(height_at(*source, {178.0001, 2.5}), 0, 1e-9);
  EXPECT_NEAR(height_at(*source, {178.25, 2.9}), 0, 1e-9);
  EXPECT_NEAR(height_at(*source, {-178.0001, 0.1}), 23, 1e-9);
  EXPECT_NEAR(height_at(*source, {180, 1.5}), 11.5, 1e-9);
  EXPECT_TRUE(std::isnan(height_at(*source, {177.9999, 2.5})));
  EXPECT_TRUE(std::isnan(height_at(*source, {-177.9999, 2.5})));
  EXPECT_TRUE(std::isnan(height_at(*source, {180, 3.0001})));
  EXPECT_TRUE(std::isnan(height_at(*source, {180, -0.0001})));
  EXPECT_TRUE(std::isnan(height_at(*source, {0, 1})));
}

TEST(GdalElevation, RotatedAndSouthUpRasters) {
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 6;
  raster.height = 5;
  raster.type = GDT_Float64;
  raster.value = [](int, int column, int row) { return column + 100.0 * row; };
  for (const auto& g :
       {std::array<double, 6>{10, 1, 0, 5, 0, 1}, std::array<double, 6>{40, -1, 0, 5, 0, -1},
        std::array<double, 6>{10, 0.8, 0.6, 5, 0.6, -0.8}, std::array<double, 6>{10, 0, 2, 5, 1, 0}}) {
    raster.geotransform = g;
    const auto source = mars::open_elevation(source_files::write(folder / "t.tif", raster));
    for (const auto& [column, row] : {std::pair{0.0, 0.0}, {2.25, 3.5}, {5.0, 4.0}}) {
      const double lon = g[0] + (column + 0.5) * g[1] + (row + 0.5) * g[2];
      const double lat = g[3] + (column + 0.5) * g[4] + (row + 0.5) * g[5];
      EXPECT_NEAR(height_at(*source, {lon, lat}), column + 100 * row, 1e-6);
    }
  }
}

TEST(GdalElevation, NodataNaNAndInfinityLeaveTheValidNeighbours) {
  const test_support::TempDir folder;
  for (const double nodata : {-9999.0, kNaN, std::numeric_limits<double>::infinity(), -3.4028226e38}) {
    Raster raster;
    raster.width = 4;
    raster.height = 4;
    raster.geotransform = box(0, 4, 4, 0, 4, 4);
    raster.nodata = -9999;
    raster.value = [&](int, int column, int row) {
      return column == 1 && row == 1 ? nodata : 10.0 * column + row;
    };
    const auto source = mars::open_elevation(source_files::write(folder / "h.tif", raster));
    EXPECT_TRUE(std::isnan(height_at(*source, {1.5, 2.5}))) << nodata;
    EXPECT_TRUE(std::isnan(height_at(*source, {1.9, 2.4}))) << nodata;
    EXPECT_NEAR(height_at(*source, {0.5, 3.5}), 0, 1e-9) << nodata;
    // A quarter of a pixel from (2, 1) towards the hole: the hole's quarter is left out.
    EXPECT_NEAR(height_at(*source, {2.25, 2.5}), 21, 1e-9) << nodata;
    // Amid (0, 0), (1, 0), (0, 1) and the hole, nearest to the first.
    EXPECT_NEAR(height_at(*source, {0.9, 3.1}), (0.36 * 0 + 0.24 * 10 + 0.24 * 1) / 0.84, 1e-9) << nodata;
    std::vector<glm::dvec3> places{mars::direction({1.5, 2.5}), mars::direction({0.5, 3.5}),
                                   mars::direction({90, 0})};
    std::vector<int> origin(3);
    source->origin(places, origin);
    EXPECT_EQ(origin, (std::vector<int>{-1, 0, -1}));
    int posts = 0;
    source->visit_posts(1000, [&](std::span<const glm::dvec3>, std::span<const double> heights_m) {
      posts += static_cast<int>(heights_m.size());
    });
    EXPECT_EQ(posts, 15);
  }
}

TEST(GdalElevation, ScaleOffsetUnitAndQuantum) {
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 2;
  raster.height = 2;
  raster.geotransform = box(0, 2, 2, 0, 2, 2);
  raster.value = [](int, int column, int) { return column == 0 ? 40000.0 : 0.0; };
  raster.type = GDT_UInt16;
  raster.scale = 0.25;
  raster.offset = -8000;
  const auto polar = mars::open_elevation(source_files::write(folder / "s.tif", raster));
  EXPECT_NEAR(height_at(*polar, {0.5, 0.5}), 2000, 1e-9);
  EXPECT_NEAR(height_at(*polar, {1.5, 0.5}), -8000, 1e-9);
  EXPECT_EQ(polar->infos().at(0).quantum_m, 0.25);
  EXPECT_EQ(polar->infos().at(0).datum, mars::VerticalDatum{});

  raster.type = GDT_Float64;
  raster.scale.reset();
  raster.offset.reset();
  raster.unit = "km";
  raster.value = [](int, int, int) { return 3389.123456789; };
  const auto radius = mars::open_elevation(source_files::write(folder / "r.tif", raster));
  EXPECT_NEAR(height_at(*radius, {1, 1}), 3389123.456789, 1e-8);
  EXPECT_EQ(radius->infos().at(0).quantum_m, 0.0);
  EXPECT_EQ(radius->infos().at(0).datum, mars::VerticalDatum::radius());
}

TEST(GdalElevation, EveryIntegerTypeKeepsItsDigits) {
  const test_support::TempDir folder;
  for (const auto& [type, value] : {std::pair{GDT_Byte, 201.0},
                                    {GDT_Int16, -32767.0},
                                    {GDT_UInt16, 65534.0},
                                    {GDT_Int32, 16777217.0},
                                    {GDT_UInt32, 4294967293.0},
                                    {GDT_Int64, 1099511627777.0}}) {
    Raster raster;
    raster.width = 1;
    raster.height = 1;
    raster.type = type;
    raster.geotransform = box(0, 1, 1, 0, 1, 1);
    raster.value = [v = value](int, int, int) { return v; };
    const auto source = mars::open_elevation(source_files::write(folder / "i.tif", raster));
    EXPECT_EQ(height_at(*source, {0.5, 0.5}), value) << GDALGetDataTypeName(type);
    EXPECT_EQ(height_at(*source, {0.01, 0.99}), value);
  }
}

TEST(GdalElevation, TilesAndBatchesDoNotShow) {
  // Larger than a tile both ways, compressed in stripes that do not match.
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 700;
  raster.height = 600;
  raster.type = GDT_Int16;
  raster.geotransform = box(20, 40, 90, -20, 700, 600);
  raster.options = {"COMPRESS=DEFLATE", "BLOCKYSIZE=7"};
  raster.value = [](int, int column, int row) { return (column * 7919 + row * 104729) % 20011 - 10000; };
  const auto source = mars::open_elevation(source_files::write(folder / "t.tif", raster));
  test_support::Random random(8);
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 5000; ++i) {
    directions.push_back(mars::direction({random.uniform(19, 91), random.uniform(-21, 41)}));
  }
  // At the centres of the pixels beside every tile border: the values themselves.
  std::vector<double> expected;
  for (const int column : {0, 255, 256, 257, 511, 512, 699}) {
    for (const int row : {0, 255, 256, 257, 511, 512, 599}) {
      directions.push_back(mars::direction({20 + (column + 0.5) / 10, 40 - (row + 0.5) / 10}));
      expected.push_back(raster.value(1, column, row));
    }
  }
  std::vector<double> together(directions.size());
  source->sample(directions, 1, together);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(together[5000 + i], expected[i], 1e-5);
  for (std::size_t i = 0; i < directions.size(); i += 7) {
    double alone = 0;
    source->sample({&directions[i], 1}, 1000, {&alone, 1});
    EXPECT_TRUE(alone == together[i] || (std::isnan(alone) && std::isnan(together[i])));
  }
}

TEST(GdalElevation, VisitsARegularSubsetOfItsPosts) {
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 300;
  raster.height = 200;
  raster.geotransform = box(0, 20, 30, 0, 300, 200);
  raster.value = [](int, int column, int row) { return column * 1000.0 + row; };
  const auto source = mars::open_elevation(source_files::write(folder / "v.tif", raster));
  for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{100}, std::size_t{5000},
                                 std::size_t{60000}, std::size_t{1000000}}) {
    std::size_t count = 0;
    source->visit_posts(most, [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
      ASSERT_EQ(directions.size(), heights_m.size());
      for (std::size_t i = 0; i < directions.size(); ++i) {
        const mars::LonLat p = mars::lon_lat(directions[i]);
        EXPECT_NEAR(std::floor(p.lon_deg * 10) * 1000 + std::floor((20 - p.lat_deg) * 10), heights_m[i], 1e-9);
      }
      count += directions.size();
    });
    EXPECT_LE(count, most + 400);
    EXPECT_GE(count, std::min<std::size_t>(most / 2, 60000)) << most;
  }
}

TEST(GdalElevation, SpacingNeverMissesData) {
  const test_support::TempDir folder;
  test_support::Random random(77);
  struct Case {
    const char* crs;
    std::array<double, 6> geotransform;
  };
  for (const Case& c :
       {Case{"+proj=longlat +R=3396190", box(130, 10, 140, -10, 50, 50)},
        Case{"+proj=longlat +R=3396190", box(170, 90, 215, 60, 50, 50)},
        Case{"+proj=stere +lat_0=-90 +lat_ts=-90 +R=3396190", box(-1e6, 1e6, 1e6, -1e6, 50, 50)},
        Case{"+proj=sinu +lon_0=0 +R=3396190", box(-1.06e7, 5.33e6, 1.06e7, -5.33e6, 50, 50)},
        Case{"+proj=eqc +lon_0=0 +R=3396190", box(8142406, -276455, 8142754, -276792, 50, 50)}}) {
    Raster raster;
    raster.width = 50;
    raster.height = 50;
    raster.crs = c.crs;
    raster.geotransform = c.geotransform;
    const auto source = mars::open_elevation(source_files::write(folder / "s.tif", raster));
    std::vector<glm::dvec3> posts;
    source->visit_posts(2500, [&](std::span<const glm::dvec3> directions, std::span<const double>) {
      posts.insert(posts.end(), directions.begin(), directions.end());
    });
    ASSERT_GT(posts.size(), 1000U);
    const double own_m = source->infos().at(0).resolution_m;
    for (const glm::dvec3& post : posts) EXPECT_EQ(source->spacing_in({post, 0}), own_m);
    int away = 0;
    for (int i = 0; i < 1000; ++i) {
      const mars::Cap cap{random.direction(), random.log_uniform(1e-6, 3)};
      double nearest = 4;
      for (const glm::dvec3& post : posts)
        nearest = std::min(nearest, mars::angle_between_rad(post, cap.centre));
      const double spacing_m = source->spacing_in(cap);
      if (nearest <= cap.radius_rad) {
        EXPECT_EQ(spacing_m, own_m);
      }
      if (std::isinf(spacing_m)) ++away;
      // Not lazily large either.
      if (nearest > cap.radius_rad + 0.3) {
        EXPECT_TRUE(std::isinf(spacing_m)) << c.crs << " " << nearest;
      }
    }
    if (std::string(c.crs).find("sinu") == std::string::npos) {
      EXPECT_GT(away, 300) << c.crs;
    }
  }
}

TEST(GdalElevation, ThreadsGetTheSameBitsAndMayDieFirst) {
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 1500;
  raster.height = 900;
  raster.crs = "+proj=sinu +lon_0=20 +R=3396190";
  raster.geotransform = box(-3e6, 2e6, 3e6, -1.6e6, 1500, 900);
  raster.options = {"COMPRESS=DEFLATE", "TILED=YES"};
  raster.value = [](int, int column, int row) { return (column * 31 + row * 17) % 4001; };
  const std::string path = source_files::write(folder / "p.tif", raster);
  test_support::Random random(6);
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 20000; ++i) {
    directions.push_back(mars::direction({random.uniform(-30, 70), random.uniform(-27, 33)}));
  }
  std::vector<double> expected(directions.size());
  mars::open_elevation(path)->sample(directions, 1, expected);

  auto source = mars::open_elevation(path);
  std::vector<std::vector<double>> results(8, std::vector<double>(directions.size()));
  for (int round = 0; round < 2; ++round) {  // threads of the first round die before those of the second start
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < results.size(); ++t) {
      threads.emplace_back([&, t] {
        const std::size_t half = directions.size() / 2;
        const std::size_t start = t % 2 == 0 ? 0 : half;
        const auto part = [&](std::size_t from, std::size_t to) {
          source->sample(std::span(directions).subspan(from, to - from), 1,
                         std::span(results[t]).subspan(from, to - from));
        };
        part(start, start + half);
        part(half - start, directions.size() - start);
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (const auto& result : results) {
      EXPECT_TRUE(std::equal(result.begin(), result.end(), expected.begin(),
                             [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
    }
  }
  // The source dies in another thread than the one that used it.
  std::thread([dying = std::move(source)]() mutable { dying.reset(); }).join();
}

TEST(GdalElevation, ReadsSideFilesAndWritesNone) {
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 4;
  raster.height = 2;
  raster.type = GDT_Byte;
  raster.value = [](int, int column, int) { return 10.0 * column; };
  GDALAllRegister();
  raster.geotransform = box(0, 2, 4, 0, 4, 2);
  const std::string tif = source_files::write(folder / "a.tif", raster);
  GDALDataset* from = GDALDataset::FromHandle(GDALOpen(tif.c_str(), GA_ReadOnly));
  GDALClose(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy((folder / "b.png").c_str(), from, FALSE,
                                                                       nullptr, nullptr, nullptr));
  GDALClose(from);
  ASSERT_TRUE(std::filesystem::exists(folder / "b.png.aux.xml"));
  const auto list = [&] {
    std::vector<std::pair<std::string, std::filesystem::file_time_type>> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      files.emplace_back(entry.path().string(), entry.last_write_time());
    }
    std::sort(files.begin(), files.end());
    return files;
  };
  const auto before = list();
  {
    const auto source = mars::open_elevation((folder / "b.png").string());
    EXPECT_NEAR(height_at(*source, {2.5, 0.5}), 20, 1e-9);
    const auto image = mars::open_image((folder / "b.png").string());
    source->visit_posts(100, [](auto, auto) {});
  }
  EXPECT_EQ(list(), before);
}

}  // namespace
