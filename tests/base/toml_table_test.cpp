// Tables of TOML files whose keys and values are checked.
#include "vpe/base/toml_table.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>

#include "vpe/base/number_range.h"
#include "vpe/base/toml_fault.h"

namespace vpe::base {
namespace {

constexpr NumberRange kShares{0, 1};

std::string no_problem(std::string_view text) { return text == "bad" ? "expected a good text" : ""; }

// Returns what is wrong, or "".
std::string problem_of(const std::string& text, const std::function<void(const TomlTable&)>& use) {
  const std::string file = "f.toml";
  try {
    const toml::table root = parse_toml(text, file);
    use(TomlTable(root, "[a]", file));
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

TEST(NumberRange, HoldsItsEndsUnlessItIsOpen) {
  const NumberRange open{0, 2, true};
  EXPECT_TRUE(is_within(0, kShares));
  EXPECT_TRUE(is_within(1, kShares));
  EXPECT_FALSE(is_within(1.0000001, kShares));
  EXPECT_FALSE(is_within(0, open));
  EXPECT_TRUE(is_within(1e-300, open));
  EXPECT_FALSE(is_within(std::numeric_limits<double>::quiet_NaN(), kShares));
  EXPECT_FALSE(
      is_within(std::numeric_limits<double>::infinity(), {0, std::numeric_limits<double>::infinity()}));
  EXPECT_EQ(range_text(kShares), "a number in [0, 1]");
  EXPECT_EQ(range_text(open), "a number in (0, 2]");
}

TEST(TomlTable, ReadsValuesOfTheirKinds) {
  const std::string file = "f.toml";
  const toml::table root =
      parse_toml("share = 1\ncount = 7\nword = \"good\"\nkind = \"b\"\non = true\nlist = [1, 0.5]\n", file);
  const TomlTable table(root, "[a]", file);
  table.require_known({"share", "count", "word", "kind", "on", "list"});
  EXPECT_TRUE(table.has("share"));
  EXPECT_FALSE(table.has("other"));
  EXPECT_EQ(table.number("share", kShares), 1);
  EXPECT_EQ(table.number("other", kShares, 0.25), 0.25);
  EXPECT_EQ(table.integer("count", 1, 9), 7);
  EXPECT_EQ(table.text("word", no_problem), "good");
  EXPECT_EQ(table.choice("kind", {"a", "b"}), 1U);
  EXPECT_TRUE(table.truth("on"));
  EXPECT_EQ(table.list("list", "numbers").size(), 2U);
  const toml::array& parts = table.list_of(table.at("list"), "list", 2, 3, "two numbers");
  EXPECT_EQ(table.number_of(parts[1], "list", kShares), 0.5);
}

TEST(TomlTable, RefusesWithFileLineKeyAndWhatIsAllowed) {
  const auto number = [](const TomlTable& t) { t.number("x", kShares); };
  EXPECT_EQ(problem_of("\nx = 2\n", number), "f.toml:2: x: expected a number in [0, 1], found 2");
  EXPECT_EQ(problem_of("x = \"1\"\n", number), "f.toml:1: x: expected a number in [0, 1], found \"1\"");
  EXPECT_EQ(problem_of("y = 1\n", number), "f.toml:1: x is missing in [a]");
  EXPECT_EQ(problem_of("x = 3\n",
                       [](const TomlTable& t) {
                         t.require_known({"y", "z"});
                       }),
            "f.toml:1: unknown key \"x\" in [a]; keys are y and z");
  EXPECT_EQ(problem_of("x = 10\n", [](const TomlTable& t) { t.integer("x", 1, 9); }),
            "f.toml:1: x: expected an integer in [1, 9], found 10");
  EXPECT_EQ(problem_of("x = \"bad\"\n", [](const TomlTable& t) { t.text("x", no_problem); }),
            "f.toml:1: x: expected a good text, found \"bad\"");
  EXPECT_EQ(problem_of("x = \"c\"\n",
                       [](const TomlTable& t) {
                         t.choice("x", {"a", "b"});
                       }),
            "f.toml:1: x: expected a or b, found \"c\"");
  EXPECT_EQ(problem_of("x = 1\n", [](const TomlTable& t) { t.truth("x"); }),
            "f.toml:1: x: expected true or false, found 1");
  EXPECT_EQ(problem_of("x = []\n", [](const TomlTable& t) { t.list("x", "numbers"); }),
            "f.toml:1: x: expected a list of numbers, found a list of 0");
  EXPECT_EQ(problem_of("x = [1]\n", [](const TomlTable& t) { t.list_of(t.at("x"), "x", 2, 2, "[a, b]"); }),
            "f.toml:1: x: expected [a, b], found a list of 1");
}

TEST(ParseToml, SaysWhatIsNotToml) {
  const auto nothing = [](const TomlTable&) {};
  EXPECT_EQ(problem_of("a = 1\n", nothing), "");
  EXPECT_EQ(problem_of("", nothing), "");
  EXPECT_EQ(problem_of("a = 1\nb = \n", nothing).find("f.toml:2: not TOML: "), 0U);
  EXPECT_EQ(
      problem_of("a = 1\r\n\xc3\xb6 = 2\r\n", nothing),
      "f.toml:2: not TOML: expected letters of ASCII outside of texts and comments, found \"\xc3\xb6 = 2\"");
  // What the library reads, but does not survive.
  std::string many_parts = "a";
  for (int n = 0; n < 200'000; ++n) many_parts += ".a";
  EXPECT_EQ(
      problem_of(many_parts + " = 1\n", nothing).find("f.toml:1: expected keys with fewer dots, found \"a.a.a"),
      0U);
  EXPECT_EQ(
      problem_of("a = 10:00\n", nothing),
      "f.toml:1: expected a number, a text, a list or true or false, not a date or time, found \"a = 10:00\"");
}

TEST(ParseToml, LongTextsAreReadWhereTheyAreAllowed) {
  const std::string marks = "\"\"\"";
  const std::string text = "a = " + marks + "one\n\\\"\"\" 10:00 [ \xc3\xb6\n" + marks + "\nc = 3\n";
  EXPECT_THROW(parse_toml(text, "f.toml"), std::runtime_error);
  const toml::table root = parse_toml(text, "f.toml", true);
  EXPECT_EQ(root["a"].value<std::string>(), "one\n\"\"\" 10:00 [ \xc3\xb6\n");
  EXPECT_EQ(root["c"].value<int>(), 3);
  // What comes behind is checked, with its line.
  EXPECT_EQ(hostile_toml("a = " + marks + "\n\n" + marks + "\nb = ]\n", true).line, 4U);
  EXPECT_EQ(hostile_toml("a = " + marks + "\n\n", true).line, 0U);  // the library says that it does not end
}

}  // namespace
}  // namespace vpe::base
