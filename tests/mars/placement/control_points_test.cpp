// Rasters that only control points place, against the maps that made the points, and against gdaltransform.
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/placed_sources.h"
#include "tests/mars/placement/placed_files.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using placed_files::Point;
using source_files::height_at;
using Map = std::function<glm::dvec2(const glm::dvec2& ground)>;  // to pixels

constexpr int kWidth = 240;
constexpr int kHeight = 180;
constexpr double kMost_px = 0.05;

// A turned and sheared map with pixels of about a hundredth of a degree, about 137 E, 5 S.
glm::dvec2 affine(const glm::dvec2& g) {
  const glm::dvec2 d = g - glm::dvec2(137, -5);
  return {120 + 92 * d.x + 31 * d.y, 90 + 25 * d.x - 97 * d.y};
}

glm::dvec2 second_order(const glm::dvec2& g) {
  const glm::dvec2 d = g - glm::dvec2(137, -5);
  return affine(g) + glm::dvec2(4 * d.x * d.x - 3 * d.x * d.y, 5 * d.y * d.y + 2 * d.x * d.x);
}

glm::dvec2 third_order(const glm::dvec2& g) {
  const glm::dvec2 d = g - glm::dvec2(137, -5);
  return second_order(g) + glm::dvec2(2 * d.x * d.x * d.x, -2 * d.x * d.x * d.y);
}

std::vector<Point> points_of(const Map& map, int side, double extent_deg = 1.1,
                             const glm::dvec2& middle = {137, -5}) {
  std::vector<Point> points;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const glm::dvec2 ground = middle + extent_deg * (2.0 * glm::dvec2(column, row) / (side - 1.0) - 1.0);
      points.push_back({map(ground), ground});
    }
  }
  return points;
}

class ControlPoints : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const source_files::Raster& raster,
                   const std::vector<Point>& points, const std::string& crs = source_files::kSphere) const {
    const std::string path = source_files::write(folder_ / name, raster);
    placed_files::set_points(path, points, crs);
    return path;
  }

  std::string error(const std::vector<Point>& points, mars::GcpMethod method = mars::GcpMethod::kByCount,
                    const std::string& crs = source_files::kSphere) const {
    const std::string path = file("e.tif", placed_files::numbers(kWidth, kHeight, false), points, crs);
    try {
      mars::open_elevation(path, {.gcp_method = method});
    } catch (const mars::SourceError& e) {
      EXPECT_NE(std::string(e.what()).find("e.tif"), std::string::npos) << e.what();
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
      return e.what();
    }
    return {};
  }

  // Opens rasters of column and row numbers with these points, and expects each place where the map says.
  // Returns the note about the first.
  std::string expect_map(const std::vector<Point>& points, const Map& map, mars::GcpMethod method,
                         const std::string& crs = source_files::kSphere,
                         const glm::dvec2& middle = {137, -5}) const {
    const mars::PlacementOptions options{.gcp_method = method};
    const auto columns = mars::open_elevation(
        file("c.tif", placed_files::numbers(kWidth, kHeight, false), points, crs), options);
    const auto rows =
        mars::open_elevation(file("r.tif", placed_files::numbers(kWidth, kHeight, true), points, crs), options);
    test_support::Random random(17);
    int inside = 0;
    int outside = 0;
    for (int i = 0; i < 3000; ++i) {
      const glm::dvec2 ground = middle + glm::dvec2(random.uniform(-2, 2), random.uniform(-2, 2));
      const glm::dvec2 pixel = map(ground);
      const mars::LonLat place{ground.x, ground.y};
      const double column = height_at(*columns, place);
      if (pixel.x < -3 || pixel.x > kWidth + 3 || pixel.y < -3 || pixel.y > kHeight + 3) {
        EXPECT_TRUE(std::isnan(column)) << ground.x << " " << ground.y;
        ++outside;
      }
      if (pixel.x < 3 || pixel.x > kWidth - 3 || pixel.y < 3 || pixel.y > kHeight - 3) continue;
      ++inside;
      EXPECT_NEAR(column, pixel.x - 0.5, kMost_px) << ground.x << " " << ground.y;
      EXPECT_NEAR(height_at(*rows, place), pixel.y - 0.5, kMost_px) << ground.x << " " << ground.y;
    }
    EXPECT_GT(inside, 500);
    EXPECT_GT(outside, 500);
    return columns->infos().at(0).notes.empty() ? "" : columns->infos().at(0).notes.front();
  }

  test_support::TempDir folder_;
};

