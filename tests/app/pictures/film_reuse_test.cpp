// Films whose frames take pixels of key frames.
#include <algorithm>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using vpe::core::RgbImage;

constexpr int kFrames = 20;

class FilmReuse : public AppTest {
 protected:
  void SetUp() override { write_text(dir_ / "f.flight", flight()); }
  // A slow turn ahead, of twenty frames; `more` are lines of it.
  static std::string flight(const std::string& more = "") {
    return "flight 1.1\nview size=96x64 fov=50 fps=10\nat 0 set mode=lit\n"
           "at 0 pose lon=-74 lat=-13 alt=400000 yaw=20 pitch=-40\n" +
           more + "at 2 pose lon=-73.9 lat=-12.8 alt=395000 yaw=24 pitch=-38\nat 2 end\n";
  }
  json fly(const std::string& output, const Words& more = {}, const std::string& flight = "f.flight",
           const std::string& backend = "ray") const {
    Words words{"fly", flight, planet().string(), "-o", output, "--backend", backend, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? parse_json(result.out) : json();
  }
  std::string name(int k) const {
    return "frame_0000" + std::string(k < 10 ? "0" : "") + std::to_string(k) + ".png";
  }
  RgbImage image(const std::string& folder, int k) const {
    return vpe::core::read_image(dir_ / folder / name(k));
  }
  std::string bytes(const std::string& folder, int k) const { return read_text(dir_ / folder / name(k)); }
  // Returns the mean difference of colours, in steps.
  double difference(const RgbImage& a, const RgbImage& b) const {
    double sum = 0;
    for (std::size_t n = 0; n < a.pixels.size(); ++n) {
      sum += std::abs(a.pixels[n].r - b.pixels[n].r) + std::abs(a.pixels[n].g - b.pixels[n].g) +
             std::abs(a.pixels[n].b - b.pixels[n].b);
    }
    return sum / (3.0 * static_cast<double>(a.pixels.size()));
  }
};

TEST_F(FilmReuse, FramesTakeWhatTheyCanFromKeyFrames) {
  const json full = fly("full");
  EXPECT_EQ(full["carried_share"], 0);
  const json reused = fly("reused", {"--reuse", "0.5"});
  EXPECT_EQ(reused["made"], kFrames);
  EXPECT_GT(reused["carried_share"], 0.5);
  EXPECT_LE(reused["shift_bound_px"], full["shift_bound_px"].get<double>() + 0.54);
  const json manifest = parse_json(read_text(dir_ / "reused/manifest.json"));
  for (int k = 0; k < kFrames; ++k) {
    const json& figures = manifest["frames"][static_cast<std::size_t>(k)]["figures"];
    ASSERT_EQ(figures.contains("carrying_px"), k % 8 != 0) << k;
    if (k % 8 == 0) {
      // Drawn with a margin: the same but for rounding.
      EXPECT_LT(difference(image("reused", k), image("full", k)), 0.1) << k;
      continue;
    }
    EXPECT_LE(figures["carrying_px"], 0.54) << k;
    EXPECT_GT(figures["carried_share"], 0.5) << k;
    const double off = difference(image("reused", k), image("full", k));
    EXPECT_GT(off, 0) << k;
    EXPECT_LT(off, 1) << k;
    EXPECT_LT(off, 0.5 * difference(image("full", k - k % 8), image("full", k))) << k;
  }
  // Nothing is made again, unless the bound is another one.
  EXPECT_EQ(fly("reused", {"--reuse", "0.5"})["kept"], kFrames);
  EXPECT_EQ(fly("reused", {"--reuse", "0.25"})["made"], kFrames);
}

TEST_F(FilmReuse, AFrameDoesNotDependOnTheRunThatMakesIt) {
  const Words reuse{"--reuse", "0.5"};
  const auto with = [&](Words more) {
    more.insert(more.end(), reuse.begin(), reuse.end());
    return more;
  };
  fly("whole", reuse);
  fly("parts", with({"--part", "2/3", "--threads", "1"}));
  fly("parts", with({"--part", "3/3", "--threads", "2"}));
  fly("parts", with({"--part", "1/3", "--threads", "1"}));
  for (int k = 0; k < kFrames; ++k) EXPECT_EQ(bytes("parts", k), bytes("whole", k)) << k;
  fly("some", with({"--frames", "3-15x4"}));
  for (const int k : {3, 7, 11, 15}) EXPECT_EQ(bytes("some", k), bytes("whole", k)) << k;
  const std::string before = bytes("whole", 13);
  for (const int k : {5, 13}) fs::remove(dir_ / "whole" / name(k));
  const json again = fly("whole", reuse);
  EXPECT_EQ(again["made"], 2);
  EXPECT_EQ(again["kept"], kFrames - 2);
  EXPECT_EQ(bytes("whole", 13), before);
}

TEST_F(FilmReuse, FramesThatLookDifferentAreDrawnInFull) {
  // From the fifth frame on the light is another one, and from the twelfth there is haze.
  write_text(dir_ / "g.flight", flight("at 0.5 set sun.elevation=20\nat 1.2 set haze.visibility=200000\n"));
  fly("full", {}, "g.flight");
  fly("reused", {"--reuse", "1"}, "g.flight");
  for (int k = 0; k < kFrames; ++k) {
    const bool takes = (k > 0 && k < 5) || (k > 8 && k < 12);
    if (k % 8 == 0) continue;
    EXPECT_EQ(image("reused", k).pixels != image("full", k).pixels, takes) << k;
  }
}

TEST_F(FilmReuse, TrianglesMayDrawKeyFrames) {
  const json reused = fly("polygons", {"--reuse", "0.5"}, "f.flight", "polygon");
  EXPECT_GT(reused["carried_share"], 0.5);
  EXPECT_LE(reused["shift_bound_px"], 1.6);
  fly("full", {}, "f.flight", "polygon");
  for (int k = 0; k < kFrames; ++k) EXPECT_LT(difference(image("polygons", k), image("full", k)), 1.5) << k;
}

// Frames 10 to 15 have a pair as their key frame.
TEST_F(FilmReuse, PairsAreDrawnInFull) {
  write_text(dir_ / "h.flight", flight("at 0 view eyes=anaglyph base=20000\nat 1 view eyes=off\n"));
  fly("full", {}, "h.flight");
  fly("reused", {"--reuse", "0.5"}, "h.flight");
  for (int k = 0; k < kFrames; ++k) {
    if (k == 16) continue;
    EXPECT_EQ(image("reused", k).pixels == image("full", k).pixels, k < 16) << k;
  }
}

// Each frame says what it cannot read, as without key frames.
TEST_F(FilmReuse, DamagedTilesAreReportedFrameByFrame) {
  fs::copy_file(planet(), dir_ / "p.vpe");
  damage_payloads(dir_ / "p.vpe", "heights");
  for (const char* bound : {"0", "0.5"}) {
    const Result result =
        vpe({"fly", "f.flight", "p.vpe", "-o", "x", "--backend", "ray", "--json", "--reuse", bound});
    EXPECT_EQ(result.exit_code, 1) << bound;
    EXPECT_TRUE(says(result.err, {"20 of 20 frames failed", "p.vpe"})) << bound << "\n" << result.err;
  }
}

TEST_F(FilmReuse, BadBoundsAreRefused) {
  for (const char* bound : {"-1", "17", "much"}) {
    const Result result = vpe({"fly", "f.flight", planet().string(), "-o", "x", "--reuse", bound});
    EXPECT_EQ(result.exit_code, 2) << bound;
    EXPECT_TRUE(says(result.err, {"--reuse"})) << result.err;
  }
}

}  // namespace
}  // namespace app_test
