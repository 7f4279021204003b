// Films of flights that change the field of view, the backend and the eyes.
#include <algorithm>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

using vpe::core::RgbImage;

// Eight frames: rays; triangles, zooming; pairs; rays with another field of view. The window's size changes too.
constexpr const char* kFlight =
    "flight 1.1\nview size=64x48 fov=50 fps=1\nat 0 set mode=coloured\n"
    "at 0 pose lon=-74 lat=-13 alt=500000 yaw=20 pitch=-60\n"
    "at 0 view backend=ray fov=50\n"
    "at 2 view backend=polygon fov=50 size=320x200\n"
    "at 3 view backend=ray fov=40 eyes=sbs base=20000\n"
    "at 4 view eyes=ou\n"
    "at 5 view eyes=anaglyph base=0\n"
    "at 6 view eyes=off fov=20\n"
    "at 8 end\n";

class FlyViews : public AppTest {
 protected:
  void SetUp() override { write_text(dir_ / "f.flight", kFlight); }

  Result fly(const std::string& output, const Words& more = {}, const std::string& flight = "f.flight") const {
    Words words{"fly", flight, planet().string(), "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }
  nlohmann::json summary(const std::string& output, const Words& more = {},
                         const std::string& flight = "f.flight") const {
    Words words = more;
    words.emplace_back("--json");
    const Result result = fly(output, words, flight);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? parse_json(result.out) : nlohmann::json();
  }
  std::filesystem::path frame(const std::string& folder, int k) const {
    return dir_ / folder / ("frame_00000" + std::to_string(k) + ".png");
  }
  // Draws the flight's pose as a single image.
  RgbImage rendered(const Words& more) const {
    Words words{"render", planet().string(), "--pose", "-74,-13,500000,20,-60,0",
                "--set",  "mode=coloured",   "-o",     "r.png"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / "r.png");
  }
};

TEST_F(FlyViews, EachFrameHasItsBackendFieldOfViewAndEyes) {
  const nlohmann::json mixed = summary("mixed");
  EXPECT_EQ(mixed["made"], 8);
  EXPECT_EQ(mixed["backend"], "mixed");
  for (int k = 0; k < 8; ++k) {
    const RgbImage image = vpe::core::read_image(frame("mixed", k));
    EXPECT_EQ(image.width, 64) << k;
    EXPECT_EQ(image.height, 48) << k;
  }
  // --backend draws all frames by one. Frames that are the same have the same bytes, with their fingerprints.
  EXPECT_EQ(summary("ray", {"--backend", "ray"})["backend"], "ray");
  EXPECT_EQ(summary("polygon", {"--backend", "polygon"})["backend"], "polygon");
  for (int k = 0; k < 8; ++k) {
    const std::string bytes = read_text(frame("mixed", k));
    EXPECT_EQ(bytes == read_text(frame("ray", k)), k != 2) << k;
    EXPECT_EQ(bytes == read_text(frame("polygon", k)), k == 2) << k;
  }
  const auto pixels = [&](int k) { return vpe::core::read_image(frame("mixed", k)).pixels; };
  const Words rays{"--backend", "ray"};
  const auto with = [&](Words more) {
    more.insert(more.end(), rays.begin(), rays.end());
    return rendered(more).pixels;
  };
  EXPECT_EQ(pixels(0), with({"--size", "64x48", "--fov", "50"}));
  EXPECT_EQ(pixels(3), with({"--size", "32x48", "--fov", "40", "--stereo", "sbs", "--eye-base", "20000"}));
  EXPECT_EQ(pixels(6), with({"--size", "64x48", "--fov", "20"}));
  EXPECT_EQ(pixels(6), pixels(7));
}

TEST_F(FlyViews, AnEyeBaseThatIsNotGivenFollowsTheHeight) {
  ASSERT_EQ(fly("film", {"--frames", "5-5", "--log", "l.flight"}).exit_code, 0);
  const std::string log = read_text(dir_ / "l.flight");
  const std::size_t at = log.find("base=");
  ASSERT_NE(at, std::string::npos) << log;
  const double base_m = std::stod(log.substr(at + 5));
  // The hills of the planet are within 10 km of the sphere.
  EXPECT_NEAR(base_m, 500e3 / 30, 10e3 / 30);
}

TEST_F(FlyViews, ALogGivesTheSameFrames) {
  EXPECT_EQ(summary("film", {"--log", "l.flight"})["made"], 8);
  EXPECT_TRUE(read_text(dir_ / "l.flight").starts_with("flight 1.1\n# log of vpe\n"));
  const nlohmann::json again = summary("film", {"--log", "l.flight"}, "f.flight");  // replaces a log
  EXPECT_EQ(again["kept"], 8);
  const nlohmann::json replayed = summary("film", {}, "l.flight");
  EXPECT_EQ(replayed["kept"], 8) << read_text(dir_ / "l.flight");
}

TEST_F(FlyViews, AnEditedViewMakesOnlyItsFramesAgain) {
  EXPECT_EQ(summary("film")["made"], 8);
  std::string text = kFlight;
  text.replace(text.find("eyes=ou"), 7, "eyes=ou base=20001");
  write_text(dir_ / "f.flight", text);
  const nlohmann::json edited = summary("film");
  EXPECT_EQ(edited["made"], 1);
  EXPECT_EQ(edited["kept"], 7);
}

TEST_F(FlyViews, WithoutOpenGlTheOptionIsNamed) {
  Command command = command_for({"fly", "f.flight", planet().string(), "-o", "film"});
  command.environment["__EGL_VENDOR_LIBRARY_FILENAMES"] = path("none.json");
  const Result result = run(command);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, {"of 8 frames", "--backend ray draws all frames"})) << result.err;
  // Frames by rays alone need no OpenGL.
  std::string text = kFlight;
  text.replace(text.find("backend=polygon"), 15, "backend=ray    ");
  write_text(dir_ / "f.flight", text);
  command.arguments.emplace_back("--json");
  const Result rays = run(command);
  ASSERT_EQ(rays.exit_code, 0) << rays.err;
  EXPECT_EQ(parse_json(rays.out)["backend"], "ray");
  EXPECT_EQ(parse_json(rays.out)["frames"], 8);
}

