// vpe panorama with overlays, as a user runs it.
#include <glm/geometric.hpp>
#include <tuple>

#include "panorama/horizon/landmarks.h"
#include "panorama/metadata/open_panorama.h"
#include "tests/app/support/app_fixture.h"
#include "vpe/core/appearance/overlays.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;
using vpe::core::RgbImage;

class PanoramaOverlay : public AppTest {
 protected:
  void SetUp() override {
    if (!vpe::core::overlays_refused().empty()) GTEST_SKIP() << vpe::core::overlays_refused();
    write_text(dir_ / "places.csv", kPlaces);
  }

  Result make(const std::string& output, const Words& more) const {
    Words all{"panorama", planet().string(), "--at", "10,5", "--height", "4000", "-o", output, "-q"};
    all.insert(all.end(), more.begin(), more.end());
    const Result result = vpe(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result;
  }
  RgbImage panorama_image(const std::string& name) const { return vpe::core::read_image(dir_ / name); }

  // Around the camera: some 60 to 240 km away, and one behind the planet.
  static constexpr const char* kPlaces =
      "name,lon,lat,diameter_km\nNorth,10,6,0\nEast,11.5,5,0\nSouth,10,3,0\nSouth-west,7,2,0\nAntipode,190,-5,"
      "0\n";
  static Words with(Words more, const Words& and_these) {
    more.insert(more.end(), and_these.begin(), and_these.end());
    return more;
  }
  static Words all_of_them() {
    return {"--set", "overlay.compass=horizon", "--set", "overlay.names=places.csv",
            "--set", "overlay.distances=on",    "--set", "overlay.title=From a hill",
            "--set", "overlay.legend=on",       "--set", "mode=coloured"};
  }
};

double brightness(const vpe::base::Rgb& p) { return (p.r + p.g + p.b) / 3.0; }

TEST_F(PanoramaOverlay, VisibleNamesStandAtTheirPixelsInEveryProjection) {
  // vpe horizon answers for the same places.
  const auto report = parse_json(vpe({"horizon", planet().string(), "--at", "10,5", "--height", "4000",
                                      "--step", "10", "--names", "places.csv", "-o", "s.csv", "--json"})
                                     .out);
  ASSERT_GE(report["features_visible"].get<int>(), 2);
  for (const Words& kind : {Words{"--projection", "cylinder"}, Words{"--projection", "equirectangular"},
                            Words{"--projection", "facets", "--facets", "5"},
                            Words{"--backend", "polygon", "--projection", "facets"}}) {
    const Words more = with(kind, {"--width", "1600", "--elevation=-20,20", "--yaw", "33"});
    make("plain.png", more);
    make("named.png", with(more, {"--set", "overlay.names=places.csv"}));
    const RgbImage plain = panorama_image("plain.png");
    const RgbImage named = panorama_image("named.png");
    const panorama::PanoramaMap map = panorama::describe(dir_ / "named.png").map;
    std::size_t painted = 0;
    for (std::size_t n = 0; n < plain.pixels.size(); ++n) painted += plain.pixels[n] != named.pixels[n];
    EXPECT_GT(painted, 200U);
    EXPECT_LT(painted, plain.pixels.size() / 20);
    int seen = 0;
    int hidden = 0;
    for (const auto& feature : report["features"]) {
      const auto at =
          map.to_pixel({feature["azimuth_deg"].get<double>(), feature["elevation_deg"].get<double>()});
      if (!at) continue;
      const auto pixel = static_cast<std::size_t>(at->y) * static_cast<std::size_t>(named.width) +
                         static_cast<std::size_t>(at->x);
      if (feature["visible"].get<bool>()) {
        ++seen;
        EXPECT_NE(named.pixels[pixel], plain.pixels[pixel]);
        EXPECT_GT(brightness(named.pixels[pixel]), 200) << kind[1] << " " << feature;
      } else {
        ++hidden;
        EXPECT_EQ(named.pixels[pixel], plain.pixels[pixel]) << kind[1] << " " << feature;
      }
    }
    EXPECT_GE(seen, 2);
    EXPECT_GE(hidden, 1);
  }
}

TEST_F(PanoramaOverlay, ObjectsHideNames) {
  write_text(dir_ / "wall.obj", "v -1 0 0\nv 1 0 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\nf 1 3 2\nf 1 4 3\n");
  write_text(dir_ / "a.scene.toml",
             "version = 1\n[[model]]\nname = \"wall\"\nfile = \"wall.obj\"\n[[object]]\nmodel = \"wall\"\n"
             "lon = 20\nlat = 10.3\nscale = 60000\n");
  write_text(dir_ / "one.csv", "name,lon,lat\nBehind the wall,20,11.5\n");
  const auto draw = [&](const std::string& output, const Words& more) {
    Words words{"panorama", planet().string(), "--at", "20,10", "--altitude", "30000", "--width",
                "512",      "--backend",       "ray",  "--set", "samples=1",  "-o",    output};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / output).pixels;
  };
  const Words names{"--set", "overlay.names=one.csv"};
  const Words scene{"--scene", "a.scene.toml"};
  EXPECT_NE(draw("bare.png", {}), draw("names.png", names));
  Words both = names;
  both.insert(both.end(), scene.begin(), scene.end());
  EXPECT_EQ(draw("scene.png", scene), draw("both.png", both));
}

