#include <gtest/gtest.h>

#include "objects/files/scene_file.h"
#include "tests/objects/files/scene_texts.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace objects {
namespace {

using namespace test;

namespace fs = std::filesystem;

constexpr unsigned kSeed = 20261127;

TEST(SceneToml, ReadsModels) {
  const SceneFile scene = toml(kWhole);
  EXPECT_EQ(scene.path, "/scenes/a.scene.toml");
  ASSERT_EQ(scene.models.size(), 3U);
  EXPECT_EQ(scene.models[0].name, "rover");
  EXPECT_EQ(scene.models[0].file, "/scenes/rover.glb");
  EXPECT_EQ(scene.models[0].unit_m, 0.01);
  EXPECT_EQ(scene.models[0].up, UpAxis::kY);
  EXPECT_EQ(scene.models[1].file, "/data/stone.stl");
  EXPECT_EQ(scene.models[1].up, UpAxis::kZ);
  EXPECT_EQ(scene.models[2].unit_m, 1);
  EXPECT_EQ(scene.models[2].up, UpAxis::kAuto);
}

TEST(SceneToml, ReadsObjects) {
  const SceneFile scene = toml(kWhole);
  ASSERT_EQ(scene.objects.size(), 2U);
  const ObjectEntry& rover = scene.objects[0];
  EXPECT_EQ(rover.name, "Rover 1");
  EXPECT_EQ(rover.model, 0U);
  EXPECT_EQ(rover.interest_levels, 2);
  ASSERT_EQ(rover.places.size(), 1U);
  const Placing& p = rover.places[0];
  EXPECT_EQ(p.place.lon_deg, -90);
  EXPECT_EQ(p.place.lat_deg, -4.6);
  EXPECT_EQ(p.height_kind, HeightKind::kAboveGround);
  EXPECT_EQ(p.height_m, 1.5);
  EXPECT_EQ(p.heading_deg, 90);
  EXPECT_EQ(p.pitch_deg, -3);
  EXPECT_EQ(p.roll_deg, 2.5);
  EXPECT_EQ(p.scale, 2);
  EXPECT_TRUE(p.follows_slope);
  const ObjectEntry& stones = scene.objects[1];
  EXPECT_EQ(stones.name, "");
  EXPECT_EQ(stones.model, 1U);
  EXPECT_EQ(stones.interest_levels, 0);
  EXPECT_EQ(stones.ground.kind, GroundRole::Kind::kNone);
  ASSERT_EQ(stones.places.size(), 2U);
  EXPECT_EQ(stones.places[0].heading_deg, 5);
  EXPECT_EQ(stones.places[1].heading_deg, 30);
  EXPECT_EQ(stones.places[1].place.lon_deg, 3);
  EXPECT_EQ(stones.places[1].place.lat_deg, 4.5);
  EXPECT_EQ(stones.places[1].height_kind, HeightKind::kAltitude);
  EXPECT_EQ(stones.places[1].height_m, 100);
  EXPECT_EQ(stones.places[1].scale, 1);
  EXPECT_FALSE(stones.places[1].follows_slope);
}

TEST(SceneToml, ReadsPartsOfTheGround) {
  const SceneFile scene = toml(
      "version = 1\n[[model]]\nname = \"pit\"\nfile = \"pit.glb\"\n"
      "[[model]]\nname = \"fog\"\nfile = \"fog.vdb\"\n"
      "[[object]]\nmodel = \"pit\"\nlon = 1\nlat = 2\nground = \"cut\"\nvoxel_m = 0.5\n"
      "[[object]]\nmodel = \"fog\"\nat = [[1, 2], [3, 4, 5]]\nground = \"add\"\nsolid_above = 0.02\n");
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[0].ground.kind, GroundRole::Kind::kCut);
  EXPECT_EQ(scene.objects[0].ground.voxel_m, 0.5);
  EXPECT_EQ(scene.objects[0].ground.solid_above_per_m, 0);
  EXPECT_EQ(scene.objects[1].ground.kind, GroundRole::Kind::kAdd);
  EXPECT_EQ(scene.objects[1].ground.voxel_m, 0);
  EXPECT_EQ(scene.objects[1].ground.solid_above_per_m, 0.02);
  EXPECT_EQ(scene.objects[1].places.size(), 2U);
}

