// vpe match as a user runs it: photographs that vpe render made.
#include <cmath>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

using nlohmann::json;

class Match : public AppTest {
 protected:
  // Ridges of some hundred metres around a plain of 2 km, posts 59 m apart.
  void SetUp() override {
    AppTest::SetUp();
    Dem dem;
    dem.width = 500;
    dem.height = 500;
    dem.west_deg = 9.75;
    dem.north_deg = 0.25;
    dem.cell_deg = 0.001;
    dem.height_m = [](int column, int row) {
      const double x = (column - 250) / 250.0;
      const double y = (row - 250) / 250.0;
      const double far = std::min(1.0, 3 * std::hypot(x, y));
      double height = 0;
      for (int k = 1; k <= 60; ++k) {
        const double turn = 2.4 * k * k;
        height += 130 / std::sqrt(k) * std::sin(3.1 * k * (x * std::cos(turn) + y * std::sin(turn)) + turn);
      }
      return far * far * height;
    };
    write_dem(dir_ / "hills.tif", dem);
    const Result built = vpe({"build", "hills.tif", "-o", "hills.vpe", "--base-spacing", "30000", "-q"});
    ASSERT_EQ(built.exit_code, 0) << built.err;
  }

  // Draws a photograph from 20 m above 10, 0.
  void draw(const std::string& name, const std::string& attitude) const {
    const Result drawn = vpe({"render", "hills.vpe", "--pose", "10,0," + attitude, "--height", "20", "--fov",
                              "50", "--size", "800x500", "--backend", "ray", "-o", name, "-q"});
    ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  }

  Words words(const std::string& photo, const Words& more = {}) const {
    Words out{"match", photo, "hills.vpe", "--near", "10,0", "--height", "20"};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
};

TEST_F(Match, FindsWhatRenderWasTold) {
  for (const char* attitude : {"75,2,1", "200,-1,-2", "320,3,0.5"}) {
    draw("photo.png", attitude);
    const Result result = vpe(words("photo.png", {"--json", "-o", "fit.png", "-q"}));
    const json found = parse_json(result.out);
    std::printf("%s: %s\n", attitude, found.dump().c_str());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(found["found"], true);
    double yaw = 0;
    double pitch = 0;
    double roll = 0;
    ASSERT_EQ(std::sscanf(attitude, "%lf,%lf,%lf", &yaw, &pitch, &roll), 3);
    EXPECT_NEAR(found["pose"]["yaw_deg"].get<double>(), yaw, 0.1);
    EXPECT_NEAR(found["pose"]["pitch_deg"].get<double>(), pitch, 0.05);
    EXPECT_NEAR(found["pose"]["roll_deg"].get<double>(), roll, 0.05);
    EXPECT_NEAR(found["pose"]["fov_deg"].get<double>(), 50, 0.5);
    EXPECT_LT(found["residual_px"].get<double>(), 1.5);
    const auto fit = vpe::core::read_image(dir_ / "fit.png");
    EXPECT_EQ(fit.width, 800);
    EXPECT_EQ(fit.height, 500);
  }
}

// The words of "render" draw the photograph's view again.
TEST_F(Match, TheWordsForRenderAreAccepted) {
  draw("photo.png", "75,2,1");
  const json found = parse_json(vpe(words("photo.png", {"--fov", "50", "--json", "-q"})).out);
  Words again{"render", "hills.vpe"};
  for (const json& word : found["render"]) again.push_back(word.get<std::string>());
  again.insert(again.end(), {"--size", "80x50", "--backend", "ray", "-o", "again.png", "-q"});
  const Result drawn = vpe(again);
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  const Result text = vpe(words("photo.png", {"--fov", "50"}));
  EXPECT_TRUE(says(text.out, {"yaw", "residual", "vpe render hills.vpe --pose"}));
}

TEST_F(Match, APanoramaAndTheFullCircle) {
  const Result drawn =
      vpe({"panorama", "hills.vpe", "--at", "10,0", "--height", "20", "--projection", "equirectangular",
           "--width", "3600", "--elevation=-10,20", "-o", "pano.png", "-q"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  const Result result = vpe(words("pano.png", {"--projection", "equirectangular", "--degrees-per-pixel", "0.1",
                                               "--horizon-row", "200", "--json", "-q"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json found = parse_json(result.out);
  EXPECT_NEAR(std::remainder(found["pose"]["yaw_deg"].get<double>(), 360), 0, 0.1);
  EXPECT_NEAR(found["pose"]["pitch_deg"].get<double>(), 0, 0.05);
  EXPECT_FALSE(found.contains("render"));
}

TEST_F(Match, WhatIsNotFoundHasAReasonAndNoPose) {
  const std::vector<vpe::base::Rgb> black(200 * 100);
  vpe::core::write_image(dir_ / "black.png", black, 200, 100);
  expect_failure(words("black.png", {"-q"}), 1, {"black.png", "not found", "0 of 200 columns"});
  const Result result = vpe(words("black.png", {"--json", "-q", "-o", "fit.png"}));
  EXPECT_EQ(result.exit_code, 1);
  const json answer = parse_json(result.out);
  EXPECT_EQ(answer["found"], false);
  EXPECT_EQ(answer["reason"]["kind"], "few-columns");
  EXPECT_FALSE(answer.contains("pose"));
  EXPECT_TRUE(exists("fit.png"));
}

TEST_F(Match, BadInput) {
  write_text(dir_ / "text.png", "no image");
  expect_failure(words("text.png"), 1, {"text.png"});
  expect_failure(words("absent.png"), 1, {"absent.png"});
  vpe::core::write_image(dir_ / "thin.png", std::vector<vpe::base::Rgb>(300), 1, 300);
  expect_failure(words("thin.png"), 1, {"thin.png", "16 x 16"});
  expect_failure({"match", "thin.png", "hills.vpe"}, 2, {"--near"});
  expect_failure({"match", "thin.png", "hills.vpe", "--near", "10"}, 2, {"--near"});
  expect_failure(words("thin.png", {"--radius", "0"}), 2, {"--radius"});
  expect_failure(words("thin.png", {"--fov", "200"}), 2, {"--fov"});
  expect_failure(words("thin.png", {"--degrees-per-pixel", "0.1"}), 2, {"--projection"});
  expect_failure(words("thin.png", {"--projection", "cylinder"}), 2, {"--degrees-per-pixel", "--horizon-row"});
  expect_failure(words("thin.png", {"-o", "thin.png"}), 2, {"thin.png"});
  expect_failure(words("thin.png", {"-o", "fit.tif"}), 1, {"fit.tif"});
}

}  // namespace
}  // namespace app_test