TEST_F(PanoramaOverlay, FromItsSidecarItHasTheSameObjectsUnlessTheSceneChanged) {
  write_text(dir_ / "wall.obj", "v -1 0 0\nv 1 0 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n");
  const std::string scene =
      "version = 1\n[[model]]\nname = \"wall\"\nfile = \"wall.obj\"\n[[object]]\n"
      "model = \"wall\"\nlon = 10\nlat = 5.3\nscale = 9000\n";
  write_text(dir_ / "a.scene.toml", scene);
  make("a.png", {"--width", "256", "--scene", "a.scene.toml"});
  const std::string bytes = read_text(dir_ / "a.png");
  fs::create_directory(dir_ / "elsewhere");
  const Words again{"panorama", "--from-sidecar", "a.json", "-o", "elsewhere/b.png", "-q"};
  const Result same = vpe(again);
  ASSERT_EQ(same.exit_code, 0) << same.err;
  EXPECT_TRUE(read_text(dir_ / "elsewhere/b.png") == bytes);
  // A model counts, too.
  write_text(dir_ / "wall.obj", "v -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 0\nf 1 2 3\nf 1 3 4\n");
  const Result changed = vpe(again);
  EXPECT_EQ(changed.exit_code, 1);
  EXPECT_NE(changed.err.find("a.scene.toml or one of its models has changed"), std::string::npos)
      << changed.err;
}

TEST_F(PanoramaOverlay, MemoryThreadsAndStripsChangeNoByte) {
  // Three strips.
  const Words more = with(all_of_them(), {"--width", "18000", "--elevation=-3.2,-0.8"});
  make("a.png", more);
  make("b.png", with(more, {"--memory", "64", "--threads", "3"}));
  EXPECT_TRUE(read_text(dir_ / "a.png") == read_text(dir_ / "b.png"));
  // A run that was stopped continues with the same layout.
  fs::remove(dir_ / "a.json");
  const std::string bytes = read_text(dir_ / "a.png");
  fs::remove(dir_ / "a.png");
  Command command = command_for(
      with({"panorama", planet().string(), "--at", "10,5", "--height", "4000", "-o", "a.png", "-q"}, more));
  command.signal = SIGINT;
  command.when = [&] { return exists("a.png.parts/strip_000000"); };
  ASSERT_TRUE(run(command).signalled);
  // Strips of other overlays are not taken.
  fs::create_directory(dir_ / "other");
  fs::copy(dir_ / "a.png.parts", dir_ / "other" / "a.png.parts");
  EXPECT_EQ(parse_json(
                make("other/a.png", with(more, {"--set", "overlay.title=Other", "--json"})).out)["strips_kept"],
            0);
  EXPECT_GE(parse_json(make("a.png", with(more, {"--json"})).out)["strips_kept"], 1);
  EXPECT_TRUE(read_text(dir_ / "a.png") == bytes);
}

