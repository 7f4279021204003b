// vpe render --stereo.
#include <algorithm>
#include <cmath>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

class StereoRender : public AppTest {
 protected:
  static constexpr int kWidth = 200;
  static constexpr int kHeight = 160;

  // Straight down from 300 km.
  Words words(const std::string& output, const Words& more) const {
    Words all{"render", planet().string(), "--pose", "20,10,300000,0,-90,0",
              "--size", "200x160",         "--fov",  "40",
              "--set",  "mode=coloured",   "-o",     output};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  vpe::core::RgbImage draw(const std::string& output, const Words& more) const {
    const Result result = vpe(words(output, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / output);
  }
};

TEST_F(StereoRender, TheEyesImagesAreShifted) {
  // f = 80 / tan 20 degrees = 219.8 pixels: a point 300 km below moves by 20 pixels for a base of 27.3 km.
  const vpe::core::RgbImage pair = draw("p.png", {"--stereo", "sbs", "--eye-base", "27298"});
  ASSERT_EQ(pair.width, 2 * kWidth);
  ASSERT_EQ(pair.height, kHeight);
  const auto difference = [&](int shift) {
    double sum = 0;
    for (int y = 40; y < 120; ++y) {
      for (int x = 40; x < 160; ++x) {
        const auto row = pair.pixels.begin() + y * pair.width;
        sum += std::abs(row[x + shift].r - row[kWidth + x].r) + std::abs(row[x + shift].g - row[kWidth + x].g);
      }
    }
    return sum;
  };
  int best = -40;
  for (int shift = -40; shift <= 40; ++shift) {
    if (difference(shift) < difference(best)) best = shift;
  }
  EXPECT_NEAR(best, 20, 1);  // the left eye sees it further right

  // Converging on the ground: no shift left there.
  const vpe::core::RgbImage meeting =
      draw("m.png", {"--stereo", "ou", "--eye-base", "27298", "--convergence", "300000"});
  ASSERT_EQ(meeting.height, 2 * kHeight);
  double apart = 0;
  double spread = 0;
  for (int y = 40; y < 120; ++y) {
    for (int x = 40; x < 160; ++x) {
      const auto at = [&](int row, int column) {
        return meeting.pixels[static_cast<std::size_t>(row * kWidth + column)].g;
      };
      apart += std::abs(at(y, x) - at(y + kHeight, x));
      spread += std::abs(at(y, x) - at(y + kHeight, x - 20));
    }
  }
  EXPECT_LT(apart, 0.5 * spread);
}

TEST_F(StereoRender, TheDefaultBaseIsAThirtiethOfTheNearestDistance) {
  const Result result = vpe(words("p.png", {"--stereo", "anaglyph", "--json", "--certificate", "c.json"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  draw("one.png", {"--range", "r.tif"});
  const vpe::core::FloatImage range = vpe::core::read_tiff(dir_ / "r.tif");
  const double nearest_m = *std::min_element(range.pixels.begin(), range.pixels.end());
  const auto json = parse_json(result.out);
  EXPECT_NEAR(json["eye_base_m"].get<double>(), nearest_m / 30.0, 1e-6 * nearest_m);
  EXPECT_EQ(vpe::core::read_image(dir_ / "p.png").width, kWidth);
  const auto certificate = parse_json(read_text(dir_ / "c.json"));
  EXPECT_TRUE(certificate.contains("left") && certificate.contains("right"));
}

TEST_F(StereoRender, WrongUsage) {
  const auto fails = [&](const Words& more, const Words& parts, int code = 2) {
    expect_failure(words("x.png", more), code, parts);
    EXPECT_FALSE(exists("x.png"));
  };
  fails({"--stereo", "cross"}, {"--stereo", "cross"});
  fails({"--eye-base", "3"}, {"--eye-base", "--stereo"});
  for (const char* bad : {"0", "-1", "nan", "1e9"})
    fails({"--stereo", "sbs", "--eye-base", bad}, {"--eye-base", bad});
  for (const char* bad : {"0", "nan"}) fails({"--stereo", "sbs", "--convergence", bad}, {"--convergence", bad});
  fails({"--stereo", "sbs", "--range", "r.tif"}, {"--range", "one eye"});
  fails({"--stereo", "sbs", "--eye-base", "1000000", "--convergence", "0.01"}, {"--stereo", "principal"});
  const Result sky = vpe({"render", planet().string(), "--pose", "20,10,300000,0,60,0", "--size", "64x48",
                          "--stereo", "sbs", "-o", "x.png"});
  EXPECT_EQ(sky.exit_code, 1);
  EXPECT_TRUE(says(sky.err, {"shows only sky", "--eye-base"}));
}

}  // namespace
}  // namespace app_test
