// The right eye of a panorama for one eye, against a panorama from where that eye stands.
#include <cmath>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

using vpe::core::RgbImage;

constexpr double kBase_m = 8000;

class SecondLook : public AppTest {
 protected:
  // Ground of hills some 60 km wide, so that the eyes differ.
  void SetUp() override {
    AppTest::SetUp();
    Dem dem;
    dem.width = 720;
    dem.height = 360;
    dem.cell_deg = 0.5;
    dem.height_m = [](int column, int row) {
      return 3000 * std::sin(3.1 * column + 0.7 * row) * std::cos(2.3 * row - 0.4 * column);
    };
    write_dem(dir_ / "hills.tif", dem);
    ASSERT_EQ(vpe({"build", "hills.tif", "-o", "hills.vpe", "--base-spacing", "40000", "-q"}).exit_code, 0);
  }

  void make(const std::string& name, double lon_deg, const Words& more = {}) const {
    Words words{"panorama",     path("hills.vpe"),
                "--at",         std::to_string(lon_deg) + ",10",
                "--altitude",   "60000",
                "--projection", "cylinder",
                "--width",      "1440",
                "--backend",    "ray",
                "--set",        "samples=1",
                "--set",        "mode=coloured",
                "--set",        "colour=aspect",
                "-o",           name};
    words.insert(words.end(), more.begin(), more.end());
    const Result made = vpe(words);
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  Result look(const Words& more) const {
    Words words{"overlook", "left.png", "--view", "0,-25", "--fov", "40", "--size", "240x160"};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }
  static inline const Words kCarried{"--stereo", "sbs", "--stereo-method", "reproject"};
};

double mean_difference(const RgbImage& a, const RgbImage& b, int from_x) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = from_x; x < a.width; ++x) {
      const auto n = static_cast<std::size_t>(y * a.width + x);
      sum += std::abs(a.pixels[n].r - b.pixels[n].r) + std::abs(a.pixels[n].g - b.pixels[n].g) +
             std::abs(a.pixels[n].b - b.pixels[n].b);
      count += 3;
    }
  }
  return sum / count;
}

TEST_F(SecondLook, IsThatOfAPanoramaFromTheRightEye) {
  // Looking north, the right eye is to the east.
  constexpr double kRadius_m = 3396190;
  const double shift_deg = kBase_m / kRadius_m / std::cos(10 * 3.14159265 / 180) * 180 / 3.14159265;
  make("left.png", 20, {"--aux-layers", "range"});
  make("right.png", 20 + shift_deg);
  ASSERT_EQ(look({"--right", "right.png", "--stereo", "sbs", "-o", "two.png"}).exit_code, 0);
  Words words = kCarried;
  words.insert(words.end(), {"--eye-base", std::to_string(kBase_m), "-o", "carried.png", "--json"});
  const Result carried = look(words);
  ASSERT_EQ(carried.exit_code, 0) << carried.err;
  const nlohmann::json told = parse_json(carried.out)["second_eye"];
  EXPECT_EQ(told["eye_base_m"], kBase_m);
  EXPECT_LT(told["filled_share"].get<double>(), 0.1);
  const RgbImage a = vpe::core::read_image(dir_ / "two.png");
  const RgbImage b = vpe::core::read_image(dir_ / "carried.png");
  ASSERT_EQ(a.width, 480);
  ASSERT_EQ(b.width, 480);
  // The left eyes are one image, the right ones nearly so.
  const double right = mean_difference(a, b, 240);
  RgbImage unmoved = b;
  for (int y = 0; y < b.height; ++y)
    for (int x = 0; x < 240; ++x)
      unmoved.pixels[static_cast<std::size_t>(y * 480 + 240 + x)] =
          b.pixels[static_cast<std::size_t>(y * 480 + x)];
  const double still = mean_difference(a, unmoved, 240);
  std::printf("right eyes differ by %.2f of 255 on the mean, by %.2f if nothing is moved\n", right, still);
  EXPECT_LT(right, 0.4 * still);
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < 240; ++x) {
      const auto n = static_cast<std::size_t>(y * 480 + x);
      // Rays of the wider image are the same but for rounding.
      ASSERT_NEAR(a.pixels[n].r, b.pixels[n].r, 1);
      ASSERT_NEAR(a.pixels[n].g, b.pixels[n].g, 1);
      ASSERT_NEAR(a.pixels[n].b, b.pixels[n].b, 1);
    }
}

