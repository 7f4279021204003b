#include "mars/vector/feature_writer.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <limits>
#include <string>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "mars/sources/source.h"
#include "tests/mars/vector/vector_files.h"
#include "tests/support/support.h"

namespace {

using mars::Feature;
using mars::FeatureFileInfo;
using mars::FeatureLayer;
using mars::FieldValue;
using mars::Shape;
using mars::ShapeKind;
using vector_files::expect_words;
using vector_files::read;
using vector_files::read_text;

const FeatureFileInfo kInfo{mars::kMarsRadius_m, "Mars", "heights above the \"areoid\", 5 m"};

FeatureLayer sample() {
  FeatureLayer layer;
  layer.name = "contours";
  layer.fields = {"height_m", "index", "name", "nothing"};
  layer.features.push_back({3,
                            {{ShapeKind::line, {{{137.44170000000001, -4.5895}, {137.5, -4.6}}}}},
                            {-4500.25, std::int64_t{5}, "Gale \"x\"\n<é>", FieldValue()},
                            ""});
  layer.features.push_back({8,
                            {{ShapeKind::line, {{{179, 1}, {181, 2}, {182, 2}}}}},
                            {std::int64_t{-4400}, std::int64_t{1} << 60, FieldValue(), FieldValue()},
                            "PEN(c:#FF8800)"});
  layer.features.push_back({9, {}, {1.0 / 3, std::int64_t{0}, "", FieldValue()}, ""});
  return layer;
}

class FeatureWriter : public ::testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path file() const { return folder_ / (std::string("out") + GetParam()); }

  std::string write_error(const FeatureLayer& layer, const std::filesystem::path& path) const {
    try {
      mars::write_features(path, layer, kInfo);
    } catch (const mars::SourceError& error) {
      return error.what();
    }
    return {};
  }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_.path()),
                                                  std::filesystem::directory_iterator()));
  }

  test_support::TempDir folder_;
};

INSTANTIATE_TEST_SUITE_P(Formats, FeatureWriter, ::testing::Values(".geojson", ".json", ".gpkg", ".GPKG"));

TEST_P(FeatureWriter, RoundTrip) {
  const FeatureLayer layer = sample();
  mars::write_features(file(), layer, kInfo);
  EXPECT_EQ(files(), 1U);
  const auto layers = read(file());
  ASSERT_EQ(layers.size(), 1U);
  EXPECT_EQ(layers[0].name, "contours");
  EXPECT_EQ(layers[0].fields, layer.fields);
  ASSERT_EQ(layers[0].features.size(), 3U);
  const Feature& first = layers[0].features[0];
  EXPECT_EQ(first.number, 3);
  ASSERT_EQ(first.shapes.size(), 1U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(first.shapes[0].rings[0][i].x, layer.features[0].shapes[0].rings[0][i].x, 1e-10);
    EXPECT_NEAR(first.shapes[0].rings[0][i].y, layer.features[0].shapes[0].rings[0][i].y, 1e-10);
  }
  EXPECT_EQ(std::get<double>(first.values[0]), -4500.25);
  EXPECT_EQ(std::get<std::int64_t>(first.values[1]), 5);
  EXPECT_EQ(std::get<std::string>(first.values[2]), "Gale \"x\"\n<é>");
  EXPECT_TRUE(std::holds_alternative<std::monostate>(first.values[3]));
  const Feature& second = layers[0].features[1];
  ASSERT_EQ(second.shapes.size(), 2U);  // cut at the antimeridian
  EXPECT_NEAR(second.shapes[0].rings[0].back().x, 180, 1e-10);
  EXPECT_NEAR(std::abs(second.shapes[1].rings[0].front().x), 180, 1e-10);
  EXPECT_EQ(std::get<double>(second.values[0]), -4400);
  EXPECT_EQ(std::get<std::int64_t>(second.values[1]), std::int64_t{1} << 60);
  EXPECT_EQ(second.style, "PEN(c:#FF8800)");
  EXPECT_TRUE(layers[0].features[2].shapes.empty());
  EXPECT_EQ(std::get<double>(layers[0].features[2].values[0]), 1.0 / 3);
}

