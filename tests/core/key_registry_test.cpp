#include "vpe/core/registry/key_registry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vpe::core {
namespace {

enum class Shape { kRound, kSquare };

struct Inner {
  bool on = false;
  int count = 3;
};

struct Base {
  double length_m = 2;
};

struct Things : Base {
  Inner inner;
  Shape shape = Shape::kRound;
  bool is_soft = true;
  std::string title = "a";
  LevelTable table;
  std::optional<mars::Pose> pose;
};

std::string problem_of(const std::string& text) { return text == "bad" ? "it is bad" : ""; }

const KeyRegistry<Things>& keys() {
  using T = Things;
  using Declare = KeyMembers<Things>;
  static const KeyRegistry<Things> all({
      {"length", Declare::number<&T::length_m>(-1, 10), "m", "length"},
      {"inner.on", Declare::toggle<&T::inner, &Inner::on>(), "", "on"},
      {"inner.count", Declare::integer<&T::inner, &Inner::count>(1, 9), "", "count"},
      {"shape", Declare::choice<&T::shape>({word("round", Shape::kRound), word("square", Shape::kSquare)}), "",
       "shape"},
      {"edge", Declare::choice<&T::is_soft>({word("hard", false), word("soft", true)}), "", "edge"},
      {"title", Declare::text<&T::title>("any text but bad", problem_of), "", "title"},
      {"table", Declare::table<&T::table>(), "", "table"},
      {"pose", Declare::pose<&T::pose>(), "", "pose"},
  });
  return all;
}

const KeyInfo& info(std::string_view name) { return keys().infos()[keys().find(name).value()]; }

std::string set(Things& things, std::string_view name, std::string_view text) {
  std::string problem;
  const auto value = parse_value(info(name), text, problem);
  if (!value) return "refused: " + problem;
  keys().set(*keys().find(name), things, *value);
  return "";
}

std::string get(const Things& things, std::string_view name) {
  return print_value(info(name), keys().get(*keys().find(name), things));
}

TEST(KeyRegistry, BindsEachKeyToItsMember) {
  Things t;
  EXPECT_EQ(set(t, "length", "2.5"), "");
  EXPECT_EQ(set(t, "inner.on", "on"), "");
  EXPECT_EQ(set(t, "inner.count", "9"), "");
  EXPECT_EQ(set(t, "shape", "square"), "");
  EXPECT_EQ(set(t, "edge", "hard"), "");
  EXPECT_EQ(set(t, "title", "b"), "");
  EXPECT_EQ(set(t, "table", "0:1"), "");
  EXPECT_EQ(t.length_m, 2.5);
  EXPECT_TRUE(t.inner.on);
  EXPECT_EQ(t.inner.count, 9);
  EXPECT_EQ(t.shape, Shape::kSquare);
  EXPECT_FALSE(t.is_soft);
  EXPECT_EQ(t.title, "b");
  EXPECT_EQ(t.table, (LevelTable{{0, 1}}));
  for (const auto& [name, text] : {std::pair("length", "2.5"),
                                   {"inner.on", "on"},
                                   {"inner.count", "9"},
                                   {"shape", "square"},
                                   {"edge", "hard"},
                                   {"title", "b"},
                                   {"table", "0:1"},
                                   {"pose", "[]"}}) {
    EXPECT_EQ(get(t, name), text) << name;
  }
  EXPECT_FALSE(keys().find("len").has_value());
  EXPECT_EQ(keys().values(t).size(), keys().infos().size());
}

TEST(KeyRegistry, RefusesWhatIsNotAllowed) {
  for (const auto& [name, text] : {std::pair("length", "10.5"),
                                   {"length", "nan"},
                                   {"length", ""},
                                   {"inner.on", "true"},
                                   {"inner.count", "0"},
                                   {"inner.count", "2.5"},
                                   {"inner.count", "99999999999"},
                                   {"shape", "Round"},
                                   {"table", "1"},
                                   {"pose", "[]"}}) {
    Things t;
    EXPECT_EQ(set(t, name, text), "refused: ") << name << "=" << text;
  }
  Things t;
  EXPECT_EQ(set(t, "title", "bad"), "refused: it is bad");
  EXPECT_EQ(set(t, "title", "a\nb"), "refused: it holds control characters");
}

TEST(KeyRegistry, SaysWhatIsAllowed) {
  EXPECT_EQ(allowed_text(info("length")), "a number from -1 to 10 m");
  EXPECT_EQ(allowed_text(info("inner.count")), "a whole number from 1 to 9");
  EXPECT_EQ(allowed_text(info("inner.on")), "one of off, on");
  EXPECT_EQ(allowed_text(info("inner.on"), {"false", "true", "true or false"}), "true or false");
  EXPECT_EQ(allowed_text(info("shape")), "one of round, square");
  EXPECT_EQ(allowed_text(info("title")), "any text but bad");
  EXPECT_EQ(allowed_text(info("table")), level_table_grammar());
}

TEST(KeyRegistry, SwitchesHaveTheWordsOfTheirFile) {
  const SwitchWords toml{"false", "true", "true or false"};
  std::string problem;
  EXPECT_TRUE(std::get<bool>(parse_value(info("inner.on"), "true", problem, toml).value()));
  EXPECT_FALSE(parse_value(info("inner.on"), "on", problem, toml).has_value());
  EXPECT_EQ(print_value(info("inner.on"), true, toml), "true");
  EXPECT_EQ(print_value(info("inner.on"), false), "off");
}

std::string limited(std::string_view name, const KeyValue& value, const KeyValue& fallback) {
  return print_value(info(name), within_limits(info(name), value, fallback));
}

TEST(KeyRegistry, BringsValuesWithinTheirLimits) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(limited("length", 99.0, 2.0), "10");
  EXPECT_EQ(limited("length", -99.0, 2.0), "-1");
  EXPECT_EQ(limited("length", nan, 2.0), "2");
  EXPECT_EQ(limited("length", 3.5, 2.0), "3.5");
  EXPECT_EQ(limited("inner.count", 0, 3), "1");
  EXPECT_EQ(limited("shape", 7, 0), "round");
  EXPECT_EQ(limited("title", std::string("bad"), std::string("a")), "a");
  const std::optional<mars::Pose> beyond = mars::Pose{0, 91, 0, 0, 0, 0};
  const std::optional<mars::Pose> good = mars::Pose{1, 90, 2, 3, 4, 5};
  EXPECT_FALSE(std::get<std::optional<mars::Pose>>(within_limits(info("pose"), beyond, good)).has_value());
  EXPECT_TRUE(std::get<std::optional<mars::Pose>>(within_limits(info("pose"), good, beyond)).has_value());
}

TEST(KeyRegistry, NamesNearOnes) {
  EXPECT_EQ(did_you_mean("lenght", keys().infos()), "");  // two typos are too many for a name of six letters
  EXPECT_EQ(did_you_mean("lengt", keys().infos()), "did you mean length?");
  EXPECT_EQ(did_you_mean("inner", keys().infos()), "did you mean inner.on, inner.count?");
  EXPECT_EQ(did_you_mean("", keys().infos()), "");
}

}  // namespace
}  // namespace vpe::core
