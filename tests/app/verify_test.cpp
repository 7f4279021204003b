// vpe verify on the command line.
#include <filesystem>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

class VerifyCommand : public AppTest {};

TEST_F(VerifyCommand, AGoodFileIsSound) {
  const Result result = vpe({"verify", planet().string()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.out, {planet().string(), "sound", "6 tiles"}));
  const nlohmann::json json = parse_json(vpe({"verify", planet().string(), "--deep", "--json"}).out);
  EXPECT_TRUE(json.at("sound").get<bool>());
  EXPECT_GT(json.at("errors_measured_again").get<int>(), 0);
  EXPECT_GT(json.at("largest_share_of_a_stated_error").get<double>(), 0.5);
}

TEST_F(VerifyCommand, ADamagedTileIsNamedWithExitCode1) {
  std::filesystem::copy_file(planet(), dir_ / "x.vpe");
  damage_payloads(dir_ / "x.vpe", "heights");
  const Result result = vpe({"verify", "x.vpe"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(says(result.err, {"x.vpe", "problems; build the planet file again", "checksum"}));
  const Result json = vpe({"verify", "x.vpe", "--json"});
  EXPECT_EQ(json.exit_code, 1);
  EXPECT_FALSE(parse_json(json.out).at("sound").get<bool>());
  EXPECT_GE(parse_json(json.out).at("problems").size(), 1U);
}

TEST_F(VerifyCommand, OtherFilesAreRefused) {
  expect_failure({"verify"}, 2, {"PLANET"});
  expect_failure({"verify", "none.vpe"}, 1, {"none.vpe", "no such planet file"});
  write_text(dir_ / "text.vpe", "text");
  expect_failure({"verify", "text.vpe"}, 1, {"text.vpe"});
  expect_failure({"verify", planet().string(), "--sample", "0"}, 2, {"--sample"});
}

}  // namespace
}  // namespace app_test
