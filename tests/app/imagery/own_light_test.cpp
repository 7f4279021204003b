// Imagery that is known as photographs with their own light: notes of builds, vpe info, parts and patches.
#include "tests/app/support/app_fixture.h"
#include "tests/support/labelled_image.h"

namespace app_test {
namespace {

using nlohmann::json;

constexpr const char* kStated = "a photograph with its own light";

class OwnLightCommands : public AppTest {
 protected:
  void SetUp() override {
    write_dem(dir_ / "x.tif");
    test_support::write_labelled_image(dir_.path(), "photo", test_support::kCameraKeywords);
    test_support::write_labelled_image(dir_.path(), "other", test_support::kCameraKeywords);
    test_support::write_labelled_image(dir_.path(), "plain", "");
  }

  Result build(const std::string& output, const Words& more) const {
    Words words{"build", "x.tif", "-o", output, "--base-spacing", "100000"};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }

  // Returns the flags of a planet's imagery, in the order of its sources.
  std::vector<bool> flags(const std::string& planet) const {
    const json info = parse_json(vpe({"info", planet, "--json"}).out);
    std::vector<bool> all;
    for (const json& source : info.at("image_sources")) all.push_back(source.at("own_light").get<bool>());
    EXPECT_FALSE(info.at("sources").at(0).contains("own_light"));
    return all;
  }
};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
  return found;
}

TEST_F(OwnLightCommands, ABuildNotesItOnceAndInfoStatesIt) {
  const Result photo = build("photo.vpe", {"--image", "photo.lbl"});
  ASSERT_EQ(photo.exit_code, 0) << photo.err;
  EXPECT_EQ(count(photo.err, kStated), 1U) << photo.err;
  EXPECT_TRUE(says(photo.err, {"vpe: note: ", "without synthetic light", "--set light=on"}));
  EXPECT_TRUE(says(vpe({"info", "photo.vpe"}).out, {"image from", "photo.lbl", kStated}));
  EXPECT_EQ(flags("photo.vpe"), std::vector<bool>{true});

  const Result quiet = build("quiet.vpe", {"--image", "photo.lbl", "-q"});
  ASSERT_EQ(quiet.exit_code, 0) << quiet.err;
  EXPECT_EQ(count(quiet.err, kStated), 0U) << quiet.err;

  const Result plain = build("plain.vpe", {"--image", "plain.lbl"});
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_EQ(count(plain.err, kStated), 0U) << plain.err;
  EXPECT_EQ(count(vpe({"info", "plain.vpe"}).out, kStated), 0U);
  EXPECT_EQ(flags("plain.vpe"), std::vector<bool>{false});
}

// Imagery of which some is unknown is lit, so that there is nothing to note.
TEST_F(OwnLightCommands, MixedImageryIsStatedBySource) {
  const Result mixed = build("p.vpe", {"--image", "photo.lbl", "--image", "plain.lbl"});
  ASSERT_EQ(mixed.exit_code, 0) << mixed.err;
  EXPECT_EQ(count(mixed.err, kStated), 0U) << mixed.err;
  EXPECT_EQ(count(vpe({"info", "p.vpe"}).out, kStated), 1U);
  EXPECT_EQ(flags("p.vpe"), (std::vector<bool>{true, false}));
}

TEST_F(OwnLightCommands, PartsKeepItWhenTheyMerge) {
  for (const char* part : {"1/2", "2/2"}) {
    const Result built = build("p.vpe", {"--image", "photo.lbl", "--part", part});
    ASSERT_EQ(built.exit_code, 0) << built.err;
  }
  EXPECT_TRUE(says(vpe({"info", "p.1-of-2.vpe"}).out, {kStated}));
  const Result merged = vpe({"merge", "p.1-of-2.vpe", "p.2-of-2.vpe", "-o", "p.vpe"});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(flags("p.vpe"), std::vector<bool>{true});
}

TEST_F(OwnLightCommands, PatchesAddTheirOwn) {
  ASSERT_EQ(build("p.vpe", {"--image", "photo.lbl"}).exit_code, 0);
  const Result both = vpe({"patch", "p.vpe", "--image", "other.lbl", "-o", "both.vpe"});
  ASSERT_EQ(both.exit_code, 0) << both.err;
  EXPECT_EQ(count(both.err, kStated), 1U) << both.err;
  EXPECT_EQ(flags("both.vpe"), (std::vector<bool>{true, true}));
  const Result mixed = vpe({"patch", "p.vpe", "--image", "plain.lbl", "-o", "mixed.vpe"});
  ASSERT_EQ(mixed.exit_code, 0) << mixed.err;
  EXPECT_EQ(count(mixed.err, kStated), 0U) << mixed.err;
  EXPECT_EQ(flags("mixed.vpe"), (std::vector<bool>{true, false}));
}

}  // namespace
}  // namespace app_test