TEST(SceneToml, ReadsScattersAndPaths) {
  const SceneFile scene = toml(kWhole);
  ASSERT_EQ(scene.scatters.size(), 2U);
  const ScatterEntry& field = scene.scatters[0];
  EXPECT_EQ(field.name, "field");
  EXPECT_EQ(field.models, (std::vector<std::size_t>{1, 2}));
  ASSERT_EQ(field.polygon.size(), 3U);
  EXPECT_EQ(field.polygon[1].lon_deg, -179.9);
  EXPECT_EQ(field.polygon[2].lat_deg, 0.1);
  EXPECT_EQ(field.seed, 77U);
  EXPECT_EQ(std::get<RockAbundance>(field.distribution).k, 0.05);
  EXPECT_EQ(field.least_diameter_m, 0.5);
  EXPECT_EQ(field.most_diameter_m, 4);
  EXPECT_EQ(field.buried, 0.25);
  EXPECT_TRUE(field.follows_slope);
  EXPECT_TRUE(field.tumbles);
  EXPECT_EQ(field.most, 5000U);
  EXPECT_EQ(field.where, "/scenes/a.scene.toml:39");
  const ScatterEntry& plain = scene.scatters[1];
  EXPECT_EQ(std::get<PowerLaw>(plain.distribution).density_per_m2, 0.01);
  EXPECT_EQ(std::get<PowerLaw>(plain.distribution).exponent, 2.5);
  EXPECT_EQ(plain.seed, 1U);
  EXPECT_EQ(plain.buried, 0.3);
  EXPECT_FALSE(plain.follows_slope);
  EXPECT_FALSE(plain.tumbles);
  EXPECT_EQ(plain.most, 0U);
  ASSERT_EQ(scene.paths.size(), 2U);
  const PathEntry& drive = scene.paths[0];
  EXPECT_EQ(drive.name, "drive");
  EXPECT_EQ(drive.model, 0U);
  ASSERT_EQ(drive.points.size(), 3U);
  EXPECT_EQ(drive.points[1].time_s, 10.5);
  EXPECT_EQ(drive.points[1].place.lon_deg, 1);
  EXPECT_EQ(drive.points[1].place.lat_deg, 2);
  EXPECT_EQ(drive.points[1].heading_deg, 45);
  EXPECT_FALSE(drive.points[2].heading_deg.has_value());
  EXPECT_EQ(drive.scale, 0.5);
  EXPECT_EQ(drive.wheelbase_m, 2.9);
  EXPECT_EQ(drive.track_m, 2.3);
  EXPECT_EQ(scene.paths[1].wheelbase_m, 0);
  EXPECT_EQ(scene.paths[1].points[0].place.lat_deg, 90);
}

TEST(SceneToml, AcceptsAFileWithoutObjects) {
  EXPECT_TRUE(toml("version = 1").models.empty());
  EXPECT_EQ(
      toml(kModel + "[[object]]\nmodel = \"m\"\nat = [\n[+1, 2],\n[\n+3e-1, -4e+0]]").objects[0].places.size(),
      2U);
  EXPECT_EQ(toml("# \xc3\xa9\n" + kModel + "[[object]]\nname = \"\xc3\xa9\"\nmodel = 'm'\nlon = 0\nlat = 0\n")
                .objects[0]
                .name,
            "\xc3\xa9");
  EXPECT_TRUE(toml("\xef\xbb\xbfversion = 1").models.empty());
  EXPECT_TRUE(toml("# a comment with dots .......................\nversion = 1\r\n").objects.empty());
}

TEST(SceneToml, FilesAreTheSceneAndItsModelsOnce) {
  SceneFile scene = toml(kWhole);
  scene.models.push_back({"again", scene.models[0].file});
  EXPECT_EQ(files_of(scene), (std::vector<fs::path>{"/scenes/a.scene.toml", "/scenes/rover.glb",
                                                    "/data/stone.stl", "/scenes/plain.obj"}));
}

TEST(SceneToml, TruncatedFilesAreReadOrRefused) {
  int read = 0;
  for (std::size_t length = 0; length < kWhole.size(); ++length)
    read += is_read(toml, kWhole.substr(0, length)) ? 1 : 0;
  EXPECT_GT(read, 10);
  EXPECT_LT(read, 200);
}

TEST(SceneToml, FlippedBytesAreReadOrRefused) {
  test_support::Random random(kSeed);
  int read = 0;
  for (int n = 0; n < 3000; ++n) {
    std::string text = kWhole;
    for (int k = random.integer(1, 4); k > 0; --k)
      text[static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1))] =
          static_cast<char>(random.integer(0, 255));
    read += is_read(toml, text) ? 1 : 0;
  }
  EXPECT_GT(read, 20);
}

TEST(SceneFile, ReadsByTheNameOfTheFile) {
  const test_support::TempDir folder;
  const std::string_view json = R"({"type": "FeatureCollection", "features": [{"type": "Feature",
    "properties": {"model": "a.glb"}, "geometry": {"type": "Point", "coordinates": [1, 2]}}]})";
  vpe::base::write_file(folder / "a.scene.toml", std::string_view(kWhole));
  vpe::base::write_file(folder / "b.geojson", json);
  vpe::base::write_file(folder / "c.json", json);
  vpe::base::write_file(folder / "d.txt", json);
  vpe::base::write_file(folder / "e.toml", std::string_view("version = 3"));
  EXPECT_EQ(read_scene_file(folder / "a.scene.toml").objects.size(), 2U);
  EXPECT_EQ(read_scene_file(folder / "a.scene.toml").models[2].file, folder / "plain.obj");
  EXPECT_EQ(read_scene_file(folder / "b.geojson").objects.size(), 1U);
  EXPECT_EQ(read_scene_file(folder / "c.json").objects.size(), 1U);
  EXPECT_THROW(read_scene_file(folder / "d.txt"), vpe::base::FileError);
  EXPECT_THROW(read_scene_file(folder / "none.scene.toml"), vpe::base::FileError);
  EXPECT_THROW(read_scene_file(folder.path()), vpe::base::FileError);
  fs::create_directory(folder / "f.toml");
  EXPECT_THROW(read_scene_file(folder / "f.toml"), vpe::base::FileError);
  const auto read = [](const std::string& path) { read_scene_file(path); };
  EXPECT_EQ(error_of(read, (folder / "e.toml").string()),
            (folder / "e.toml").string() + ":1: version: expected an integer in [1, 1], found 3");
  fs::resize_file(folder / "e.toml", kMostSceneFileBytes + 1);
  EXPECT_THROW(read_scene_file(folder / "e.toml"), vpe::base::FileError);
}

}  // namespace
}  // namespace objects
