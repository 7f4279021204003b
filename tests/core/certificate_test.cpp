#include "vpe/core/certificate.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "mars/sources/source.h"

namespace vpe::core {
namespace {

TEST(Certificate, EveryFieldUnderItsOwnName) {
  Certificate c;
  c.geometric_error_m = 1.25;
  c.screen_space_error_px = 0.5;
  c.quantisation_m = 0.001;
  c.quantisation_px = 0.0001;
  c.shift_bound_px = 0.5001;
  c.image_bound_px = 0.375;
  c.tolerance_px = 1;
  c.tiles_drawn = 12;
  c.tiles_missing = 3;
  c.tiles_substituted = 4;
  c.share_at_data_limit = 0.25;
  c.nodata_share = 0.125;
  c.resampling_max_m = 7.5;
  c.resampling_rms_m = 0.75;
  c.source_accuracy_m = 3;
  c.illustration = true;
  c.synthetic = "The elevations are synthetic (fractal), not data.";
  c.exaggeration = 2;
  c.corner_stretch = 2.5;
  c.is_below_ground = true;
  c.thinning_px = 2.125;
  c.middle_bound_px = 0.25;
  c.sample_distance_px = 0.5;
  c.smoothing_m = 1.75;
  c.smoothing_px = 0.0625;
  c.carried = Certificate::Carried{0.875, 0.9, 0.0625, 0.0375};
  nlohmann::json json = nlohmann::json::parse(to_json(c).dump(2));
  const std::string meaning = json.at("what_this_means");
  EXPECT_NE(meaning.find(" " + c.synthetic), std::string::npos);
  EXPECT_NE(meaning.find("not covered"), std::string::npos);
  EXPECT_NE(meaning.find("thinning_px"), std::string::npos);
  EXPECT_NE(meaning.find("rays.sample=nearest"), std::string::npos);
  EXPECT_NE(meaning.find("smoothing_px"), std::string::npos);
  EXPECT_NE(meaning.find("carrying_px"), std::string::npos);
  EXPECT_NE(meaning.find("striped"), std::string::npos);
  EXPECT_NE(meaning.find("stretched, up to 2.5 times"), std::string::npos);
  EXPECT_NE(meaning.find("below the ground"), std::string::npos);
  json.erase("what_this_means");
  EXPECT_EQ(
      json,
      nlohmann::json({{"tile_error_m", 1.25},      {"tile_error_px", 0.5},        {"quantisation_m", 0.001},
                      {"quantisation_px", 0.0001}, {"shift_bound_px", 0.5001},    {"picture_bound_px", 0.375},
                      {"thinning_px", 2.125},      {"middle_bound_px", 0.25},     {"sample_distance_px", 0.5},
                      {"tolerance_px", 1.0},       {"tiles_drawn", 12},           {"tiles_missing", 3},
                      {"tiles_substituted", 4},    {"share_at_data_limit", 0.25}, {"share_without_data", 0.125},
                      {"resampling_max_m", 7.5},   {"resampling_rms_m", 0.75},    {"source_accuracy_m", 3.0},
                      {"illustration", true},      {"exaggeration", 2.0},         {"corner_stretch", 2.5},
                      {"below_ground", true},      {"carrying_px", 0.875},        {"carried_share", 0.9},
                      {"between_share", 0.0625},   {"drawn_share", 0.0375},       {"smoothing_m", 1.75},
                      {"smoothing_px", 0.0625}}));
}

TEST(Certificate, TheSourcesSayWhatIsSynthetic) {
  std::vector<mars::SourceInfo> sources(2);
  sources[0].name = "mola.tif";
  sources[0].accuracy_m = 3;
  sources[1].name = "embedded-detail";
  sources[1].accuracy_m = 140;
  Certificate c;
  state_data(c, {}, sources);
  EXPECT_EQ(c.synthetic, "");
  EXPECT_EQ(c.source_accuracy_m, 140);
  sources[1].illustration = true;
  state_data(c, {.illustration = true}, sources);
  EXPECT_EQ(
      c.synthetic,
      "Elevations are those of mola.tif; ground smaller than their posts is synthetic (embedded-detail), not data.");
  sources[0].illustration = true;
  state_data(c, {.illustration = true}, sources);
  EXPECT_EQ(c.synthetic, "The elevations are synthetic (mola.tif and embedded-detail), not data.");
}

TEST(Certificate, AbsentAndNotFiniteAreNull) {
  Certificate c;
  c.geometric_error_m = std::numeric_limits<double>::infinity();
  c.screen_space_error_px = std::numeric_limits<double>::quiet_NaN();
  const nlohmann::json json = nlohmann::json::parse(to_json(c).dump(2));
  EXPECT_TRUE(json.at("source_accuracy_m").is_null());
  EXPECT_TRUE(json.at("share_without_data").is_null());
  EXPECT_TRUE(json.at("picture_bound_px").is_null());
  EXPECT_TRUE(json.at("tile_error_m").is_null());
  EXPECT_TRUE(json.at("tile_error_px").is_null());
  const std::string meaning = json.at("what_this_means");
  EXPECT_EQ(meaning.find("not data"), std::string::npos);
  EXPECT_EQ(meaning.find("not covered"), std::string::npos);
  EXPECT_EQ(meaning.find("striped"), std::string::npos);
}

TEST(Certificate, NumbersSurviveToTheBit) {
  Certificate c;
  c.geometric_error_m = 0.1 + 0.2;
  c.shift_bound_px = 5e-324;
  const nlohmann::json json = nlohmann::json::parse(to_json(c).dump(2));
  EXPECT_EQ(json.at("tile_error_m").get<double>(), c.geometric_error_m);
  EXPECT_EQ(json.at("shift_bound_px").get<double>(), c.shift_bound_px);
}

}  // namespace
}  // namespace vpe::core
