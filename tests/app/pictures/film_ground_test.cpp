// Films whose flight changes the ground.
#include <algorithm>
#include <cstdlib>
#include <map>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using vpe::core::RgbImage;

constexpr int kFrames = 8;
// Posts about as far apart as pixels.
constexpr const char* kPit =
    "kind=crater lon=-74 lat=-11 radius=120000 depth=9000 ejecta_ratio=2 spacing=11000";

class FilmGround : public AppTest, public ::testing::WithParamInterface<const char*> {
 protected:
  // Returns a flight of eight frames in which a crater grows from the third on.
  static std::string flight(const std::string& lines) {
    return "flight 1.3\nview size=96x64 fov=50 fps=4\nat 0 set mode=lit sun.azimuth=290 sun.elevation=25\n"
           "at 0 pose lon=-74 lat=-17 alt=400000 yaw=0 pitch=-45\n" +
           lines + "at 2 end\n";
  }
  static std::string growing(const std::string& end = "radius=180000 depth=15000") {
    return flight(std::string("at 0.5 relief \"the pit\" ") + kPit + "\nat 1.5 relief \"the pit\" " + end +
                  "\n");
  }
  json fly(const std::string& output, const Words& more = {},
           const std::string& flight_file = "f.flight") const {
    Words words{"fly", flight_file, planet().string(), "-o", output, "--backend", GetParam(), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? parse_json(result.out) : json();
  }
  // Makes the film of growing(), or copies the one of an earlier test.
  void make_growing(const std::string& output) const {
    static std::map<std::string, test_support::TempDir> films;
    const fs::path kept = films[GetParam()] / "film";
    write_text(dir_ / "f.flight", growing());
    if (!fs::exists(kept)) {
      EXPECT_EQ(fly(output)["made"], kFrames);
      fs::copy(dir_ / output, kept);
    } else {
      fs::copy(kept, dir_ / output);
    }
  }
  static std::string name(int k) { return "frame_00000" + std::to_string(k) + ".png"; }
  RgbImage image(const std::string& folder, int k) const {
    return vpe::core::read_image(dir_ / folder / name(k));
  }
  // Returns the mean difference of colours, in steps.
  double difference(const std::string& a, int k, const std::string& b, int l) const {
    const RgbImage x = image(a, k);
    const RgbImage y = image(b, l);
    double sum = 0;
    for (std::size_t n = 0; n < x.pixels.size(); ++n) {
      sum += std::abs(x.pixels[n].r - y.pixels[n].r) + std::abs(x.pixels[n].g - y.pixels[n].g) +
             std::abs(x.pixels[n].b - y.pixels[n].b);
    }
    return sum / (3.0 * static_cast<double>(x.pixels.size()));
  }
};

TEST_P(FilmGround, ACraterGrowsWithoutJumps) {
  write_text(dir_ / "f.flight", growing());
  write_text(dir_ / "still.flight", flight(""));
  const json summary = fly("film");
  EXPECT_EQ(summary["made"], kFrames);
  EXPECT_EQ(summary["failed"], 0);
  EXPECT_EQ(summary["illustration"], true);
  EXPECT_EQ(summary["ground"], json({"relief the pit"}));
  EXPECT_LE(summary["shift_bound_px"], 1.5);
  const json still = fly("still", {}, "still.flight");
  EXPECT_EQ(still["ground"], json::array());
  for (const int k : {0, 1}) EXPECT_EQ(difference("film", k, "still", k), 0) << k;
  // It appears at once, grows evenly and stands still at last.
  const double appears = difference("film", 1, "film", 2);
  EXPECT_GT(appears, 1);
  for (int k = 2; k < 5; ++k) {
    const double step = difference("film", k, "film", k + 1);
    EXPECT_GT(step, 0) << k;
    EXPECT_LT(step, 0.8 * difference("film", 2, "film", 6)) << k;
  }
  EXPECT_EQ(difference("film", 6, "film", 7), 0);
  const json manifest = parse_json(read_text(dir_ / "film/manifest.json"));
  EXPECT_EQ(manifest["ground"], json({"relief the pit"}));
  EXPECT_EQ(manifest["planet"]["illustration"], true);
  EXPECT_NE(manifest["planet"]["synthetic"].get<std::string>().find("relief the pit"), std::string::npos);
  EXPECT_FALSE(manifest["frames"][1].contains("ground"));
  ASSERT_EQ(manifest["frames"][2]["ground"].size(), 1U);
  EXPECT_TRUE(manifest["frames"][2]["ground"][0].get<std::string>().starts_with("relief the pit kind=crater "));
}

TEST_P(FilmGround, AFrameDoesNotDependOnTheRunThatMakesIt) {
  make_growing("whole");
  fly("one", {"--frames", "4-4"});
  EXPECT_EQ(read_text(dir_ / "one" / name(4)), read_text(dir_ / "whole" / name(4)));
  fs::copy(dir_ / "whole", dir_ / "resumed");
  for (const int k : {1, 3, 4, 7}) fs::remove(dir_ / "resumed" / name(k));
  EXPECT_EQ(fly("resumed")["made"], 4);
  fly("back", {"--threads", "1", "--frames", "5-7"});
  for (int k = 0; k < kFrames; ++k)
    EXPECT_EQ(read_text(dir_ / "resumed" / name(k)), read_text(dir_ / "whole" / name(k))) << k;
  for (int k = 5; k < kFrames; ++k)
    EXPECT_EQ(read_text(dir_ / "back" / name(k)), read_text(dir_ / "whole" / name(k))) << k;
}

TEST_P(FilmGround, OnlyChangedFramesAreMadeAgain) {
  make_growing("film");
  EXPECT_EQ(fly("film")["kept"], kFrames);
  // The name does not count, nor what does not reach a frame.
  std::string renamed = growing();
  for (std::size_t at; (at = renamed.find("the pit")) != std::string::npos;) renamed.replace(at, 7, "hole");
  write_text(dir_ / "f.flight", renamed);
  EXPECT_EQ(fly("film")["kept"], kFrames);
  write_text(dir_ / "f.flight", growing("radius=180000 depth=15500"));
  const json deeper = fly("film");
  EXPECT_EQ(deeper["kept"], 3);  // two without it, and its first
  EXPECT_EQ(deeper["made"], kFrames - 3);
}

TEST_P(FilmGround, FilesChangeItToo) {
  const std::string works =
      "version = 1\n[[relief]]\nkind = \"crater\"\nlon = -74\nlat = -11\nradius_m = 120000\nejecta_ratio = 2\n"
      "spacing_m = 11000\n";
  write_text(dir_ / "works.relief.toml", works + "depth_m = 9000\n");
  write_text(dir_ / "f.flight",
             flight("at 0 patch works.relief.toml mix=0\nat 1 patch works.relief.toml mix=1\n"));
  write_text(dir_ / "relief.flight", flight(std::string("at 0 relief pit ") + kPit + "\n"));
  const json film = fly("film");
  EXPECT_EQ(film["ground"], json({"patch works.relief.toml"}));
  fly("relief", {}, "relief.flight");
  // With all of it the ground is that of the relief.
  EXPECT_EQ(difference("film", 7, "relief", 7), 0);
  EXPECT_GT(difference("film", 0, "relief", 0), 1);
  write_text(dir_ / "works.relief.toml", works + "depth_m = 9500\n");
  const json again = fly("film");
  EXPECT_EQ(again["kept"], 1);  // of mix 0
  EXPECT_EQ(again["made"], kFrames - 1);
}

// A plateau of a raster rises evenly out of the planet.
TEST_P(FilmGround, ARasterIsMixedIn) {
  Dem dem;
  dem.width = dem.height = 24;
  dem.west_deg = -77;
  dem.north_deg = -8;
  dem.cell_deg = 0.25;
  dem.height_m = [](int, int) { return 25'000.0; };
  write_dem(dir_ / "plateau.tif", dem);
  write_text(dir_ / "still.flight", flight(""));
  write_text(dir_ / "f.flight", flight("at 0.5 patch plateau.tif mix=0\nat 1.5 patch plateau.tif mix=1\n"));
  EXPECT_EQ(fly("film")["ground"], json({"patch plateau.tif"}));
  fly("still", {}, "still.flight");
  for (const int k : {0, 1, 2}) EXPECT_EQ(difference("film", k, "still", k), 0) << k;
  for (int k = 2; k < 6; ++k)
    EXPECT_GT(difference("film", k + 1, "still", k + 1), difference("film", k, "still", k)) << k;
  EXPECT_EQ(difference("film", 6, "film", 7), 0);
  // Its bytes count.
  dem.height_m = [](int, int) { return 24'000.0; };
  write_dem(dir_ / "plateau.tif", dem);
  EXPECT_EQ(fly("film")["made"], kFrames - 3);
}

TEST_P(FilmGround, LogsAreTheSameFlight) {
  write_text(dir_ / "f.flight", growing());
  fly("film", {"--log", "log.flight"});
  EXPECT_NE(read_text(dir_ / "log.flight").find("at 0.5 relief \"the pit\" "), std::string::npos);
  fly("again", {}, "log.flight");
  for (int k = 0; k < kFrames; ++k) EXPECT_EQ(difference("again", k, "film", k), 0) << k;
}

TEST_P(FilmGround, KeyFramesGivePixelsToFramesOfTheirGroundAlone) {
  const std::string moves = "at 2 pose lon=-73.9 lat=-16.8 alt=398000 yaw=1 pitch=-44\n";
  const std::string text = growing();
  write_text(dir_ / "f.flight", std::string(text).insert(text.find("at 2 end"), moves));
  fly("full");
  fly("reused", {"--reuse", "0.5"});
  const json manifest = parse_json(read_text(dir_ / "reused/manifest.json"));
  for (int k = 0; k < kFrames; ++k) {
    EXPECT_EQ(manifest["frames"][static_cast<std::size_t>(k)]["figures"].contains("carrying_px"), k == 1) << k;
    EXPECT_LT(difference("reused", k, "full", k), k == 1 ? 1.0 : 0.1) << k;
  }
}

TEST_P(FilmGround, WhatCannotBeDrawnIsNamedFirst) {
  const auto expect = [&](const std::string& lines, const Words& parts) {
    write_text(dir_ / "f.flight", flight(lines));
    expect_failure({"fly", "f.flight", planet().string(), "-o", "film", "--backend", GetParam()}, 1, parts);
    EXPECT_FALSE(exists("film/frame_000000.png"));
  };
  expect("at 1 patch absent.vpe mix=1\n", {"f.flight: a patch cannot be used", "absent.vpe"});
  expect("at 1 relief pit kind=crater lon=1 lat=2 radius=-3\n", {"f.flight:5: ", "radius_m"});
  expect("at 1 relief pit kind=crater lon=1 lat=2 radius=9e6\n",
         {"f.flight: the relief \"pit\" at 1 s: it reaches"});
  // The camera stands in the mountain that rises.
  expect("at 1 relief hill kind=pad lon=-74 lat=-17 radius=90000 rise=410000\n", {"below the ground at"});
}

INSTANTIATE_TEST_SUITE_P(Backends, FilmGround, testing::Values("polygon", "ray"),
                         [](const auto& made) { return std::string(made.param); });

}  // namespace
}  // namespace app_test