TEST_F(FlyViews, PairsNeedAnEvenSide) {
  Result odd = fly("film", {"--size", "65x48"});
  EXPECT_EQ(odd.exit_code, 1);
  EXPECT_TRUE(says(odd.err, {"f.flight", "eyes=sbs", "65", "--size"})) << odd.err;
  odd = fly("film", {"--size", "64x47"});
  EXPECT_EQ(odd.exit_code, 1);
  EXPECT_TRUE(says(odd.err, {"eyes=ou", "47"})) << odd.err;
  EXPECT_FALSE(exists("film"));
}

TEST_F(FlyViews, ViewsNeedTheirVersion) {
  std::string text = kFlight;
  write_text(dir_ / "f.flight", text.replace(0, 10, "flight 1"));
  const Result old = fly("film");
  EXPECT_EQ(old.exit_code, 1);
  EXPECT_TRUE(says(old.err, {"f.flight:5: expected \"flight 1.1\""})) << old.err;
}

TEST_F(FlyViews, PairsConvergeWhereTheFlightSays) {
  write_text(dir_ / "c.flight",
             "flight 1.1\nview size=64x48 fov=50 fps=1\nat 0 set mode=coloured\n"
             "at 0 pose lon=-74 lat=-13 alt=500000 yaw=20 pitch=-60\n"
             "at 0 view backend=ray eyes=anaglyph base=20000 convergence=550000\n"
             "at 1 view convergence=0\nat 2 end\n");
  EXPECT_EQ(summary("film", {}, "c.flight")["made"], 2);
  const Words pair{"--backend", "ray",      "--size",   "64x48",      "--fov",
                   "50",        "--stereo", "anaglyph", "--eye-base", "20000"};
  Words converging = pair;
  converging.insert(converging.end(), {"--convergence", "550000"});
  EXPECT_EQ(vpe::core::read_image(frame("film", 0)).pixels, rendered(converging).pixels);
  EXPECT_EQ(vpe::core::read_image(frame("film", 1)).pixels, rendered(pair).pixels);
  EXPECT_NE(read_text(frame("film", 0)), read_text(frame("film", 1)));
}

TEST_F(FlyViews, SecondEyesAreCarriedWhereTheyCanBe) {
  write_text(dir_ / "pairs.flight",
             "flight 1.1\nview size=64x48 fov=50 fps=1\nat 0 set mode=lit\n"
             "at 0 pose lon=-74 lat=-13 alt=500000 yaw=20 pitch=-60\n"
             "at 0 view backend=ray eyes=anaglyph base=20000\n"
             "at 2 view backend=polygon\n"
             "at 3 set mode=wireframe\n"
             "at 5 end\n");
  const Words reproject{"--stereo-method", "reproject"};
  EXPECT_EQ(summary("full", {}, "pairs.flight")["made"], 5);
  EXPECT_EQ(summary("carried", reproject, "pairs.flight")["made"], 5);
  for (int k = 0; k < 5; ++k) {
    // Rays cannot draw wireframes: such pairs are drawn in full.
    const auto pixels = [&](const std::string& folder) {
      return vpe::core::read_image(frame(folder, k)).pixels;
    };
    EXPECT_EQ(pixels("full") == pixels("carried"), k >= 3) << k;
  }
  EXPECT_EQ(vpe::core::read_image(frame("carried", 0)).pixels,
            rendered({"--backend", "ray", "--size", "64x48", "--fov", "50", "--set", "mode=lit", "--stereo",
                      "anaglyph", "--eye-base", "20000", "--stereo-method", "reproject"})
                .pixels);
  // Frames with another gap are made again, and all of the other method, where the renderer has more memory.
  EXPECT_EQ(summary("carried", reproject, "pairs.flight")["kept"], 5);
  EXPECT_EQ(summary("carried", {"--stereo-method", "reproject", "--stereo-gap", "1.5"}, "pairs.flight")["made"],
            3);
  EXPECT_EQ(summary("carried", {"--stereo-method", "reproject", "--stereo-gap", "0"}, "pairs.flight")["made"],
            5);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(read_text(frame("full", k)), read_text(frame("carried", k))) << k;
  // Parts make the frames of the whole film.
  EXPECT_EQ(summary("whole", reproject, "pairs.flight")["made"], 5);
  summary("parts", {"--stereo-method", "reproject", "--part", "2/2"}, "pairs.flight");
  summary("parts", {"--stereo-method", "reproject", "--part", "1/2"}, "pairs.flight");
  for (int k = 0; k < 5; ++k) EXPECT_EQ(read_text(frame("whole", k)), read_text(frame("parts", k))) << k;
}

}  // namespace
}  // namespace app_test
