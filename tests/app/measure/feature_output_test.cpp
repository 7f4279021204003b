// -o of the commands that measure: what GDAL reads back is what --json prints.
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

// Reads the first layer of a file with GDAL alone.
class Features {
 public:
  explicit Features(const std::string& file) {
    GDALAllRegister();
    dataset_.reset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
    if (dataset_ == nullptr) return;
    for (const auto& feature : dataset_->GetLayer(0)) features_.emplace_back(feature->Clone());
  }
  bool is_open() const { return dataset_ != nullptr; }
  std::size_t size() const { return features_.size(); }
  const OGRFeature& operator[](std::size_t n) const { return *features_.at(n); }
  const OGRGeometry& shape(std::size_t n) const { return *features_.at(n)->GetGeometryRef(); }
  OGRwkbGeometryType type(std::size_t n) const { return wkbFlatten(shape(n).getGeometryType()); }
  std::string text(std::size_t n, const std::string& field) const {
    return features_.at(n)->GetFieldAsString(field.c_str());
  }
  double semi_major_m() const { return dataset_->GetLayer(0)->GetSpatialRef()->GetSemiMajor(); }

 private:
  std::unique_ptr<GDALDataset> dataset_;
  std::vector<OGRFeatureUniquePtr> features_;
};

// Compares all single values of an object with the attributes of a feature of the same names.
void expect_values(const Features& features, std::size_t n, const json& values,
                   const std::string& prefix = "") {
  for (const auto& [key, value] : values.items()) {
    const std::string name = prefix + key;
    const int index = features[n].GetFieldIndex(name.c_str());
    if (value.is_object()) {
      expect_values(features, n, value, name + "_");
    } else if (value.is_null()) {
      EXPECT_TRUE(index < 0 || !features[n].IsFieldSetAndNotNull(index)) << name;
    } else if (value.is_boolean()) {
      EXPECT_EQ(features[n].GetFieldAsInteger(name.c_str()), value.get<bool>() ? 1 : 0) << name;
    } else if (value.is_number()) {
      ASSERT_GE(index, 0) << name;
      EXPECT_EQ(features[n].GetFieldAsDouble(index), value.get<double>()) << name;
    } else if (value.is_string()) {
      EXPECT_EQ(features.text(n, name), value.get<std::string>()) << name;
    }
  }
}

class FeatureOutput : public AppTest {
 protected:
  // Runs a command with --json and -o for each format. Returns the JSON, and checks that stdout is as without -o.
  json write(Words words) const {
    words.insert(words.end(), {"--json", "-q"});
    const Result plain = vpe(words);
    EXPECT_EQ(plain.exit_code, 0) << plain.err;
    for (const char* name : {"r.geojson", "r.gpkg"}) {
      Words with = words;
      with.insert(with.end(), {"-o", path(name)});
      const Result result = vpe(with);
      EXPECT_EQ(result.exit_code, 0) << result.err;
      EXPECT_EQ(result.out, plain.out);
      const Features features(path(name));
      EXPECT_TRUE(features.is_open()) << name;
      if (features.is_open()) {
        EXPECT_EQ(features.semi_major_m(), 3396190);
      }
    }
    return parse_json(plain.out);
  }
  std::vector<Features> both() const {
    std::vector<Features> files;
    for (const char* name : {"r.geojson", "r.gpkg"}) files.emplace_back(path(name));
    return files;
  }
};

