// The tables [[picture]] and [[kiosk]] of scene files.
#include <gtest/gtest.h>

#include "objects/files/scene_file.h"
#include "objects/files/scene_writer.h"

namespace objects {
namespace {

const std::filesystem::path kFile = "/scenes/a.scene.toml";

SceneFile read(const std::string& text) { return parse_scene_toml("version = 1\n" + text, kFile); }

std::string error_of(const std::string& text) {
  try {
    (void)read(text);
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

const std::string kPane = "[[picture]]\nfile = \"a.png\"\nform = \"pane\"\nlon = 1\nlat = 2\nwidth_m = 3\n";
const std::string kPhoto =
    "[[picture]]\nfile = \"a.png\"\nform = \"photograph\"\nlon = 1\nlat = 2\nheight = 5\nyaw = 10\nfov = 40\n"
    "distance_m = 50\n";
const std::string kDome = "[[picture]]\nfile = \"a.png\"\nform = \"dome\"\nradius_m = 30\n";

TEST(PosterToml, ReadsAllFormsAndWritesThemBack) {
  const std::string text =
      kPane + "name = \"map\"\ntall_m = 2\nheading = 90\ntilt = 10\nopacity = 0.5\nheight = 1\n" + kPhoto +
      "pitch = -3\nroll = 2\n" + kDome +
      "fade_m = 20\nshape = \"cylinder\"\nheading = 5\nreplaces_ground = true\nlon = 4\nlat = 5\naltitude = 6\n" +
      kDome +
      "[[picture]]\nfile = \"b.jpg\"\nform = \"billboard\"\nlon = 1\nlat = 2\nwidth_m = 3\n"
      "[[kiosk]]\nname = \"k\"\nlon = 1\nlat = 2\nheading = 30\nsize_m = 4\npanorama = \"p.json\"\n"
      "[[kiosk]]\nhotspots = \"spots.txt\"\nsize_m = 6\n";
  const SceneFile scene = read(text);
  ASSERT_EQ(scene.posters.size(), 5U);
  ASSERT_EQ(scene.kiosks.size(), 2U);
  EXPECT_EQ(scene.posters[0].name, "map");
  EXPECT_EQ(scene.posters[0].pitch_deg, 10);
  EXPECT_EQ(scene.posters[1].heading_deg, 10);
  EXPECT_TRUE(scene.posters[2].is_cylinder);
  EXPECT_EQ(scene.posters[2].height_kind, HeightKind::kAltitude);
  EXPECT_FALSE(scene.posters[3].place);
  EXPECT_EQ(scene.posters[3].fade_m, 30);
  EXPECT_EQ(scene.kiosks[0].panorama, "/scenes/p.json");
  EXPECT_EQ(scene.kiosks[1].beside_m, 6);
  EXPECT_EQ(files_of(scene),
            (std::vector<std::filesystem::path>{kFile, "/scenes/a.png", "/scenes/b.jpg", "/scenes/spots.txt"}));
  const SceneFile again = parse_scene_toml(to_toml(scene, kFile), kFile);
  EXPECT_EQ(again.posters, scene.posters);
  EXPECT_EQ(to_toml(again, kFile), to_toml(scene, kFile));
}

TEST(PosterToml, RefusesWhatIsWrong) {
  const std::vector<std::string> wrong{
      "[[picture]]\n",
      kPane + "radius_m = 3\n",
      kPane + "height = 1\naltitude = 2\n",
      kPane + "opacity = 1.1\n",
      kPane + "opacity = nan\n",
      kPane + "tilt = 91\n",
      kPane + "tall_m = 0\n",
      kPhoto + "fov = 3\n",
      kPhoto + "width_m = 3\n",
      kPhoto + "roll = 400\n",
      kDome + "fade_m = 31\n",
      kDome + "height = 2\n",
      kDome + "lon = 1\nlat = 2\n",
      kDome + "shape = \"cube\"\n",
      kDome + "replaces_ground = 1\n",
      "[[picture]]\nfile = \"\"\nform = \"pane\"\nlon = 1\nlat = 2\nwidth_m = 3\n",
      "[[picture]]\nfile = \"a.png\"\nform = \"film\"\n",
      "[[picture]]\nfile = \"a.png\"\nform = \"photograph\"\nlon = 1\nlat = 2\nyaw = 1\nfov = 40\ndistance_m = 5\n",
      "[picture]\nfile = \"a.png\"\n",
      "[[kiosk]]\n",
      "[[kiosk]]\nhotspots = \"a\"\nlon = 1\n",
      "[[kiosk]]\nlon = 1\nlat = 2\nbeside_m = 3\n",
      "[[kiosk]]\nlon = 1\nlat = 92\n",
      "[[kiosk]]\nlon = 1\nlat = 2\nsize_m = -1\n",
  };
  for (const std::string& text : wrong)
    EXPECT_TRUE(error_of(text).starts_with("/scenes/a.scene.toml:")) << text;
  std::string many;
  for (std::size_t n = 0; n <= kMostPosters; ++n) many += kDome;
  EXPECT_NE(error_of(many).find("expected at most 1000 tables [[picture]]"), std::string::npos);
}

// The scene that the guide names.
TEST(PosterToml, TheExampleSceneHasItsFiles) {
  const SceneFile scene =
      read_scene_file(std::filesystem::path(VPE_SOURCE_DIR) / "scripts/scenes/gale-pictures.scene.toml");
  EXPECT_EQ(scene.posters.size(), 2U);
  EXPECT_EQ(scene.kiosks.size(), 1U);
  for (const std::filesystem::path& file : files_of(scene)) EXPECT_TRUE(std::filesystem::exists(file)) << file;
}

}  // namespace
}  // namespace objects
