#include "vpe/explore/files/key_file.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

namespace vpe::explore {
namespace {

enum class Fruit { kApple, kPear };

struct Things {
  double size = 1;
  int count = 2;
  bool on = false;
  Fruit fruit = Fruit::kApple;
  std::string word = "a";
  std::optional<mars::Pose> pose;
};

const core::KeyRegistry<Things>& keys() {
  using T = Things;
  using Declare = core::KeyMembers<Things>;
  static const core::KeyRegistry<Things> all({
      {"one.size", Declare::number<&T::size>(0, 10), "", "how large"},
      {"one.count", Declare::integer<&T::count>(1, 99), "", "how many"},
      {"one.on", Declare::toggle<&T::on>(), "", "whether"},
      {"two.fruit",
       Declare::choice<&T::fruit>({core::word("apple", Fruit::kApple), core::word("pear", Fruit::kPear)}), "",
       "which"},
      {"two.word",
       Declare::text<&T::word>("a text without x",
                               [](const std::string& text) {
                                 return std::string(text.find('x') == std::string::npos ? "" : "has an x");
                               }),
       "", "what"},
      {"two.pose", Declare::pose<&T::pose>(), "", "where"},
  });
  return all;
}

Things read(std::string_view text) {
  Things things;
  read_keys(text, "F.toml", keys(), things);
  return things;
}

std::string why(std::string_view text) {
  try {
    read(text);
    return "";
  } catch (const KeyFileError& e) {
    return e.what();
  }
}

std::string written(const Things& things, KeysShown shown) { return write_keys(keys(), things, shown); }

TEST(KeyFile, ReadsWhatIsNamedAndLeavesTheRest) {
  const Things t = read("[two]\nfruit = \"pear\"\npose = [1, -2.5, 3e4, 0, 0, 0]\n[one]\nsize = 3\n");
  EXPECT_EQ(t.fruit, Fruit::kPear);
  EXPECT_EQ(t.size, 3);
  EXPECT_EQ(t.count, 2);
  EXPECT_EQ(t.word, "a");
  ASSERT_TRUE(t.pose.has_value());
  EXPECT_EQ(t.pose->lat_deg, -2.5);
  EXPECT_EQ(t.pose->alt_m, 3e4);
  EXPECT_FALSE(read("two.pose = []").pose.has_value());
  EXPECT_EQ(read("").size, 1);
}

TEST(KeyFile, RefusesWithFileLineKeyAndWhatIsAllowed) {
  EXPECT_EQ(why("\n\n[one]\nsize = 11"), "F.toml:4: one.size: expected a number from 0 to 10, found 11");
  EXPECT_EQ(why("[one]\ncount = 2.5"), "F.toml:2: one.count: expected a whole number from 1 to 99, found 2.5");
  EXPECT_EQ(why("[one]\non = \"yes\""), "F.toml:2: one.on: expected true or false, found 'yes'");
  EXPECT_EQ(why("[two]\nfruit = \"plum\""), "F.toml:2: two.fruit: expected one of apple, pear, found 'plum'");
  EXPECT_EQ(why("[two]\nword = \"axe\""), "F.toml:2: two.word: expected a text without x, found 'axe'");
  EXPECT_EQ(why("[two]\nwrod = \"a\""),
            "F.toml:2: unknown key 'two.wrod'; keys of [two] are fruit, word, pose");
  EXPECT_EQ(why("[three]\na = 1"), "F.toml:1: unknown table or key 'three'; tables are one, two");
  EXPECT_EQ(why("size = 1"), "F.toml:1: unknown table or key 'size'; tables are one, two");
  EXPECT_EQ(why("one = 1"), "F.toml:1: 'one' is a table; its keys are size, count, on");
  EXPECT_EQ(why("[one]\nsize = \n").find("F.toml:2: not TOML: "), 0U) << why("[one]\nsize = \n");
}

TEST(KeyFile, RefusesValuesOfOtherKinds) {
  for (const char* bad : {"one.size = nan",
                          "one.size = inf",
                          "one.size = \"3\"",
                          "one.size = [1]",
                          "one.size = -1e-9",
                          "one.count = 0",
                          "one.count = 100",
                          "one.count = 9223372036854775807",
                          "one.count = true",
                          "one.on = 1",
                          "two.fruit = 0",
                          "two.fruit = \"Apple\"",
                          "two.word = 1979-05-27",
                          "two.pose = [1, 2, 3]",
                          "two.pose = [0, 91, 0, 0, 0, 0]",
                          "two.pose = [0, nan, 0, 0, 0, 0]",
                          "two.pose = [0, \"a\", 0, 0, 0, 0]",
                          "two.pose = 1",
                          "one.size.x = 1",
                          "\"\" = 1"}) {
    EXPECT_EQ(why(bad).find("F.toml:1: "), 0U) << bad << "\n" << why(bad);
  }
  // Letters beyond ASCII where a key or a value is expected: toml++ 3.3 has a hole in its table of spaces
  // there.
  for (const char* bad : {"\xc3\xb6 = 1", "[\xc3\xb6]", "one.size = \xc3\xb6", "one.size \xe3\x80\x81= 1",
                          "one.size = 1 \xc3\xb6", "\xef\xbf\xbd"}) {
    EXPECT_EQ(why(bad).find("F.toml:1: not TOML: "), 0U) << bad << "\n" << why(bad);
  }
  std::string many_parts = "one";
  for (int n = 0; n < 200'000; ++n) many_parts += ".a";
  EXPECT_EQ(why(many_parts + " = 1").find("F.toml:1: expected keys with fewer dots"), 0U);
  EXPECT_LT(why("two.fruit = \"" + std::string(10'000, 'a') + "\"").size(), 200U);
}

RC_GTEST_PROP(KeyFileProperty, WhatIsWrittenIsReadBack, ()) {
  Things t;
  t.size = *rc::gen::arbitrary<std::uint32_t>() / 4294967295.0 * 10;
  t.count = *rc::gen::inRange(1, 100);
  t.on = *rc::gen::arbitrary<bool>();
  t.fruit = *rc::gen::element(Fruit::kApple, Fruit::kPear);
  t.word = *rc::gen::container<std::string>(
      rc::gen::suchThat(rc::gen::inRange<char>(0, 127), [](char c) { return c != 'x'; }));
  if (*rc::gen::arbitrary<bool>()) {
    const auto part = [](double limit) { return limit * (*rc::gen::arbitrary<std::int32_t>() / 2147483648.0); };
    t.pose = mars::Pose{part(360), part(90), part(1e12), part(360), part(90), part(360)};
  }
  for (const KeysShown shown : {KeysShown::kAll, KeysShown::kChanged}) {
    const Things back = read(written(t, shown));
    RC_ASSERT(back.size == t.size && back.count == t.count && back.on == t.on && back.fruit == t.fruit);
    RC_ASSERT(back.word == t.word);
    RC_ASSERT(back.pose.has_value() == t.pose.has_value());
    if (t.pose) {
      RC_ASSERT(back.pose->lon_deg == t.pose->lon_deg && back.pose->alt_m == t.pose->alt_m &&
                back.pose->roll_deg == t.pose->roll_deg);
    }
  }
}

RC_GTEST_PROP(KeyFileProperty, AnyTextIsReadOrRefused, (const std::string& text)) {
  const std::string problem = why(text) + why("[one]\n" + text) + why("[two]\nword = \"" + text + "\"");
  if (!problem.empty()) RC_ASSERT(problem.starts_with("F.toml:"));
}

TEST(KeyFile, DefaultsAreComments) {
  Things t;
  t.count = 5;
  EXPECT_EQ(
      written(t, KeysShown::kChanged),
      "[one]\n"
      "# size = 1  # how large; a number from 0 to 10; default 1\n"
      "count = 5  # how many; a whole number from 1 to 99; default 2\n"
      "# on = false  # whether; true or false; default false\n"
      "\n[two]\n"
      "# fruit = \"apple\"  # which; one of apple, pear; default \"apple\"\n"
      "# word = \"a\"  # what; a text without x; default \"a\"\n"
      "# pose = []  # where; [longitude, latitude, altitude, yaw, pitch, roll] in degrees and metres, or []; "
      "default []\n");
}

TEST(KeyFile, TextsThatTomlCannotHoldAreLeftOut) {
  Things t;
  for (const char* word : {"a\xff", "\xc3", "\xed\xa0\x80"}) {
    t.word = word;
    EXPECT_EQ(read(written(t, KeysShown::kAll)).word, "");
  }
  t.word = "K\xc3\xb6ln \"\\\n";
  EXPECT_EQ(read(written(t, KeysShown::kAll)).word, t.word);
}

}  // namespace
}  // namespace vpe::explore