TEST_F(FeatureOutput, OfMeasureHasOutlinesAndFigures) {
  const std::string p = planet().string();
  const json list =
      write({"measure", p, "10,-5", "16,-5", "16,1", "10,1", "--limit", "1,20", "--water-level", "0"});
  ASSERT_EQ(list.size(), 1U);
  for (const Features& features : both()) {
    ASSERT_EQ(features.size(), 1U);
    EXPECT_EQ(features.type(0), wkbPolygon);
    EXPECT_EQ(features.shape(0).IsValid(), TRUE);
    expect_values(features, 0, list[0]);
    EXPECT_EQ(features[0].GetFieldAsDouble("slope_steeper_2_limit_deg"), 20);
    OGREnvelope box;
    features.shape(0).getEnvelope(&box);
    EXPECT_NEAR(box.MinX, 10, 1e-9);
    EXPECT_NEAR(box.MaxX, 16, 1e-9);
    EXPECT_LT(box.MinY, -5);  // the great circle between two places at 5 south
  }
  // What was written is read again as an outline.
  const Result again = vpe({"measure", p, "--polygons", "r.geojson", "--json", "-q"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const double area_m2 = list[0]["sphere_area_m2"].get<double>();
  EXPECT_NEAR(parse_json(again.out)[0]["sphere_area_m2"].get<double>(), area_m2, 1e-5 * area_m2);
  EXPECT_TRUE(
      says(parse_json(read_text(dir_ / "r.geojson"))["description"], {"vpe measure", "Elevations count from"}));
}

TEST_F(FeatureOutput, OfProfileHasPathAndPoints) {
  const json answer = write(
      {"profile", planet().string(), "10,-5", "16,3", "170,5", "-175,8", "--step", "200000", "--limit", "1"});
  for (const char* key : {"datum", "radius_m", "post_spacing_m", "resampling_max_m", "nodata_share",
                          "synthetic_share", "length_m", "ground_length_m"})
    EXPECT_TRUE(answer.contains(key)) << key;
  for (const Features& features : both()) {
    ASSERT_EQ(features.size(), answer["points"].size() + 1);
    EXPECT_EQ(features.text(0, "part"), "path");
    EXPECT_EQ(features.type(0), wkbMultiLineString);  // cut where longitudes begin
    expect_values(features, 0, answer);
    for (std::size_t n = 0; n < answer["points"].size(); ++n) {
      const json& point = answer["points"][n];
      EXPECT_EQ(features.text(n + 1, "part"), "point");
      expect_values(features, n + 1, point);
      const OGRPoint& at = *features.shape(n + 1).toPoint();
      EXPECT_NEAR(at.getY(), point["lat_deg"].get<double>(), 1e-9);
      EXPECT_NEAR(std::remainder(at.getX() - point["lon_deg"].get<double>(), 360), 0, 1e-9);
    }
  }
}

TEST_F(FeatureOutput, OfSightHasLineEndsAndObstacle) {
  const json answer = write({"sight", planet().string(), "--from", "10,-5", "--to", "40,2"});
  ASSERT_FALSE(answer["visible"].get<bool>());
  for (const Features& features : both()) {
    ASSERT_EQ(features.size(), 5U);
    EXPECT_EQ(features.type(0), wkbLineString);
    expect_values(features, 0, answer);
    for (std::size_t n = 1; n < 5; ++n) EXPECT_EQ(features.type(n), wkbPoint);
    EXPECT_EQ(features.text(1, "part"), "from");
    EXPECT_EQ(features.text(2, "part"), "to");
    EXPECT_EQ(features.text(3, "part"), "clearance");
    EXPECT_EQ(features.text(4, "part"), "obstacle");
    expect_values(features, 4, answer["obstacle"]);
    EXPECT_NEAR(features.shape(4).toPoint()->getX(), answer["obstacle"]["lon_deg"].get<double>(), 1e-9);
  }
}

TEST_F(FeatureOutput, OfQueryHasThePlaces) {
  const json list = write({"query", planet().string(), "10,-5", "-120.5,60"});
  ASSERT_EQ(list.size(), 2U);
  for (const Features& features : both()) {
    ASSERT_EQ(features.size(), 2U);
    for (std::size_t n = 0; n < 2; ++n) {
      EXPECT_EQ(features.type(n), wkbPoint);
      expect_values(features, n, list[n]);
      EXPECT_NEAR(features.shape(n).toPoint()->getX(), list[n]["lon_deg"].get<double>(), 1e-9);
    }
  }
  // Columns of a table, and all surfaces.
  const Result table = vpe({"query", planet().string(), "--all-surfaces", "-o", path("t.gpkg"), "-q"},
                           "name,lon,lat\nHill,10,-5\n");
  ASSERT_EQ(table.exit_code, 0) << table.err;
  EXPECT_TRUE(says(table.out, {"Hill", "ground"}));
  const Features features(path("t.gpkg"));
  ASSERT_EQ(features.size(), 1U);
  EXPECT_EQ(features.text(0, "input_name"), "Hill");
  EXPECT_EQ(features.text(0, "surface"), "ground");
  EXPECT_EQ(features[0].GetFieldAsDouble("height_m"), list[0]["elevation_m"].get<double>());
}

TEST_F(FeatureOutput, BadNamesAreRefusedBeforeTheWork) {
  const std::string p = planet().string();
  write_text(dir_ / "mine.geojson", "{\"a\": 1}");
  const std::vector<Words> commands{{"measure", p, "10,-5", "16,-5", "16,1"},
                                    {"profile", p, "10,-5", "16,-5"},
                                    {"sight", p, "--from", "10,-5", "--to", "16,-5"},
                                    {"query", p, "10,-5"}};
  for (const Words& command : commands) {
    const auto refuse = [&](const std::string& output, int code, const Words& parts) {
      Words words = command;
      words.insert(words.end(), {"-o", output});
      expect_failure(words, code, parts);
    };
    refuse(path("r.shp"), 2, {"-o", "r.shp", ".geojson", ".gpkg"});
    refuse(path("mine.geojson"), 1, {"mine.geojson", "exists"});
    refuse(path("none/r.gpkg"), 1, {"none", "folder"});
  }
  EXPECT_EQ(read_text(dir_ / "mine.geojson"), "{\"a\": 1}");
}

}  // namespace
}  // namespace app_test
