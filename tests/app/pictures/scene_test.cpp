// Objects of scene files in images, films and panoramas, by both backends.
#include <algorithm>
#include <cmath>
#include <fstream>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

// The camera stands 30 km up and looks north at a tower of 20 km, 100 km away.
class SceneRender : public AppTest {
 protected:
  void SetUp() override {
    AppTest::SetUp();
    // A white tower, y up, a kilometre wide and deep, of unit height.
    std::ofstream(dir_ / "tower.obj") << "v -0.5 0 -0.5\nv 0.5 0 -0.5\nv 0.5 1 -0.5\nv -0.5 1 -0.5\n"
                                         "v -0.5 0 0.5\nv 0.5 0 0.5\nv 0.5 1 0.5\nv -0.5 1 0.5\n"
                                         "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    write_scene("[[object]]\nmodel = \"tower\"\nlon = 20\nlat = 11.7\nscale = 20000\n");
  }

  void write_scene(const std::string& objects) const {
    std::ofstream(dir_ / "a.scene.toml") << "version = 1\n[[model]]\nname = \"tower\"\nfile = \"tower.obj\"\n"
                                         << objects;
  }

  Words words(const std::string& backend, const std::string& output, const Words& more = {}) const {
    Words all{"render",    planet().string(),
              "--pose",    "20,10,30000,0,-12,0",
              "--size",    "160x120",
              "--backend", backend,
              "--scene",   "a.scene.toml",
              "--set",     "lod.tolerance=0.3",
              "-o",        output};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(SceneRender, BothBackendsShowTheSameObject) {
  const Result by_rays = vpe(words("ray", "r.png", {"--range", "r.tif", "--certificate", "r.json"}));
  ASSERT_EQ(by_rays.exit_code, 0) << by_rays.err;
  const Result by_triangles = vpe(words("polygon", "p.png", {"--range", "p.tif", "--certificate", "p.json"}));
  ASSERT_EQ(by_triangles.exit_code, 0) << by_triangles.err;
  const vpe::core::FloatImage a = vpe::core::read_tiff(dir_ / "r.tif");
  const vpe::core::FloatImage b = vpe::core::read_tiff(dir_ / "p.tif");
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  // The tower's side is 90 km away; ground at its foot is as far, the sky has no range.
  const auto shows_tower = [](float r) { return r > 85'000 && r < 95'000; };
  int tower = 0;
  int different = 0;
  for (std::size_t n = 0; n < a.pixels.size(); ++n) {
    if (shows_tower(a.pixels[n])) ++tower;
    if (shows_tower(a.pixels[n]) != shows_tower(b.pixels[n])) ++different;
  }
  EXPECT_GT(tower, 300);
  EXPECT_LE(different, static_cast<int>(a.pixels.size()) / 200);
  const auto certificate = parse_json(read_text(dir_ / "r.json"));
  EXPECT_EQ(certificate["objects_drawn"], 1);
  EXPECT_EQ(certificate["objects_error_px"], 0);
  // Without the scene the certificate does not speak of objects, and the image is another.
  Words without = words("ray", "w.png", {"--certificate", "w.json"});
  without.erase(std::find(without.begin(), without.end(), "--scene"),
                std::find(without.begin(), without.end(), "--set"));
  ASSERT_EQ(vpe(without).exit_code, 0);
  EXPECT_FALSE(parse_json(read_text(dir_ / "w.json")).contains("objects_drawn"));
  EXPECT_NE(read_text(dir_ / "w.png"), read_text(dir_ / "r.png"));
}

// A plume of 20 km in place of the tower: the same veil and ranges, and its seed is part of the picture.
TEST_F(SceneRender, BothBackendsShowTheSameVolume) {
  const auto write = [&](int seed) {
    write_scene(
        "[[volume]]\nname = \"dust\"\nkind = \"plume\"\nheight_m = 20000\nradius_m = 5000\n"
        "optical_depth = 4\nvoxels = 48\nseed = " +
        std::to_string(seed) + "\n[[object]]\nmodel = \"dust\"\nlon = 20\nlat = 11.7\n");
  };
  write(1);
  ASSERT_EQ(vpe(words("ray", "r.png", {"--range", "r.tif", "--certificate", "r.json"})).exit_code, 0);
  ASSERT_EQ(vpe(words("polygon", "p.png", {"--range", "p.tif"})).exit_code, 0);
  const vpe::core::FloatImage a = vpe::core::read_tiff(dir_ / "r.tif");
  const vpe::core::FloatImage b = vpe::core::read_tiff(dir_ / "p.tif");
  const vpe::core::RgbImage by_rays = vpe::core::read_image(dir_ / "r.png");
  const vpe::core::RgbImage by_triangles = vpe::core::read_image(dir_ / "p.png");
  const auto shows_plume = [](float r) { return r > 90'000 && r < 110'000; };
  int plume = 0;
  int different = 0;
  int other_colour = 0;
  for (std::size_t n = 0; n < a.pixels.size(); ++n) {
    plume += shows_plume(a.pixels[n]) ? 1 : 0;
    different += shows_plume(a.pixels[n]) != shows_plume(b.pixels[n]) ? 1 : 0;
    other_colour += std::abs(by_rays.pixels[n].r - by_triangles.pixels[n].r) > 30 ? 1 : 0;
  }
  EXPECT_GT(plume, 100);
  EXPECT_LE(different, static_cast<int>(a.pixels.size()) / 200);
  EXPECT_LE(other_colour, static_cast<int>(a.pixels.size()) / 50);
  EXPECT_EQ(parse_json(read_text(dir_ / "r.json"))["objects_drawn"], 1);
  write(2);
  ASSERT_EQ(vpe(words("ray", "s.png")).exit_code, 0);
  EXPECT_NE(read_text(dir_ / "s.png"), read_text(dir_ / "r.png"));
}

TEST_F(SceneRender, AnImageIsDrawnAgainFromItsRecipe) {
  ASSERT_EQ(vpe(words("ray", "a.png")).exit_code, 0);
  const Result again = vpe({"render", planet().string(), "--from-image", "a.png", "-o", "b.png"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_text(dir_ / "a.png"), read_text(dir_ / "b.png"));
}

TEST_F(SceneRender, WhatIsWrongIsToldBeforeAnyWork) {
  const auto fails = [&](int code, const std::string& words_of_error) {
    const Result result = vpe(words("ray", "x.png"));
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_NE(result.err.find(words_of_error), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(dir_ / "x.png"));
  };
  write_scene("[[object]]\nmodel = \"tower\"\nlon = 20\nlat = 95\n");
  fails(1, "a.scene.toml:8: ");
  write_scene("[[object]]\nmodel = \"tower\"\nlongitude = 20\nlat = 9\n");
  fails(1, "longitude");
  write_scene("[[object]]\nmodel = \"mast\"\nlon = 20\nlat = 9\n");
  fails(1, "mast");
  write_scene("[[object]]\nmodel = \"tower\"\nlon = 20\nlat = 11.7\n");
  std::filesystem::remove(dir_ / "tower.obj");
  fails(1, "tower.obj");
  std::filesystem::remove(dir_ / "a.scene.toml");
  fails(1, "a.scene.toml");
}

TEST_F(SceneRender, OutputsDoNotReplaceTheScene) {
  const Result result = vpe(words("ray", "a.png", {"--certificate", "a.scene.toml"}));
  EXPECT_NE(result.exit_code, 0);
  EXPECT_NE(read_text(dir_ / "a.scene.toml").find("[[object]]"), std::string::npos);
}

TEST_F(SceneRender, BothEyesSeeObjects) {
  const Result full = vpe(words("ray", "s.png", {"--stereo", "sbs", "--eye-base", "3000"}));
  ASSERT_EQ(full.exit_code, 0) << full.err;
  const Result carried =
      vpe(words("ray", "c.png", {"--stereo", "sbs", "--eye-base", "3000", "--stereo-method", "reproject"}));
  ASSERT_EQ(carried.exit_code, 0) << carried.err;
  const vpe::core::RgbImage a = vpe::core::read_image(dir_ / "s.png");
  const vpe::core::RgbImage b = vpe::core::read_image(dir_ / "c.png");
  double sum = 0;
  int far = 0;
  for (std::size_t n = 0; n < a.pixels.size(); ++n) {
    const int d = std::abs(a.pixels[n].g - b.pixels[n].g);
    sum += d;
    far += d > 60 ? 1 : 0;
  }
  EXPECT_LT(sum / static_cast<double>(a.pixels.size()), 3);
  EXPECT_LT(far, static_cast<int>(a.pixels.size()) / 100);
}

TEST_F(SceneRender, APanoramaShowsObjects) {
  const Words all{
      "panorama", planet().string(), "--at",         "20,10",     "--altitude", "30000", "--width",
      "512",      "--scene",         "a.scene.toml", "--backend", "ray",        "--set", "samples=1"};
  const auto draw = [&](const std::string& output, bool with_scene) {
    Words w = all;
    if (!with_scene)
      w.erase(std::find(w.begin(), w.end(), "--scene"), std::find(w.begin(), w.end(), "--backend"));
    w.insert(w.end(), {"-o", output});
    const Result result = vpe(w);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / output);
  };
  const vpe::core::RgbImage with = draw("w.png", true);
  const vpe::core::RgbImage without = draw("o.png", false);
  ASSERT_EQ(with.pixels.size(), without.pixels.size());
  int different = 0;
  int elsewhere = 0;
  for (int y = 0; y < with.height; ++y) {
    for (int x = 0; x < with.width; ++x) {
      const auto n =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(with.width) + static_cast<std::size_t>(x);
      if (with.pixels[n] == without.pixels[n]) continue;
      ++different;
      // North is in the middle or at the border, whichever the map says: the tower and its shadow are 40 degrees of it.
      const int from_middle = std::abs(x - with.width / 2);
      if (from_middle > 57 && from_middle < with.width / 2 - 57) ++elsewhere;
    }
  }
  EXPECT_GT(different, 100);
  EXPECT_EQ(elsewhere, 0);
}

TEST_F(SceneRender, ObjectsMoveWithTheTimeOfAFlight) {
  write_scene("[[path]]\nmodel = \"tower\"\nscale = 20000\npoints = [[0, 19, 11.7], [10, 21, 11.7]]\n");
  std::ofstream(dir_ / "f.flight") << "flight 1\nview fov=60 size=96x72 fps=1\n"
                                      "at 0 pose lon=20 lat=10 alt=30000 yaw=0 pitch=-12\n"
                                      "at 10 pose lon=20 lat=10 alt=30000 yaw=0 pitch=-12\n";
  const auto fly = [&](const std::string& folder, const Words& more) {
    Words w{"fly", "f.flight", planet().string(), "--scene", "a.scene.toml", "--backend", "ray", "-o", folder};
    w.insert(w.end(), more.begin(), more.end());
    const Result result = vpe(w);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  fly("frames", {});
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(dir_ / "frames")) {
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  ASSERT_GT(files.size(), 5U);
  // The camera stands still, so only the tower can be the difference.
  for (std::size_t n = 1; n < files.size(); ++n)
    EXPECT_NE(read_text(files[n - 1]), read_text(files[n])) << files[n];
  // Pixels of things that move are not taken from other frames.
  fly("reused", {"--reuse", "1"});
  for (const auto& file : files)
    EXPECT_EQ(vpe::core::read_image(file).pixels,
              vpe::core::read_image(dir_ / "reused" / file.filename()).pixels);
}

// A flight's lines of objects do what a [[path]] does, and can be read back from the film's log.
TEST_F(SceneRender, AFlightMovesAndHidesObjects) {
  const std::string pose = "pose lon=20 lat=10 alt=30000 yaw=0 pitch=-12\n";
  const std::string view = "view fov=60 size=96x72 fps=1\nat 0 " + pose;
  const auto fly = [&](const std::string& flight, const std::string& folder, const Words& more = {}) {
    std::ofstream(dir_ / "f.flight") << flight;
    Words w{"fly", "f.flight", planet().string(), "--scene", "a.scene.toml", "--backend", "ray", "-o", folder};
    w.insert(w.end(), more.begin(), more.end());
    return vpe(w);
  };
  const auto frame = [&](const std::string& folder, int n) {
    return vpe::core::read_image(dir_ / folder / ("frame_00000" + std::to_string(n) + ".png")).pixels;
  };
  write_scene("[[path]]\nmodel = \"tower\"\nscale = 20000\npoints = [[0, 19, 11.7], [4, 21, 11.7]]\n");
  ASSERT_EQ(fly("flight 1\n" + view + "at 6 " + pose, "path").exit_code, 0);
  write_scene("[[object]]\nmodel = \"tower\"\nname = \"the tower\"\nlon = 20\nlat = 11.7\nscale = 20000\n");
  const std::string lines =
      "at 0 object \"the tower\" lon=19 lat=11.7\nat 4 object \"the tower\" lon=21 lat=11.7\n"
      "at 5 object \"the tower\" show=off\n";
  const Result moved = fly("flight 1.2\n" + view + lines + "at 6 " + pose, "moved", {"--log", "log.flight"});
  ASSERT_EQ(moved.exit_code, 0) << moved.err;
  for (int n = 0; n < 5; ++n) EXPECT_EQ(frame("moved", n), frame("path", n)) << n;
  EXPECT_NE(frame("moved", 1), frame("moved", 2));
  std::ofstream(dir_ / "bare.flight") << "flight 1\n" << view << "at 6 " << pose;
  ASSERT_EQ(vpe({"fly", "bare.flight", planet().string(), "--backend", "ray", "-o", "none"}).exit_code, 0);
  EXPECT_EQ(frame("moved", 5), frame("none", 5));
  EXPECT_NE(frame("moved", 4), frame("none", 4));
  // Pixels of things that move are not taken from other frames.
  ASSERT_EQ(fly("flight 1.2\n" + view + lines + "at 6 " + pose, "reused", {"--reuse", "1"}).exit_code, 0);
  EXPECT_EQ(frame("reused", 2), frame("moved", 2));
  // The log is the same flight.
  ASSERT_EQ(fly(read_text(dir_ / "log.flight"), "replayed").exit_code, 0);
  for (int n = 0; n < 6; ++n) EXPECT_EQ(frame("replayed", n), frame("moved", n)) << n;
}

TEST_F(SceneRender, AFlightWithUnknownObjectsIsRefusedBeforeAnyWork) {
  const auto fly = [&](const std::string& name, const Words& more) {
    std::ofstream(dir_ / "f.flight") << "flight 1.2\nat 0 pose lon=20 lat=10 alt=30000\nat 1 object " << name
                                     << " show=off\n";
    Words w{"fly", "f.flight", planet().string(), "--backend", "ray", "-o", "frames"};
    w.insert(w.end(), more.begin(), more.end());
    const Result result = vpe(w);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_FALSE(std::filesystem::exists(dir_ / "frames"));
    return result.err;
  };
  EXPECT_NE(
      fly("ghost", {"--scene", "a.scene.toml"}).find("the name \"ghost\", which the flight moves, found none"),
      std::string::npos);
  EXPECT_NE(
      fly("ghost", {}).find("moves the object \"ghost\" at 1 s, but there is no scene then; give --scene"),
      std::string::npos);
}

}  // namespace
}  // namespace app_test