TEST_F(ControlPoints, AffineMap) {
  const std::string note = expect_map(points_of(affine, 2), affine, mars::GcpMethod::kByCount);
  EXPECT_NE(
      note.find(
          "c.tif: placed by its 4 control points with a polynomial of order 1; they lie off it by 0 pixels "
          "(0 m) RMS"),
      std::string::npos)
      << note;
}

TEST_F(ControlPoints, SecondAndThirdOrder) {
  EXPECT_NE(expect_map(points_of(second_order, 3), second_order, mars::GcpMethod::kByCount).find("order 2"),
            std::string::npos);
  expect_map(points_of(second_order, 4), second_order, mars::GcpMethod::kPolynomial2);
  EXPECT_NE(expect_map(points_of(third_order, 5), third_order, mars::GcpMethod::kPolynomial3).find("order 3"),
            std::string::npos);
}

TEST_F(ControlPoints, SplineMeetsItsPointsAndReproducesAffineMaps) {
  const std::string note = expect_map(points_of(affine, 4), affine, mars::GcpMethod::kByCount);
  EXPECT_NE(
      note.find(
          "placed by its 16 control points with a thin-plate spline, which meets each of them; a polynomial "
          "of order 3 through the other points misses a point by 0 pixels"),
      std::string::npos)
      << note;
  // A map that is no polynomial: it holds at the points.
  const auto wavy = [](const glm::dvec2& g) {
    return affine(g) + glm::dvec2(3 * std::sin(5 * g.x), 2 * std::cos(4 * g.y));
  };
  const auto points = points_of(wavy, 7);
  const auto columns =
      mars::open_elevation(file("c.tif", placed_files::numbers(kWidth, kHeight, false), points));
  const auto rows = mars::open_elevation(file("r.tif", placed_files::numbers(kWidth, kHeight, true), points));
  int checked = 0;
  for (const Point& p : points) {
    if (p.pixel.x < 3 || p.pixel.x > kWidth - 3 || p.pixel.y < 3 || p.pixel.y > kHeight - 3) continue;
    ++checked;
    EXPECT_NEAR(height_at(*columns, {p.ground.x, p.ground.y}), p.pixel.x - 0.5, kMost_px);
    EXPECT_NEAR(height_at(*rows, {p.ground.x, p.ground.y}), p.pixel.y - 0.5, kMost_px);
  }
  EXPECT_GT(checked, 15);
  EXPECT_NE(columns->infos().at(0).treatment.find("placed by its control points, thin-plate spline"),
            std::string::npos);
}

TEST_F(ControlPoints, AgreesWithGdaltransform) {
  auto points = points_of(third_order, 5);
  test_support::Random random(3);
  for (Point& p : points) p.pixel += glm::dvec2(random.uniform(-1, 1), random.uniform(-1, 1));
  const std::string path = file("g.tif", placed_files::numbers(kWidth, kHeight, false), points);
  for (const auto& [method, option] : {std::pair{mars::GcpMethod::kPolynomial1, "-order 1"},
                                       {mars::GcpMethod::kPolynomial2, "-order 2"},
                                       {mars::GcpMethod::kPolynomial3, "-order 3"},
                                       {mars::GcpMethod::kSpline, "-tps"}}) {
    const auto source = mars::open_elevation(path, {.gcp_method = method});
    for (const glm::dvec2 place : {glm::dvec2(137.1, -5.2), {136.5, -4.6}, {137.7, -4.9}, {136.8, -5.6}}) {
      char where[64];
      std::snprintf(where, sizeof where, "%.6f %.6f", place.x, place.y);
      const std::string text =
          placed_files::run_tool("gdaltransform -i " + std::string(option) + " " + path, where);
      if (text.empty()) GTEST_SKIP() << "gdaltransform is not installed";
      glm::dvec2 pixel;
      ASSERT_EQ(std::sscanf(text.c_str(), "%lf %lf", &pixel.x, &pixel.y), 2) << text;
      EXPECT_NEAR(height_at(*source, {place.x, place.y}), pixel.x - 0.5, kMost_px) << option;
    }
  }
}

