#include <gtest/gtest.h>

#include "objects/files/scene_file.h"
#include "tests/objects/files/scene_texts.h"
#include "tests/support/support.h"

namespace objects {
namespace {

using namespace test;

namespace fs = std::filesystem;

constexpr unsigned kSeed = 20261127;

std::string feature(const std::string& properties, const std::string& coordinates = "[1, 2]") {
  return R"({"type": "Feature", "properties": )" + properties +
         R"(, "geometry": {"type": "Point", "coordinates": )" + coordinates + "}}";
}

std::string collection(const std::string& features) {
  return R"({"type": "FeatureCollection", "features": [)" + features + "]}";
}

const std::string kJson = collection(
    feature(
        R"({"model": "a.glb", "name": "One", "height": 3, "heading": 90, "pitch": 1, "roll": 2.5, "scale": 4,
 "align": "slope", "fid": 7})",
        "[270, -10.5, 99]") +
    ",\n" + feature(R"({"model": "sub/b.glb", "altitude": -5, "align": "vertical", "name": null})") + ",\n" +
    feature(R"({"model": "a.glb", "name": ""})"));

TEST(SceneGeoJson, ReadsPoints) {
  const SceneFile scene = geojson(kJson);
  ASSERT_EQ(scene.models.size(), 2U);
  EXPECT_EQ(scene.models[0].name, "a.glb");
  EXPECT_EQ(scene.models[0].file, "/scenes/a.glb");
  EXPECT_EQ(scene.models[1].file, "/scenes/sub/b.glb");
  EXPECT_EQ(files_of(scene),
            (std::vector<fs::path>{"/scenes/a.geojson", "/scenes/a.glb", "/scenes/sub/b.glb"}));
  ASSERT_EQ(scene.objects.size(), 3U);
  const Placing& p = scene.objects[0].places.at(0);
  EXPECT_EQ(scene.objects[0].name, "One");
  EXPECT_EQ(p.place.lon_deg, -90);
  EXPECT_EQ(p.place.lat_deg, -10.5);
  EXPECT_EQ(p.height_m, 3);
  EXPECT_EQ(p.height_kind, HeightKind::kAboveGround);
  EXPECT_EQ(p.heading_deg, 90);
  EXPECT_EQ(p.pitch_deg, 1);
  EXPECT_EQ(p.roll_deg, 2.5);
  EXPECT_EQ(p.scale, 4);
  EXPECT_TRUE(p.follows_slope);
  EXPECT_EQ(scene.objects[1].model, 1U);
  EXPECT_EQ(scene.objects[1].name, "");
  EXPECT_EQ(scene.objects[1].places[0].height_kind, HeightKind::kAltitude);
  EXPECT_EQ(scene.objects[1].places[0].height_m, -5);
  EXPECT_EQ(scene.objects[2].model, 0U);
  EXPECT_EQ(scene.objects[2].places[0].scale, 1);
  EXPECT_TRUE(geojson(collection("")).objects.empty());
}