TEST_F(PanoramaOverlay, FromItsSidecarItHasTheSameBytesUnlessTheNamesChanged) {
  make("p.png", with(all_of_them(), {"--width", "700", "--from", "300", "--to", "120", "--elevation=-12,8"}));
  // From another folder the names are still found.
  fs::create_directory(dir_ / "elsewhere");
  Command command = command_for({"panorama", "--from-sidecar", path("p.json"), "-o", "q.png", "-q"});
  command.folder = dir_ / "elsewhere";
  const Result again = run(command);
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_TRUE(read_text(dir_ / "elsewhere" / "q.png") == read_text(dir_ / "p.png"));
  write_text(dir_ / "places.csv", "name,lon,lat\nNorth,10,6.5\n");
  expect_failure({"panorama", "--from-sidecar", "p.json", "-o", "z.png", "-q"}, 1,
                 {"places.csv", "has changed", "names"});
  fs::remove(dir_ / "places.csv");
  expect_failure({"panorama", "--from-sidecar", "p.json", "-o", "z.png", "-q"}, 1, {"places.csv"});
  EXPECT_FALSE(exists("z.png"));
}

TEST_F(PanoramaOverlay, WrongOnesAreReportedBeforeAnyWork) {
  const auto refuse = [&](int code, const Words& more, const Words& parts) {
    Words all{"panorama", planet().string(), "--at", "10,5", "--height", "4000", "-o", "x.png"};
    expect_failure(with(all, more), code, parts);
    EXPECT_FALSE(exists("x.png"));
  };
  refuse(2, {"--set", "overlay.scale=on"}, {"overlay.scale", "leave it out"});
  refuse(2, {"--set", "overlay.north=on"}, {"overlay.north", "overlay.compass"});
  refuse(2, {"--set", "overlay.time=on"}, {"overlay.time", "flight"});
  refuse(2, {"--set", "overlay.graticule=on"}, {"overlay.graticule", "leave it out"});
  refuse(2, {"--set", "overlay.contours=on"}, {"overlay.contours", "leave it out"});
  refuse(2, {"--set", "overlay.compass=left"}, {"overlay.compass", "horizon"});
  refuse(2, {"--set", "overlay.names=none.csv"}, {"none.csv"});
  write_text(dir_ / "bad.csv", "name,lon,lat\nA,1\n");
  refuse(1, {"--set", "overlay.names=bad.csv"}, {"bad.csv", "2"});
}

TEST_F(PanoramaOverlay, TheCompassOfAViewIsThatOfItsPanorama) {
  make("p.png", {"--width", "1440", "--elevation=-30,30", "--set", "overlay.compass=horizon"});
  for (const std::string output : {"plain.png", "marked.png"}) {
    Words words{"overlook", "p.png", "--view", "90,0", "--fov", "40", "--size", "400x300", "-o", output, "-q"};
    if (output == "marked.png") words.push_back("--compass");
    ASSERT_EQ(vpe(words).exit_code, 0);
  }
  const RgbImage plain = panorama_image("plain.png");
  const RgbImage marked = panorama_image("marked.png");
  std::size_t above = 0;
  std::size_t below = 0;
  for (std::size_t n = 0; n < plain.pixels.size(); ++n)
    (n < plain.pixels.size() * 9 / 10 ? above : below) += plain.pixels[n] != marked.pixels[n];
  EXPECT_EQ(above, 0U);
  EXPECT_GT(below, 2000U);
  // "E" and its tick in the middle; the horizon's own tick above it.
  const auto at = [&](int x, int y) {
    return brightness(marked.pixels[static_cast<std::size_t>(y * 400 + x)]);
  };
  EXPECT_GT(std::max(at(199, 300 - 17), at(200, 300 - 17)), 130);
}

}  // namespace
}  // namespace app_test