TEST_F(ControlPoints, ResidualsAreTold) {
  auto points = points_of(affine, 2);
  for (std::size_t i = 0; i < 4; ++i) points[i].pixel.x += i == 0 || i == 3 ? 2 : -2;
  const auto source =
      mars::open_elevation(file("n.tif", placed_files::numbers(kWidth, kHeight, false), points));
  const std::string note = source->infos().at(0).notes.at(0);
  // A pixel is about 600 m wide.
  EXPECT_NE(note.find("they lie off it by 2 pixels (1200 m) RMS, 2 pixels (1200 m) at most, at '"),
            std::string::npos)
      << note;
  // As many points as the polynomial needs: there is nothing to tell.
  points.pop_back();
  const auto exact = mars::open_elevation(file("x.tif", placed_files::numbers(kWidth, kHeight, false), points));
  EXPECT_NE(exact->infos().at(0).notes.at(0).find("needs all of them: nothing checks them"), std::string::npos);
}

TEST_F(ControlPoints, AcrossTheAntimeridian) {
  const glm::dvec2 middle(180, -5);
  const Map map = [](const glm::dvec2& g) { return affine(g - glm::dvec2(43, 0)); };
  auto points = points_of(map, 3, 1.1, middle);
  for (Point& p : points)
    if (p.ground.x > 180) p.ground.x -= 360;
  expect_map(points, map, mars::GcpMethod::kByCount, source_files::kSphere, middle);
}

TEST_F(ControlPoints, ProjectedPointsNearAPole) {
  const std::string crs = "+proj=stere +lat_0=90 +lat_ts=90 +lon_0=0 +R=3396190 +units=m +no_defs";
  const source_files::Proj proj(crs);
  const auto to_pixel = [](const glm::dvec2& m) { return glm::dvec2(120 + m.x / 3000, 90 - m.y / 3000); };
  std::vector<Point> points;
  for (const glm::dvec2 m : {glm::dvec2(-3e5, -2e5), {3e5, -2e5}, {-3e5, 2e5}, {3e5, 2e5}, {0, 1e4}})
    points.push_back({to_pixel(m), m});
  const auto source =
      mars::open_elevation(file("p.tif", placed_files::numbers(kWidth, kHeight, false), points, crs));
  for (const mars::LonLat place : {mars::LonLat{0, 90}, {30, 88.5}, {-120, 87}, {170, 89}})
    EXPECT_NEAR(height_at(*source, place), to_pixel(proj.forward(place)).x - 0.5, kMost_px);
  EXPECT_NEAR(source->infos().at(0).resolution_m, 3000, 1);
}

TEST_F(ControlPoints, LatitudesOfAnEllipsoidAreItsOwn) {
  const std::string crs = "+proj=longlat +a=3396190 +b=3376200 +no_defs";
  const auto source = mars::open_elevation(
      file("e.tif", placed_files::numbers(kWidth, kHeight, true), points_of(affine, 3), crs));
  const double k = 3376200.0 / 3396190 * 3376200 / 3396190;
  const double centric = std::atan(std::tan(-5.2 * mars::kRadiansPerDegree) * k) / mars::kRadiansPerDegree;
  EXPECT_NEAR(height_at(*source, {137.1, centric}), affine({137.1, -5.2}).y - 0.5, kMost_px);
}

TEST_F(ControlPoints, TypesNodataAndScale) {
  const auto points = points_of(affine, 3);
  for (const GDALDataType type : {GDT_Byte, GDT_Int16, GDT_UInt16, GDT_Int32, GDT_Float32, GDT_Float64}) {
    source_files::Raster raster = placed_files::numbers(kWidth, kHeight, false);
    raster.type = type;
    raster.nodata = 7;
    raster.scale = 0.5;
    raster.offset = 100;
    raster.value = [](int, int column, int row) { return row < 40 ? 7 : 10 + column % 50; };
    const auto source = mars::open_elevation(file("t.tif", raster, points));
    test_support::Random random(1);
    for (int i = 0; i < 500; ++i) {
      const glm::dvec2 ground(137 + random.uniform(-2, 2), -5 + random.uniform(-2, 2));
      const glm::dvec2 pixel = affine(ground);
      const bool is_out = pixel.x < -3 || pixel.x > kWidth + 3 || pixel.y < 37 || pixel.y > kHeight + 3;
      const double height_m = height_at(*source, {ground.x, ground.y});
      if (is_out) {
        EXPECT_TRUE(std::isnan(height_m)) << GDALGetDataTypeName(type);
      }
      if (pixel.x < 3 || pixel.x > kWidth - 3 || pixel.y < 43 || pixel.y > kHeight - 3) continue;
      ASSERT_TRUE(std::isfinite(height_m)) << GDALGetDataTypeName(type);
      const double column = std::fmod(pixel.x - 0.5, 50);
      if (column < 1 || column > 48) continue;
      EXPECT_NEAR(height_m, 100 + 0.5 * (10 + column), 0.3) << GDALGetDataTypeName(type);
    }
  }
}

