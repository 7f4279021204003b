// A million vertices take little more memory than they have bytes.
#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iomanip>
#include <string>

#include "mars/geodesy/sphere.h"
#include "mars/vector/feature_reader.h"
#include "mars/vector/feature_writer.h"
#include "tests/mars/vector/vector_files.h"
#include "tests/support/sanitized.h"
#include "tests/support/support.h"

namespace {

constexpr std::size_t kVertices = 1'000'000;
constexpr std::int64_t kBytes = kVertices * sizeof(glm::dvec2);

std::int64_t status_kib(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::int64_t value = -1;
    if (word == key && status >> value) return value;
  }
  return -1;
}

// Forgets the highest memory that the process has had.
bool reset_peak() {
  malloc_trim(0);
  std::ofstream file("/proc/self/clear_refs");
  return static_cast<bool>(file << 5 << std::flush);
}

// A layer of spirals with so many vertices each.
mars::FeatureLayer spirals(std::size_t each) {
  mars::FeatureLayer layer;
  layer.name = "spirals";
  for (std::size_t begin = 0; begin < kVertices; begin += each) {
    std::vector<glm::dvec2> line;
    for (std::size_t i = 0; i < each; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(each);
      line.emplace_back(137 + 20 * t * std::cos(60 * t), 20 * t * std::sin(60 * t));
    }
    layer.features.push_back(
        {static_cast<std::int64_t>(begin / each), {{mars::ShapeKind::line, {std::move(line)}}}, {}, ""});
  }
  return layer;
}

class LargeVector : public ::testing::Test {
 protected:
  // Writes lines as text, which is quicker than GDAL.
  static void write_geojson(const std::filesystem::path& path, const mars::FeatureLayer& layer) {
    std::ofstream file(path);
    file << std::fixed << std::setprecision(5) << R"({"type":"FeatureCollection","features":[)";
    for (const mars::Feature& feature : layer.features) {
      file << (feature.number == 0 ? "" : ",\n")
           << R"({"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[)";
      const auto& line = feature.shapes[0].rings[0];
      for (std::size_t i = 0; i < line.size(); ++i)
        file << (i == 0 ? '[' : ',') << (i == 0 ? "" : "[") << line[i].x << ',' << line[i].y << ']';
      file << "]}}";
    }
    file << "]}";
  }

  // Reads a file of a million vertices. Expects no more memory at any time than `times` the bytes of the vertices.
  void expect_small(const std::string& name, std::size_t each, const std::string& driver, double times) const {
    SCOPED_TRACE(name);
    const bool is_text = driver == "GeoJSON";
    const auto first = folder_ / (driver.empty() ? name : "source.gpkg");
    if (is_text) write_geojson(folder_ / name, spirals(each));
    if (!is_text) mars::write_features(first, spirals(each), {mars::kMarsRadius_m, "Mars", ""});
    if (!is_text && !driver.empty()) {
      ASSERT_TRUE(vector_files::translate(first, folder_ / name, {"-f", driver}));
    }
    const bool counts = reset_peak();
    const std::int64_t before = status_kib("VmRSS:");
    const auto layers = vector_files::read(folder_ / name);
    const std::int64_t peak = status_kib("VmHWM:") - before;
    ASSERT_EQ(layers.size(), 1U);
    EXPECT_EQ(vector_files::vertices(layers[0]).size(), kVertices);
    RecordProperty(name + "_kib", static_cast<int>(peak));
    if (counts && before > 0 && !test_support::kIsSanitized) {
      EXPECT_LT(static_cast<double>(peak) * 1024, times * static_cast<double>(kBytes));
    }
  }

  test_support::TempDir folder_;
};

TEST_F(LargeVector, OneLineOfAMillionVertices) {
  expect_small("one.gpkg", kVertices, "", 8);
  expect_small("one.shp", kVertices, "ESRI Shapefile", 8);
}

TEST_F(LargeVector, AThousandLinesOfAThousandVertices) {
  expect_small("many.gpkg", 1000, "", 3);
  expect_small("many.shp", 1000, "ESRI Shapefile", 3);
  expect_small("many.geojson", 1000, "GeoJSON", 3);
}

// Each of a million features has its attributes and lists.
TEST(LongLargeVector, AMillionPoints) {
  const test_support::TempDir folder;
  std::ofstream csv(folder / "points.csv");
  csv << "lon,lat,n\n";
  for (std::size_t i = 0; i < kVertices; ++i)
    csv << static_cast<double>(i % 3600) / 10 << ',' << static_cast<double>(i % 1700) / 10 - 85 << ',' << i
        << '\n';
  csv.close();
  const auto layer = vector_files::read(folder / "points.csv").at(0);
  ASSERT_EQ(layer.features.size(), kVertices);
  EXPECT_EQ(std::get<std::int64_t>(layer.features.back().values[2]), 999'999);
}

}  // namespace
