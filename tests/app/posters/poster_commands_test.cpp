// Images in the world in films, stereo pairs and panoramas, and kiosks, as a user makes them.
#include <cmath>
#include <numbers>

#include "panorama/metadata/open_panorama.h"
#include "tests/app/posters/poster_scene_fixture.h"

namespace app_test {
namespace {

constexpr Rgb kMagenta{255, 0, 255};

// A pane of 1200 m by 800 m, 4 km to the north of the camera's place, which faces the camera.
constexpr const char* kPane =
    "[[picture]]\nfile = \"magenta.png\"\nform = \"pane\"\nlon = 10\nlat = 5.0674829\naltitude = 2600\n"
    "width_m = 1200\ntall_m = 800\nheading = 180\n";
constexpr const char* kPose = "10,5,3000,0,0,0";

struct Box {
  int left = 1 << 30;
  int right = -1;
  int top = 1 << 30;
  int bottom = -1;
  int pixels = 0;
};

// Returns where pixels of columns [begin, end) are magenta.
Box magenta_in(const RgbImage& image, int begin, int end) {
  Box box;
  for (int y = 0; y < image.height; ++y) {
    for (int x = begin; x < end; ++x) {
      if (steps_between(image.pixels[pixel_at(image, x, y)], kMagenta) > 40) continue;
      box.left = std::min(box.left, x - begin);
      box.right = std::max(box.right, x - begin);
      box.top = std::min(box.top, y);
      box.bottom = std::max(box.bottom, y);
      ++box.pixels;
    }
  }
  return box;
}

class PosterCommands : public PosterSceneTest {
 protected:
  void SetUp() override {
    write_plain("magenta.png", kMagenta);
    write_scene(kPane);
  }
};

// With a vertical field of 60 degrees a pixel at 4 km is 4000 m / 207.8.
TEST_F(PosterCommands, BothBackendsShowThePaneWhereItIs) {
  for (const std::string backend : {"ray", "polygon"}) {
    const Box box = magenta_in(draw_scene("a.png", kPose, {"--backend", backend}), 0, 320);
    EXPECT_NEAR(box.right - box.left + 1, 1200 / 4000.0 * 207.8, 2) << backend;
    EXPECT_NEAR(box.bottom - box.top + 1, 800 / 4000.0 * 207.8, 2) << backend;
    EXPECT_NEAR(0.5 * (box.left + box.right), 159.5, 1) << backend;
    EXPECT_NEAR(0.5 * (box.top + box.bottom), 119.5, 1) << backend;
  }
}

TEST_F(PosterCommands, AFilmShowsItInEachFrameAsRenderDoes) {
  write_text(
      dir_ / "f.flight",
      "flight 1\nview fov=60 size=320x240 fps=1\nat 0 set mode=coloured palette.low=-800 palette.high=800 "
      "sun.azimuth=300 sun.elevation=25\nat 0 pose lon=10 lat=5 alt=3000 yaw=0 pitch=0\n"
      "at 4 pose lon=10 lat=5.03 alt=3000 yaw=0 pitch=0\n");
  for (const std::string backend : {"ray", "polygon"}) {
    const Result film = vpe({"fly", "f.flight", hills().string(), "--scene", "a.scene.toml", "--backend",
                             backend, "-o", backend, "-q"});
    ASSERT_EQ(film.exit_code, 0) << film.err;
    const auto frame = [&](int n) {
      return vpe::core::read_image(dir_ / backend / ("frame_00000" + std::to_string(n) + ".png"));
    };
    EXPECT_EQ(frame(0).pixels, draw_scene("first.png", kPose, {"--backend", backend}).pixels);
    int last = 0;
    for (int n = 0; n < 4; ++n) {
      const int pixels = magenta_in(frame(n), 0, 320).pixels;
      EXPECT_GT(pixels, last) << backend << " " << n;
      last = pixels;
    }
  }
  // Pixels that are taken from former frames are those of a film without: ground alone is carried.
  const Result reused = vpe({"fly", "f.flight", hills().string(), "--scene", "a.scene.toml", "--backend", "ray",
                             "--reuse", "1", "-o", "reused", "-q"});
  ASSERT_EQ(reused.exit_code, 0) << reused.err;
  for (int n = 0; n < 4; ++n) {
    const std::string name = "frame_00000" + std::to_string(n) + ".png";
    const Box drawn = magenta_in(vpe::core::read_image(dir_ / "ray" / name), 0, 320);
    const Box carried = magenta_in(vpe::core::read_image(dir_ / "reused" / name), 0, 320);
    EXPECT_NEAR(carried.left, drawn.left, 1) << n;
    EXPECT_NEAR(carried.right, drawn.right, 1) << n;
    EXPECT_NEAR(carried.pixels, drawn.pixels, 0.03 * drawn.pixels) << n;
  }
}

// Parallel eyes 300 m apart see what is 4 km away 300 / 4000 of the focal length apart.
TEST_F(PosterCommands, BothEyesOfAPairShowIt) {
  const double disparity = 300 / 4000.0 * 207.8;
  for (const Words& method : {Words{"--stereo-method", "full", "--backend", "ray"},
                              Words{"--stereo-method", "full", "--backend", "polygon"},
                              Words{"--stereo-method", "reproject", "--backend", "ray"}}) {
    Words words{"--stereo", "sbs", "--eye-base", "300"};
    words.insert(words.end(), method.begin(), method.end());
    const RgbImage pair = draw_scene("pair.png", kPose, words);
    ASSERT_EQ(pair.width % 2, 0);
    const Box left = magenta_in(pair, 0, pair.width / 2);
    const Box right = magenta_in(pair, pair.width / 2, pair.width);
    EXPECT_GT(left.pixels, 2000) << method[1];
    EXPECT_NEAR(left.pixels, right.pixels, 0.04 * left.pixels) << method[1];
    EXPECT_NEAR(left.left - right.left, disparity, 1.5) << method[1];
    EXPECT_NEAR(left.right - right.right, disparity, 1.5) << method[1];
  }
}

TEST_F(PosterCommands, APanoramaShowsItAtItsAzimuths) {
  for (const std::string projection : {"cylinder", "equirectangular", "facets"}) {
    Words words{"panorama", hills().string(), "--at",         "10,5",     "--altitude", "3000",    "--width",
                "1440",     "--elevation",    "-30,20",       "--from",   "-60",        "--to",    "60",
                "--scene",  "a.scene.toml",   "--projection", projection, "-o",         "pan.png", "-q"};
    if (projection == "facets") words.insert(words.end(), {"--facets", "6"});
    const Words as = look();
    words.insert(words.end(), as.begin(), as.end());
    const Result made = vpe(words);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const RgbImage image = vpe::core::read_image(dir_ / "pan.png");
    const panorama::PanoramaMap map = panorama::describe(dir_ / "pan.png").map;
    const auto place = [&](double right_m, double up_m) {
      const double level_m = std::hypot(right_m, 4000.0);
      return map.to_pixel({std::atan2(right_m, 4000.0) * 180 / std::numbers::pi,
                           std::atan2(up_m, level_m) * 180 / std::numbers::pi});
    };
    // The middle, and both sides of each edge. The pane hangs from 400 m below the camera to 400 m above it.
    const auto is_magenta = [&](double right_m, double up_m) {
      const auto at = place(right_m, up_m);
      EXPECT_TRUE(at) << projection;
      return at &&
             steps_between(image.pixels[pixel_at(image, static_cast<int>(at->x), static_cast<int>(at->y))],
                           kMagenta) < 40;
    };
    constexpr double kBeside_m = 25;
    EXPECT_TRUE(is_magenta(0, 0)) << projection;
    for (const double side : {-1.0, 1.0}) {
      EXPECT_TRUE(is_magenta(side * (600 - kBeside_m), 0)) << projection << side;
      EXPECT_FALSE(is_magenta(side * (600 + kBeside_m), 0)) << projection << side;
      EXPECT_TRUE(is_magenta(0, side * (400 - kBeside_m))) << projection << side;
      EXPECT_FALSE(is_magenta(0, side * (400 + kBeside_m))) << projection << side;
    }
  }
}

TEST_F(PosterCommands, WhatIsWrongIsToldBeforeAnyWork) {
  const auto fails = [&](const std::string& tables, const std::string& what) {
    write_scene(tables);
    const Result result =
        vpe({"render", hills().string(), "--pose", kPose, "--scene", "a.scene.toml", "-o", "x.png"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(says(result.err, {what}));
    EXPECT_FALSE(exists("x.png"));
  };
  const std::string pane = kPane;
  fails(pane + "radius_m = 3\n", "radius_m");
  fails("[[picture]]\nfile = \"none.png\"\nform = \"pane\"\nlon = 10\nlat = 5\nwidth_m = 3\n", "none.png");
  write_text(dir_ / "text.png", "a letter");
  fails("[[picture]]\nfile = \"text.png\"\nform = \"pane\"\nlon = 10\nlat = 5\nwidth_m = 3\n", "text.png");
  fails("[[picture]]\nfile = \"magenta.png\"\nform = \"dome\"\nradius_m = 3\n", "magenta.png");
  fails("[[kiosk]]\nhotspots = \"none.txt\"\n", "none.txt");
  write_text(dir_ / "bad.txt", "spot \"a\" 10 95 2 a.json\n");
  fails("[[kiosk]]\nhotspots = \"bad.txt\"\n", "bad.txt");
}

}  // namespace
}  // namespace app_test