TEST_F(ControlPoints, ColourImagesAreClearOutside) {
  source_files::Raster raster = placed_files::numbers(kWidth, kHeight, false);
  raster.type = GDT_Byte;
  raster.bands = 3;
  raster.options = {"PHOTOMETRIC=RGB"};
  raster.value = [](int band, int column, int row) { return band == 1 ? column : band == 2 ? row : 200; };
  const auto image = mars::open_image(file("i.tif", raster, points_of(affine, 2)));
  const auto look = [&](const glm::dvec2& ground) {
    const glm::dvec3 d = mars::direction({ground.x, ground.y});
    vpe::base::Rgb colour;
    std::uint8_t alpha = 0;
    image->sample({&d, 1}, 100, {&colour, 1}, {&alpha, 1});
    return std::pair{colour, int{alpha}};
  };
  const auto [colour, alpha] = look({137.3, -5.1});
  EXPECT_EQ(alpha, 255);
  EXPECT_NEAR(colour.r, affine({137.3, -5.1}).x - 0.5, 1.1);
  EXPECT_NEAR(colour.g, affine({137.3, -5.1}).y - 0.5, 1.1);
  EXPECT_EQ(int{colour.b}, 200);
  EXPECT_EQ(look({139.5, -5}).second, 0);
  EXPECT_NE(image->infos().at(0).notes.at(0).find("4 control points"), std::string::npos);
}

TEST_F(ControlPoints, PalettesAreNotMixed) {
  source_files::Raster raster = placed_files::numbers(kWidth, kHeight, false);
  raster.type = GDT_Byte;
  raster.palette = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}};
  raster.value = [](int, int column, int) { return column < 120 ? 0 : 2; };
  const std::string path = file("p.tif", raster, points_of(affine, 2));
  const mars::GdalRaster placed(path);
  EXPECT_TRUE(placed.is_placed());
  std::vector<unsigned char> line(static_cast<std::size_t>(placed.grid().width));
  for (int row = 0; row < placed.grid().height; row += 10) {
    placed.read(1, -1, {0, row, placed.grid().width, 1}, placed.grid().width, line.data());
    for (const unsigned char value : line) EXPECT_NE(int{value}, 1);
  }
}

TEST_F(ControlPoints, AMapComesFirst) {
  source_files::Raster raster = placed_files::numbers(40, 30, false);
  raster.crs = source_files::kSphere;
  raster.geotransform = source_files::box(10, 40, 50, 10, 40, 30);
  const mars::GdalRaster mapped(source_files::write(folder_ / "m.tif", raster));
  EXPECT_FALSE(mapped.is_placed());
}

TEST_F(ControlPoints, StampsNoticeAChange) {
  const std::string path = file("s.tif", placed_files::numbers(kWidth, kHeight, false), points_of(affine, 2));
  const auto source = mars::open_elevation(path);
  EXPECT_EQ(mars::changed_file(source->infos().at(0).files), "");
  const mars::RasterState before = mars::raster_state(path);
  auto moved = points_of(affine, 2);
  for (Point& p : moved) p.ground.x += 0.5;
  file("s.tif", placed_files::numbers(kWidth, kHeight, true), moved);
  EXPECT_EQ(mars::changed_file(source->infos().at(0).files), path);
  EXPECT_NE(mars::raster_state(path).text, before.text);
}