TEST_P(FeatureWriter, NamesTheSphere) {
  struct Planet {
    FeatureFileInfo info;
    std::string name;
  };
  for (const Planet& planet :
       {Planet{kInfo, "49900"}, Planet{{1'737'400, "Moon", ""}, "30100"},
        Planet{{3'389'500, "Mars", ""}, "3389500"}, Planet{{123'456.5, "", ""}, "123456.5"}}) {
    SCOPED_TRACE(planet.name);
    mars::write_features(file(), sample(), planet.info);
    const mars::GdalScope scope;
    GDALDataset* dataset = GDALDataset::Open(file().c_str(), GDAL_OF_VECTOR);
    ASSERT_NE(dataset, nullptr);
    const OGRSpatialReference* crs = dataset->GetLayer(0)->GetSpatialRef();
    ASSERT_NE(crs, nullptr);
    EXPECT_NEAR(crs->GetSemiMajor(), planet.info.radius_m, 1e-6);
    EXPECT_EQ(crs->GetInvFlattening(), 0);
    EXPECT_TRUE(crs->IsGeographic());
    GDALClose(dataset);
    if (!file().extension().string().starts_with(".g") || file().extension() == ".geojson") {
      EXPECT_NE(read_text(file()).find(planet.name), std::string::npos) << read_text(file()).substr(0, 400);
    }
    EXPECT_EQ(mars::read_features(file().string(), {}, planet.info.radius_m).size(), 1U);
  }
}

TEST_P(FeatureWriter, CutsPolygonsAsTheStandardSays) {
  FeatureLayer layer;
  layer.features.push_back(
      {0, {{ShapeKind::polygon, {{{170, 0}, {170, 10}, {190, 10}, {190, 0}, {170, 0}}}}}, {}, ""});
  layer.features.push_back({0, {{ShapeKind::polygon, {{{0, 80}, {120, 80}, {240, 80}, {360, 80}}}}}, {}, ""});
  mars::write_features(file(), layer, kInfo);
  const mars::GdalScope scope;
  GDALDataset* dataset = GDALDataset::Open(file().c_str(), GDAL_OF_VECTOR);
  ASSERT_NE(dataset, nullptr);
  EXPECT_STREQ(dataset->GetLayer(0)->GetName(), "out");
  int count = 0;
  for (const auto& feature : dataset->GetLayer(0)) {
    const OGRGeometry* geometry = feature->GetGeometryRef();
    ASSERT_NE(geometry, nullptr);
    EXPECT_TRUE(geometry->IsValid());
    OGREnvelope box;
    geometry->getEnvelope(&box);
    EXPECT_GE(box.MinX, -180);
    EXPECT_LE(box.MaxX, 180);
    EXPECT_NEAR(geometry->toMultiPolygon()->get_Area(), count == 0 ? 200 : 3600, 1e-6);
    ++count;
  }
  EXPECT_EQ(count, 2);
  GDALClose(dataset);
}

TEST_P(FeatureWriter, MixedKindsAndFields) {
  FeatureLayer layer;
  layer.name = "mixed";
  layer.fields = {"fid", "geom", "v", "w"};
  layer.features.push_back(
      {1, {{ShapeKind::point, {{{1, 2}}}}}, {std::int64_t{7}, "x", std::int64_t{1}, 1.5}, ""});
  layer.features.push_back({1,
                            {{ShapeKind::point, {{{1, 2}}}}, {ShapeKind::line, {{{1, 2}, {3, 4}}}}},
                            {std::int64_t{8}, "y", "text", std::int64_t{2}},
                            ""});
  layer.features.push_back({1, {{ShapeKind::polygon, {{{0, 0}, {1, 0}, {1, 1}, {0, 0}}}}}, {}, ""});
  mars::write_features(file(), layer, kInfo);
  const auto back = read(file()).at(0);
  EXPECT_EQ(back.fields, layer.fields);
  ASSERT_EQ(back.features.size(), 3U);
  EXPECT_EQ(back.features[1].shapes.size(), 2U);
  EXPECT_EQ(std::get<std::string>(back.features[0].values[2]), "1");
  EXPECT_EQ(std::get<double>(back.features[1].values[3]), 2);
  EXPECT_EQ(back.features[2].shapes.at(0).kind, ShapeKind::polygon);
}

TEST_P(FeatureWriter, ReplacesAndDescribes) {
  vector_files::write_text(file(), "old");
  mars::write_features(file(), sample(), kInfo);
  const mars::GdalScope scope;
  GDALDataset* dataset = GDALDataset::Open(file().c_str(), GDAL_OF_VECTOR);
  ASSERT_NE(dataset, nullptr);
  const char* description = dataset->GetLayer(0)->GetMetadataItem("DESCRIPTION");
  EXPECT_STREQ(description, kInfo.description.c_str());
  GDALClose(dataset);
  EXPECT_EQ(files(), 1U);
  // Without features.
  mars::write_features(file(), {"empty", {"a"}, {}}, kInfo);
  mars::FeatureReadOptions options;
  options.layer = "empty";
  EXPECT_EQ(read(file(), options).at(0).features.size(), 0U);
}

TEST_P(FeatureWriter, FailuresLeaveNothing) {
  expect_words(write_error(sample(), folder_ / "no" / "out.json"), {"out.json", "folder exists"});
  expect_words(write_error(sample(), folder_ / "out.shp"), {"out.shp", "extension", ".gpkg"});
  FeatureLayer twice = sample();
  twice.fields[1] = twice.fields[0];
  if (file().extension() == ".gpkg") {
    expect_words(write_error(twice, file()), {"out.gpkg", "height_m"});
  }
  EXPECT_EQ(files(), 0U);
}

}  // namespace