TEST(SceneGeoJson, MessagesNameTheFeature) {
  const std::string good = feature(R"({"model": "a"})");
  const auto second = [&good](const std::string& properties, const std::string& coordinates = "[1, 2]") {
    return collection(good + "," + feature(properties, coordinates));
  };
  const std::pair<std::string, std::string> cases[] = {
      {"[]", "expected a FeatureCollection of GeoJSON"},
      {"{}", "expected a FeatureCollection of GeoJSON"},
      {R"({"type": 3})", "expected a FeatureCollection of GeoJSON"},
      {R"({"type": "FeatureCollection"})", "features: expected a list of features"},
      {R"({"type": "FeatureCollection", "features": {}})", "features: expected a list of features"},
      {collection("3"), "features[0]: expected a Feature of GeoJSON"},
      {collection(good + R"(, {"type": "Point"})"), "features[1]: expected a Feature of GeoJSON"},
      {collection(R"({"type": "Feature", "geometry": null})"), "features[0].geometry: expected a Point"},
      {collection(R"({"type": "Feature", "geometry": 3})"), "features[0].geometry: expected a Point"},
      {collection(R"({"type": "Feature", "geometry": {"type": "LineString"}})"),
       "features[0].geometry: expected a Point"},
      {second("{}", "3"), "features[1].geometry.coordinates: expected [longitude, latitude]"},
      {second("{}", "[3]"), "features[1].geometry.coordinates: expected [longitude, latitude]"},
      {second("{}", "[1, 2, 3, 4]"), "features[1].geometry.coordinates: expected [longitude, latitude]"},
      {second("{}", "[1, 90.5]"),
       "features[1].geometry.coordinates[1]: expected a number in [-90, 90], found \"90.5\""},
      {second("{}", "[\"x\", 1]"),
       "features[1].geometry.coordinates[0]: expected a number in [-360, 360], found \"x\""},
      {second("{}", "[null, 1]"),
       "features[1].geometry.coordinates[0]: expected a number in [-360, 360], found \"null\""},
      {second("null"), "features[1].properties: expected an object with a \"model\""},
      {second("[]"), "features[1].properties: expected an object with a \"model\""},
      {second("{}"), "features[1].properties.model: expected the path of a model file"},
      {second(R"({"model": 3})"), "features[1].properties.model: expected a text, found \"3\""},
      {second(R"({"model": ""})"),
       "features[1].properties.model: expected a text of 1 to 4096 bytes without control characters, found \"\""},
      {second(R"({"model": "a", "name": []})"), "features[1].properties.name: expected a text, found a list"},
      {second(R"({"model": "a", "name": "\n"})"),
       "features[1].properties.name: expected a text of 1 to 200 bytes without control characters, found \"?\""},
      {second(R"({"model": "a", "height": "3"})"),
       "features[1].properties.height: expected a number in [-1000000, 1000000000], found \"3\""},
      {second(R"({"model": "a", "height": 1, "altitude": 1})"),
       "features[1].properties.altitude: expected altitude or height, not both"},
      {second(R"({"model": "a", "altitude": 1e10})"),
       "features[1].properties.altitude: expected a number in [-1000000, 1000000000], found \"10000000000.0\""},
      {second(R"({"model": "a", "heading": {}})"),
       "features[1].properties.heading: expected a number in [-360, 360], found an object"},
      {second(R"({"model": "a", "pitch": 361})"),
       "features[1].properties.pitch: expected a number in [-360, 360], found \"361\""},
      {second(R"({"model": "a", "roll": true})"),
       "features[1].properties.roll: expected a number in [-360, 360], found \"true\""},
      {second(R"({"model": "a", "scale": 0})"),
       "features[1].properties.scale: expected a number in (0, 1000000], found \"0\""},
      {second(R"({"model": "a", "align": "x"})"),
       "features[1].properties.align: expected vertical or slope, found \"x\""},
      {second(R"({"model": "a", "scale": 1e999})"), "has a number that is too large"},
  };
  for (const auto& [text, what] : cases) EXPECT_EQ(json_error(text), "/scenes/a.geojson: " + what) << text;
}

TEST(SceneGeoJson, SyntaxErrorsNameTheLine) {
  for (const std::string text :
       {"{\n", "{\n\"a\": NaN}", "{\n\"a\": \"\xff\"}", "{\n\"a\": Infinity}", "[1,\n2"})
    EXPECT_EQ(json_error(text), "/scenes/a.geojson:2: not JSON; a file of GeoJSON is expected") << text;
}

TEST(SceneGeoJson, HugeFilesAreRefused) {
  EXPECT_EQ(json_error(std::string(kMostSceneFileBytes + 1, ' ')),
            "/scenes/a.geojson: expected at most 64 MiB");
  EXPECT_EQ(json_error(std::string(10'000'001, '[')), "/scenes/a.geojson: expected at most 10000000 values");
  EXPECT_FALSE(is_read(geojson, std::string(1'000'000, '[')));
  EXPECT_FALSE(is_read(geojson, std::string(1'000'000, '[') + std::string(1'000'000, ']')));
  std::string many;
  for (std::size_t n = 0; n <= kMostInstances; ++n) many += "0,";
  EXPECT_EQ(json_error(collection(many + "0")),
            "/scenes/a.geojson: features: expected at most 1000000 instances in all");
}

TEST(SceneGeoJson, TruncatedFilesAreRefused) {
  for (std::size_t length = 0; length < kJson.size(); ++length)
    EXPECT_FALSE(is_read(geojson, kJson.substr(0, length)));
}

TEST(SceneGeoJson, FlippedBytesAreReadOrRefused) {
  test_support::Random random(kSeed);
  int read = 0;
  for (int n = 0; n < 5000; ++n) {
    std::string text = kJson;
    for (int k = random.integer(1, 4); k > 0; --k)
      text[static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1))] =
          static_cast<char>(random.integer(0, 255));
    read += is_read(geojson, text) ? 1 : 0;
  }
  EXPECT_GT(read, 20);
}

}  // namespace
}  // namespace objects