TEST_F(ControlPoints, BadPointsAreRefused) {
  const auto good = points_of(affine, 3);
  EXPECT_EQ(error(good), "");
  const auto expect_words = [](const std::string& message, const std::string& words) {
    EXPECT_NE(message.find(words), std::string::npos) << words << "\n" << message;
  };
  using mars::GcpMethod;
  expect_words(error(good, GcpMethod::kByCount, ""), "has control points but no coordinate system; name that");
  expect_words(error({good[0], good[8]}), "has 2 control points: a map needs at least 3; add points");
  expect_words(error({good[0], good[2], good[6], good[8], good[4]}, GcpMethod::kPolynomial2),
               "has 5 control points: a polynomial of order 2 needs 6; use --gcp-method polynomial1");
  expect_words(error(good, GcpMethod::kPolynomial3), "needs 10; use --gcp-method polynomial2");
  expect_words(error({good[0], good[4], good[8]}), "lie on one line");
  expect_words(error({good[0], good[1], good[2], good[3], good[4], good[5]}, GcpMethod::kPolynomial2),
               "do not determine a polynomial of order 2");
  auto twice = good;
  twice.push_back({good[4].pixel, good[4].ground + glm::dvec2(0.1, 0)});
  expect_words(error(twice), "contradict each other: one pixel at two places");
  twice.back() = {good[4].pixel + glm::dvec2(3, 0), good[4].ground};
  expect_words(error(twice), "contradict each other: one place at two pixels");
  twice.back() = good[4];
  EXPECT_EQ(error(twice), "");  // the same point again
  auto exchanged = points_of(affine, 6);
  for (std::size_t i = 0; i < 18; i += 3) std::swap(exchanged[i].pixel, exchanged[35 - i].pixel);
  expect_words(error(exchanged),
               "its control points contradict each other: a polynomial of order 3 misses them by");
  for (Point& p : exchanged) std::swap(p.ground.x, p.ground.y);
  EXPECT_NE(error(exchanged), "");
  expect_words(error(points_of(affine, 46), GcpMethod::kSpline),
               "has 2116 control points: a spline takes at most 2000");
}

TEST_F(ControlPoints, AFoldedPlacementIsRefused) {
  const auto folded = [](const glm::dvec2& g) {
    const double x = g.x - 137;
    return glm::dvec2(40 * (x + 0.2) * (x + 0.2) - 20, 90 - 97 * (g.y + 5));
  };
  const std::string message = error(points_of(folded, 4), mars::GcpMethod::kPolynomial2);
  EXPECT_NE(message.find("--gcp-method polynomial1"), std::string::npos) << message;
}

TEST_F(ControlPoints, PointsThatAreNoNumbersAreRefused) {
  const std::string path = source_files::write(folder_ / "v.tif", placed_files::numbers(8, 8, false));
  source_files::write_text(
      folder_ / "v.vrt",
      "<VRTDataset rasterXSize=\"8\" rasterYSize=\"8\"><GCPList Projection=\"+proj=longlat +R=3396190 +no_defs\">"
      "<GCP Id=\"a\" Pixel=\"0\" Line=\"0\" X=\"nan\" Y=\"1\"/><GCP Id=\"b\" Pixel=\"8\" Line=\"0\" X=\"1\" Y=\"1\"/>"
      "<GCP Id=\"c\" Pixel=\"0\" Line=\"8\" X=\"0\" Y=\"0\"/></GCPList><VRTRasterBand dataType=\"Float32\" band=\"1\">"
      "<SimpleSource><SourceFilename relativeToVRT=\"1\">v.tif</SourceFilename></SimpleSource></VRTRasterBand>"
      "</VRTDataset>");
  const std::string message = source_files::elevation_error((folder_ / "v.vrt").string());
  EXPECT_NE(message.find("v.vrt: its control point 'a' is no number"), std::string::npos) << message;
}

TEST_F(ControlPoints, ManyThreadsReadTheSame) {
  const std::string path =
      file("m.tif", placed_files::numbers(kWidth, kHeight, false), points_of(third_order, 5));
  const auto source = mars::open_elevation(path);
  const auto other = mars::open_elevation(path);
  const mars::GdalRaster first(path);
  const auto a = first.acquire();
  const auto b = first.acquire();  // a handle of its own
  EXPECT_EQ(a->GetRasterXSize(), b->GetRasterXSize());
  std::vector<float> x(static_cast<std::size_t>(a->GetRasterXSize()));
  std::vector<float> y(x.size());
  for (const auto& [handle, line] : {std::pair{a.operator->(), x.data()}, {b.operator->(), y.data()}}) {
    ASSERT_EQ(handle->GetRasterBand(1)->RasterIO(GF_Read, 0, 90, handle->GetRasterXSize(), 1, line,
                                                 handle->GetRasterXSize(), 1, GDT_Float32, 0, 0, nullptr),
              CE_None);
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_TRUE(x[i] == y[i] || (std::isnan(x[i]) && std::isnan(y[i])));
  EXPECT_EQ(height_at(*source, {137.1, -5.1}), height_at(*other, {137.1, -5.1}));
}

}  // namespace
