// Synthetic ground is marked wherever an image, a panorama or a film is made of it.
#include <cmath>

#include "mars/geodesy/sphere.h"
#include "tests/app/support/app_fixture.h"
#include "tests/app/support/tiff_numbers.h"
#include "vpe/core/image/image.h"
#include "vpe/overlay/overlay.h"

namespace app_test {
namespace {

using nlohmann::json;

// The embedded Mars with synthetic detail within 0.2 degrees about 63 W, 12.6 S alone.
class Synthetic : public AppTest {
 protected:
  static void SetUpTestSuite() { built_ = std::make_unique<test_support::TempDir>(); }
  static void TearDownTestSuite() { built_.reset(); }
  // All tests share the planet.
  void SetUp() override {
    const std::filesystem::path planet = *built_ / "mars.vpe";
    if (!std::filesystem::exists(planet)) {
      const Result built =
          vpe({"build", "embedded", "--image", "embedded", "--region", "-63.1,-12.7,-62.9,-12.5", "--spacing",
               "400", "--base-spacing", "60000", "--image-spacing", "2000", "-o", planet.string(), "--quiet"});
      ASSERT_EQ(built.exit_code, 0) << built.err;
    }
    std::filesystem::copy_file(planet, dir_ / "mars.vpe");
  }
  // Renders straight down from 2500 km above the region, where a pixel is 19 km wide.
  vpe::core::RgbImage render(const std::string& backend, const std::string& inspect,
                             const Words& more = {}) const {
    Words words{"render",    "mars.vpe", "--pose", "-63,-12.6,2500000,0,-90,0", "--size", "160x120",
                "--backend", backend,    "--set",  "inspect=" + inspect,        "-o",     "x.png",
                "--fov",     "50",       "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / "x.png");
  }

 private:
  static std::unique_ptr<test_support::TempDir> built_;
};
std::unique_ptr<test_support::TempDir> Synthetic::built_;

TEST_F(Synthetic, AnImageTintsItWithEitherBackend) {
  for (const std::string backend : {"polygon", "ray"}) {
    const vpe::core::RgbImage plain = render(backend, "none");
    const vpe::core::RgbImage tinted = render(backend, "synthetic");
    ASSERT_EQ(plain.pixels.size(), tinted.pixels.size());
    std::size_t blue = 0;
    for (std::size_t n = 0; n < plain.pixels.size(); ++n) {
      if (plain.pixels[n] == tinted.pixels[n]) continue;
      EXPECT_EQ(tinted.pixels[n], vpe::overlay::blend(vpe::overlay::kSyntheticTint, plain.pixels[n]))
          << backend;
      ++blue;
    }
    // The middle of the region, and nothing at the edges of the image, 1500 km away.
    const std::size_t middle = 60 * 160 + 80;
    EXPECT_NE(plain.pixels[middle], tinted.pixels[middle]) << backend;
    for (std::size_t y = 0; y < 120; ++y) {
      EXPECT_EQ(plain.pixels[y * 160], tinted.pixels[y * 160]) << backend;
      EXPECT_EQ(plain.pixels[y * 160 + 159], tinted.pixels[y * 160 + 159]) << backend;
    }
    // Tiles whose posts are fine enough for detail reach a few hundred kilometres around the region, since neighbours
    // differ by one level at most.
    EXPECT_GE(blue, 12U) << backend;
    EXPECT_LE(blue, 4000U) << backend;
  }
}

TEST_F(Synthetic, CertificateAndRecipeNameIt) {
  (void)render("ray", "none", {"--certificate", "c.json"});
  const json certificate = parse_json(read_text(dir_ / "c.json"));
  EXPECT_EQ(certificate["illustration"], true);
  const std::string meaning = certificate["what_this_means"];
  EXPECT_TRUE(says(meaning, {"Elevations are those of MOLA", "is synthetic (embedded-detail), not data"}));
  EXPECT_EQ(meaning.find("illustration"), std::string::npos);
  EXPECT_GT(certificate["source_accuracy_m"], 10);
  EXPECT_NE(read_text(dir_ / "x.png").find("\"synthetic\":\"Elevations are those of MOLA"), std::string::npos);
}

TEST_F(Synthetic, APanoramaHasALayerForIt) {
  const Words words{"panorama",     "mars.vpe",        "--at",    "-63.25,-12.6",
                    "--height",     "300000",          "--width", "360",
                    "-o",           "p.png",           "--quiet", "--elevation=-89,-24",
                    "--aux-layers", "synthetic,lonlat"};
  const Result result = vpe(words);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json sidecar = parse_json(read_text(dir_ / "p.json"));
  EXPECT_TRUE(says(sidecar["synthetic"], {"embedded-detail"}));
  const auto file = [&](const char* layer) {
    return dir_ / sidecar["planes"][layer]["file"].get<std::string>();
  };
  const std::vector<float> synthetic = read_numbers<float>(file("synthetic"));
  const std::vector<double> places = read_numbers<double>(file("lonlat"), 2);
  std::size_t inside = 0, outside = 0;
  for (std::size_t n = 0; n < synthetic.size(); ++n) {
    const mars::LonLat place{places[2 * n], places[2 * n + 1]};
    ASSERT_EQ(std::isnan(synthetic[n]), std::isnan(place.lon_deg));
    if (std::isnan(synthetic[n])) continue;
    ASSERT_TRUE(synthetic[n] == 0.0F || synthetic[n] == 1.0F);
    if (place.lon_deg > -63.09 && place.lon_deg < -62.91 && place.lat_deg > -12.69 && place.lat_deg < -12.51) {
      EXPECT_EQ(synthetic[n], 1.0F);
      ++inside;
    }
    outside += synthetic[n] == 0.0F ? 1 : 0;
  }
  EXPECT_GT(inside, 3U);
  EXPECT_GT(outside, 100U);

  expect_failure({"panorama", "mars.vpe", "--at", "-63,-12.6", "--height", "9", "-o", "q.png", "--set",
                  "inspect=synthetic"},
                 2, {"inspect=synthetic", "--aux-layers synthetic"});
}

TEST_F(Synthetic, AFilmSaysSoInItsMetadata) {
  write_text(dir_ / "f.flight",
             "flight 1\nview size=64x36 fps=10\nat 0 pose lon=-63 lat=-12.6 alt=300000 pitch=-80\n"
             "at 0.5 pose lon=-62.9 lat=-12.6 alt=300000 pitch=-80\n");
  const Result result = vpe({"fly", "f.flight", "mars.vpe", "-o", "f.mp4", "--quiet"});
  if (result.err.find("install ffmpeg") != std::string::npos) GTEST_SKIP() << "skipped: no ffmpeg";
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json manifest = parse_json(read_text(dir_ / "f.mp4.json"));
  const std::string statement = manifest["planet"]["synthetic"];
  EXPECT_TRUE(says(statement, {"MOLA", "embedded-detail"}));
  // The comment of an MP4 file is stored as text.
  EXPECT_NE(read_text(dir_ / "f.mp4").find(statement), std::string::npos);
}

}  // namespace
}  // namespace app_test