TEST_F(SecondLook, ChoosesABaseAndSaysWhatIsWrong) {
  make("left.png", 20, {"--aux-layers", "range"});
  Words words = kCarried;
  words.insert(words.end(), {"-o", "a.png"});
  const Result chosen = look(words);
  ASSERT_EQ(chosen.exit_code, 0) << chosen.err;
  EXPECT_TRUE(says(chosen.err, {"eyes", "apart", "not in the panorama"})) << chosen.err;
  words.insert(words.end(), {"--right", "left.png"});
  EXPECT_TRUE(says(look(words).err, {"--right", "leave"}));
  EXPECT_TRUE(says(look({"--eye-base", "2", "-o", "b.png"}).err, {"--eye-base", "reproject"}));
  EXPECT_TRUE(says(look({"--stereo", "sbs", "-o", "b.png"}).err, {"one eye", "--stereo-method reproject"}));
  make("left.png", 20);
  words = kCarried;
  words.insert(words.end(), {"-o", "c.png"});
  const Result without = look(words);
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_TRUE(says(without.err, {"left.png", "no ranges", "--aux-layers range"})) << without.err;
  EXPECT_FALSE(exists("c.png"));
}

TEST_F(SecondLook, AHeadBesideThePlaceSeesWhatAPanoramaFromThereShows) {
  // Looking north: the head is to the east and higher. 3000 m of the ground's 60 km.
  constexpr double kRadius_m = 3396190;
  constexpr double kEast_m = 6000;
  const double shift_deg = kEast_m / kRadius_m / std::cos(10 * 3.14159265 / 180) * 180 / 3.14159265;
  make("left.png", 20, {"--aux-layers", "range"});
  make("moved.png", 20 + shift_deg);
  const auto view_of = [&](const std::string& image, const std::string& output, const Words& more) {
    Words words{"overlook", image,     "--view", "0,-25", "--fov", "40",
                "--size",   "240x160", "-o",     output,  "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  };
  const Result told = view_of("left.png", "head.png", {"--head", "6000,0,0"});
  ASSERT_EQ(told.exit_code, 0) << told.err;
  const nlohmann::json head = parse_json(told.out)["head"];
  EXPECT_NEAR(head["moved_m"].get<double>(), kEast_m, 1e-6);
  EXPECT_LT(head["filled_share"].get<double>(), 0.1);
  ASSERT_EQ(view_of("moved.png", "there.png", {}).exit_code, 0);
  ASSERT_EQ(view_of("left.png", "here.png", {}).exit_code, 0);
  const RgbImage seen = vpe::core::read_image(dir_ / "head.png");
  const RgbImage there = vpe::core::read_image(dir_ / "there.png");
  const RgbImage here = vpe::core::read_image(dir_ / "here.png");
  ASSERT_EQ(seen.pixels.size(), there.pixels.size());
  const double moved = mean_difference(seen, there, 0);
  const double still = mean_difference(here, there, 0);
  std::printf("views differ by %.2f of 255 on the mean, by %.2f if nothing is moved\n", moved, still);
  EXPECT_LT(moved, 0.4 * still);
}

TEST_F(SecondLook, AHeadMovesAtMostByAQuarterOfTheNearestRange) {
  make("left.png", 20, {"--aux-layers", "range"});
  const Result far = look({"--head", "0,0,-500000", "-o", "far.png", "--json"});
  ASSERT_EQ(far.exit_code, 0) << far.err;
  EXPECT_TRUE(says(far.err, {"quarter of the nearest range"})) << far.err;
  const nlohmann::json head = parse_json(far.out)["head"];
  EXPECT_LT(head["moved_m"].get<double>(), 60000);
  EXPECT_GT(head["moved_m"].get<double>(), 10000);
  EXPECT_TRUE(says(look({"--head", "1,2", "-o", "b.png"}).err, {"--head", "RIGHT,UP,BACK"}));
  EXPECT_TRUE(says(look({"--head", "1,0,0"}).err, {"-o", "head tracker"}));
  EXPECT_TRUE(
      says(look({"--head", "1,0,0", "--stereo", "sbs", "--stereo-method", "reproject", "-o", "b.png"}).err,
           {"--head", "--stereo"}));
  make("left.png", 20);
  EXPECT_TRUE(says(look({"--head", "1,0,0", "-o", "b.png"}).err, {"left.png", "--aux-layers range"}));
}

}  // namespace
}  // namespace app_test
