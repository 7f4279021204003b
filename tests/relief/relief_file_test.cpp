// Files of reliefs and lines of flights: reading, writing, messages.
#include "relief/files/relief_file.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <rapidcheck/gtest.h>
#include <fstream>
#include <stdexcept>

#include "relief/relief.h"
#include "relief/spec_line.h"
#include "relief/spec_polygon.h"
#include "tests/relief/random_relief.h"
#include "vpe/base/file.h"
#include "vpe/base/toml_fault.h"

namespace relief {
namespace {

std::string error_of(std::string_view text) {
  try {
    parse_relief_toml(text, "a.relief.toml");
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

std::string error_of_line(std::string_view line) {
  try {
    parse_relief_line(line);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

// A file with one relief of these lines, from line 3 on.
std::string error_of_relief(const std::string& lines) { return error_of("version = 1\n[[relief]]\n" + lines); }

constexpr const char* kPadAndLake = R"(version = 1

[[relief]]
name = "landing pad"
kind = "pad"
lon = 137.44
lat = -4.59
radius_m = 20
falloff_m = 8.5
mode = "replace"

[[relief]]   # a lake
kind = "flood"
lon = 137.5
lat = -4.6
rise_m = 12
polygon = [[137.49, -4.61], [137.51, -4.61],
  [137.5, -4.59]]
)";

TEST(ReliefFile, HoldsReliefsInTheirOrder) {
  const std::vector<ReliefSpec> reliefs = parse_relief_toml(kPadAndLake, "a.relief.toml");
  ASSERT_EQ(reliefs.size(), 2U);
  EXPECT_EQ(reliefs[0].name, "landing pad");
  EXPECT_EQ(reliefs[0].kind, ReliefKind::kPad);
  EXPECT_EQ(reliefs[0].place.lon_deg, 137.44);
  EXPECT_EQ(reliefs[0].radius_m, 20);
  EXPECT_EQ(reliefs[0].falloff_m, 8.5);
  EXPECT_EQ(reliefs[0].mode, Mode::kReplace);
  EXPECT_EQ(reliefs[0].level_m, std::nullopt);
  EXPECT_EQ(reliefs[1].kind, ReliefKind::kFlood);
  ASSERT_EQ(reliefs[1].polygon.size(), 3U);
  EXPECT_EQ(reliefs[1].polygon[1].lat_deg, -4.61);
  EXPECT_TRUE(parse_relief_toml("version = 1\n", "a.relief.toml").empty());
}

TEST(ReliefFile, MessagesNameFileLineAndReason) {
  const std::string place = "lon = 1\nlat = 2\n";
  EXPECT_EQ(error_of(""), "a.relief.toml:1: version is missing; expected version = 1");
  EXPECT_EQ(error_of("version = 2"), "a.relief.toml:1: version: expected 1");
  EXPECT_EQ(error_of("version = 1\nreliefs = 2"),
            "a.relief.toml:2: unknown key \"reliefs\"; keys are version and relief");
  EXPECT_EQ(error_of("version = 1\nrelief = 2"), "a.relief.toml:2: relief: expected tables [[relief]]");
  EXPECT_EQ(error_of("version = 1\n[[relief]]\nlon = 1\n"), "a.relief.toml:2: kind is missing in [[relief]]");
  EXPECT_EQ(
      error_of_relief("kind = \"pit\"\n"),
      "a.relief.toml:3: kind: expected one of crater, ramp, pad, trench, dune, dam, flood, noise, found \"pit\"");
  EXPECT_EQ(error_of_relief("kind = \"crater\"\nlat = 2\nradius_m = 5\n"),
            "a.relief.toml:2: lon is missing in [[relief]]");
  EXPECT_EQ(error_of_relief("kind = \"crater\"\n" + place),
            "a.relief.toml:2: radius_m is missing in [[relief]]");
  EXPECT_EQ(error_of_relief("kind = \"crater\"\n" + place + "radius_m = -3\n"),
            "a.relief.toml:6: radius_m: expected a number from 0.01 to 10000000 m, or auto, found \"-3\"");
  EXPECT_EQ(error_of_relief("kind = \"crater\"\n" + place + "radius_m = nan\n"),
            "a.relief.toml:6: radius_m: expected a number from 0.01 to 10000000 m, or auto, found \"nan\"");
  EXPECT_EQ(error_of_relief("kind = \"crater\"\n" + place + "radius_m = \"5\"\n"),
            "a.relief.toml:6: radius_m: expected a number from 0.01 to 10000000 m, or auto, found a text");
  EXPECT_EQ(error_of_relief("kind = \"crater\"\n" + place + "radius_m = [5]\n"),
            "a.relief.toml:6: radius_m: expected a number from 0.01 to 10000000 m, or auto, found a list");
  EXPECT_EQ(error_of_relief("kind = \"crater\"\n" + place + "radius_m = 5\nradius = 5\n"),
            "a.relief.toml:7: unknown key \"radius\" in [[relief]]; did you mean radius_m?");
  EXPECT_NE(error_of_relief("kind = \"crater\"\n" + place + "radius_m = 5\nzzz = 5\n")
                .find("keys of a crater are name, kind"),
            std::string::npos);
  EXPECT_NE(error_of_relief("kind = \"crater\"\n" + place + "radius_m = 5\nwavelength_m = 5\n")
                .find("a.relief.toml:7: wavelength_m: a crater has no such key; its keys are name, kind"),
            std::string::npos);
  EXPECT_EQ(error_of_relief("kind = \"pad\"\n" + place),
            "a.relief.toml:2: expected radius_m, or length_m and width_m, one of both");
  EXPECT_EQ(error_of_relief("kind = \"pad\"\n" + place + "radius_m = 3\nlength_m = 3\n"),
            "a.relief.toml:2: expected radius_m, or length_m and width_m, one of both");
  EXPECT_EQ(error_of_relief("kind = \"flood\"\n" + place),
            "a.relief.toml:2: expected radius_m or polygon in a flood, one of both");
  EXPECT_NE(error_of_relief("kind = \"flood\"\n" + place + "polygon = [[1, 2], [3, 4]]\n")
                .find("a.relief.toml:6: polygon: expected 3 to 2000 corners, found 2"),
            std::string::npos);
  EXPECT_NE(error_of_relief("kind = \"flood\"\n" + place + "polygon = [[1, 2], [3, 400], [1, 1]]\n")
                .find("LAT from -90 to 90"),
            std::string::npos);
  EXPECT_NE(error_of_relief("kind = \"flood\"\n" + place + "polygon = [[1, 2], [3, \"4\"], [1, 1]]\n")
                .find("a list of corners"),
            std::string::npos);
  EXPECT_EQ(
      error_of_relief("kind = \"crater\"\n" + place + "radius_m = 5\nlevel_m = 5\n"),
      "a.relief.toml:2: level_m and rise_m: expected none where the mode is add, which counts from the ground");
  EXPECT_EQ(
      error_of_relief("kind = \"crater\"\n" + place + "radius_m = 5\nseed.a.b = 5\n").find("a.relief.toml:7: "),
      0U);
  EXPECT_EQ(error_of_relief("name = 5\nkind = \"crater\"\n" + place + "radius_m = 5\n"),
            "a.relief.toml:3: name: expected a text of at most 200 bytes, found a number");
}

TEST(ReliefFile, NamesAreUnique) {
  const std::string one = "[[relief]]\nname = \"a\"\nkind = \"crater\"\nlon = 1\nlat = 2\nradius_m = 5\n";
  EXPECT_EQ(error_of("version = 1\n" + one + one), "a.relief.toml:9: there are two reliefs \"a\"");
}

TEST(ReliefFile, RefusesWhatTheLibraryDoesNotSurvive) {
  EXPECT_EQ(error_of("version = 1\na.b.c.d.e.f.g.h.i.j.k = 1\n"),
            "a.relief.toml:2: expected keys with fewer dots, found \"a.b.c.d.e.f.g.h.i.j.k = 1\"");
  EXPECT_EQ(error_of("version = 1979-05-27\n"),
            "a.relief.toml:1: expected a number, a text, a list or true or false, not a date or time, found "
            "\"version = 1979-05-27\"");
  EXPECT_NE(error_of("version = \n").find("a.relief.toml:1: not TOML"), std::string::npos);
  EXPECT_EQ(vpe::base::hostile_toml("a = 1\n").line, 0U);
  EXPECT_EQ(vpe::base::hostile_toml("a = 1\nb = ]\n").line, 2U);
}

TEST(ReliefFile, RefusesMoreReliefsThanAllowed) {
  std::string text = "version = 1\nrelief = [";
  for (std::size_t n = 0; n <= kMostReliefs; ++n) text += "{},";
  EXPECT_EQ(error_of(text + "]\n"), "a.relief.toml:2: expected at most 100000 reliefs, found 100001");
}

TEST(ReliefFile, IsReadAndWrittenUnderItsName) {
  const test_support::TempDir folder;
  const std::vector<ReliefSpec> reliefs = parse_relief_toml(kPadAndLake, "a.relief.toml");
  write_relief_file(reliefs, folder / "b.relief.toml");
  EXPECT_EQ(read_relief_file(folder / "b.relief.toml"), reliefs);
  EXPECT_TRUE(is_relief_path("folder/b.relief.toml"));
  EXPECT_FALSE(is_relief_path("b.scene.toml"));
  EXPECT_THROW(read_relief_file(folder / "none.relief.toml"), vpe::base::FileError);
  EXPECT_THROW(read_relief_file(folder / "b.toml"), vpe::base::FileError);
}

TEST(ReliefFile, WritesKeysThatAreNotUsual) {
  EXPECT_EQ(
      to_toml(std::vector{parse_relief_line("kind=crater lon=0.1 lat=-0 radius=1e-1 depth=30")}),
      "version = 1\n\n[[relief]]\nkind = \"crater\"\nlon = 0.1\nlat = -0.0\nradius_m = 0.1\ndepth_m = 30\n");
}

TEST(ReliefFile, RefusesToWriteWhatCannotBeRead) {
  ReliefSpec spec;
  EXPECT_THROW(to_toml(std::vector{spec}), std::invalid_argument);
  spec.radius_m = 5;
  spec.name = "a";
  EXPECT_NO_THROW(to_toml(std::vector{spec}));
  EXPECT_THROW(to_toml(std::vector{spec, spec}), std::invalid_argument);
  for (const char* name : {"a\nb", "a\tb", "\xff", "\x7f"}) {
    spec.name = name;
    EXPECT_THROW(to_toml(std::vector{spec}), std::invalid_argument) << name;
  }
  for (const char* name : {"a \"b\"", "'''", "back\\slash", "Krater \xc3\xbc"}) {
    spec.name = name;
    EXPECT_EQ(parse_relief_toml(to_toml(std::vector{spec}), "a")[0].name, name);
  }
}

RC_GTEST_PROP(ReliefFileProperty, WhatIsWrittenIsReadBack, (unsigned seed)) {
  test_support::Random random(seed);
  std::vector<ReliefSpec> specs;
  for (const ReliefKind kind : kEveryKind) {
    specs.push_back(random_relief(random, kind));
    if (random.integer(0, 1) == 0) specs.back().name = "n" + std::to_string(specs.size());
    RC_ASSERT(problem_of(specs.back()) == "");
  }
  RC_ASSERT(parse_relief_toml(to_toml(specs), "a.relief.toml") == specs);
  for (ReliefSpec spec : specs) {
    spec.name = "";
    RC_ASSERT(parse_relief_line(to_line(spec)) == spec);
  }
}

TEST(ReliefLine, HasKeysWithOrWithoutUnits) {
  const ReliefSpec spec = parse_relief_line("  kind=crater lon=1\tlat=2 radius=200 depth_m=60  ");
  EXPECT_EQ(spec.kind, ReliefKind::kCrater);
  EXPECT_EQ(spec.radius_m, 200);
  EXPECT_EQ(spec.depth_m, 60);
  EXPECT_EQ(to_line(spec), "kind=crater lon=1 lat=2 radius=200 depth=60");
  EXPECT_EQ(find_line_key("slope"), relief_keys().find("slope_deg"));
  EXPECT_EQ(find_line_key("name"), std::nullopt);
}

TEST(ReliefLine, MessagesSayWhatIsWrong) {
  EXPECT_EQ(error_of_line("lon=1 lat=2 radius=3"), "kind is missing");
  EXPECT_EQ(error_of_line("kind=crater lat=2 radius=3"), "lon is missing");
  EXPECT_EQ(error_of_line("kind=crater lon=1 lat=2"), "radius is missing");
  EXPECT_EQ(error_of_line("kind=crater lon=1 lat=2 radius"), "expected KEY=VALUE, found \"radius\"");
  EXPECT_EQ(error_of_line("kind=crater lon=1 lat=2 radius=3 radius_m=4"), "radius_m is there twice");
  EXPECT_EQ(error_of_line("kind=crater lon=1 lat=2 radius=nan"),
            "radius_m: expected a number from 0.01 to 10000000 m, or auto, found \"nan\"");
  EXPECT_EQ(error_of_line("kind=crater lon=1 lat=2 radius=3 deptj=4"),
            "unknown key \"deptj\"; did you mean depth?");
  EXPECT_NE(error_of_line("kind=crater lon=1 lat=2 radius=3 seed=4").find("seed: a crater has no such key"),
            std::string::npos);
}

TEST(ReliefLine, ChangesSingleKeys) {
  const ReliefSpec spec = changed_by_line(parse_relief_line("kind=crater lon=1 lat=2 radius=200 depth=60"),
                                          "depth=auto radius=100");
  EXPECT_EQ(to_line(spec), "kind=crater lon=1 lat=2 radius=100");
  EXPECT_THROW(changed_by_line(spec, "radius=auto"), std::invalid_argument);
}

TEST(ReliefSpecs, ValuesOutOfRangeAreProblems) {
  ReliefSpec spec = parse_relief_line("kind=noise lon=1 lat=2 radius=200 amplitude=3 wavelength=40");
  EXPECT_EQ(problem_of(spec), "");
  spec.strength = 2;
  EXPECT_EQ(problem_of(spec), "strength: expected a number from 0 to 1, found \"2\"");
  spec.strength = 1;
  spec.kind = static_cast<ReliefKind>(99);
  EXPECT_NE(problem_of(spec), "");
  spec.kind = ReliefKind::kNoise;
  spec.mode = static_cast<Mode>(9);
  EXPECT_NE(problem_of(spec), "");
}

TEST(ReliefSpecs, KeysBelongToTheirKinds) {
  const std::size_t seed = *relief_keys().find("seed");
  EXPECT_TRUE(has_key(ReliefKind::kNoise, seed));
  EXPECT_FALSE(has_key(ReliefKind::kPad, seed));
  EXPECT_FALSE(needs_key(ReliefKind::kNoise, seed));
  EXPECT_TRUE(needs_key(ReliefKind::kDune, *relief_keys().find("height_m")));
  EXPECT_NE(keys_of(ReliefKind::kDune).find("horn_m"), std::string::npos);
  EXPECT_EQ(usual_mode(ReliefKind::kDam), Mode::kMax);
  EXPECT_EQ(usual_mode(ReliefKind::kRamp), Mode::kReplace);
  EXPECT_EQ(usual_mode(ReliefKind::kDune), Mode::kAdd);
  EXPECT_EQ(kind_word(ReliefKind::kTrench), "trench");
  ReliefSpec spec;
  EXPECT_EQ(set_key(spec, seed, "7"), "");
  EXPECT_EQ(spec.seed, 7);
  EXPECT_NE(set_key(spec, seed, "-7"), "");
  EXPECT_EQ(spec.seed, 7);
}

TEST(ReliefSpecs, TheGuideHasEveryKeyAndAnExampleThatCanBeRead) {
  const std::vector<std::uint8_t> bytes =
      vpe::base::read_file(std::filesystem::path(VPE_SOURCE_DIR) / "docs/guide/relief.md", 1 << 20);
  const std::string guide(bytes.begin(), bytes.end());
  for (const vpe::core::KeyInfo& key : relief_keys().infos())
    EXPECT_NE(guide.find("`" + std::string(key.name) + "`"), std::string::npos) << key.name;
  const std::size_t begin = guide.find("```toml\n") + 8;
  const std::vector<ReliefSpec> example =
      parse_relief_toml(guide.substr(begin, guide.find("```", begin) - begin), "relief.md");
  EXPECT_EQ(example.size(), 5U);
  EXPECT_NO_THROW(place(example, mars::kMarsRadius_m, [](const glm::dvec3&) { return -4500.0; }));
}

TEST(ReliefSpecs, PolygonsAreTexts) {
  std::string problem;
  const auto corners = parse_polygon("1,2;3,-4.5;5,6", problem);
  EXPECT_EQ(problem, "");
  EXPECT_EQ(format_polygon(corners), "1,2;3,-4.5;5,6");
  for (const char* text :
       {"1,2", "1,2;3,4;5", "1,2;3,4;5,6;", ";1,2;3,4;5,6", "1,2;3,4;5,91", "1,2;3,4;nan,1"}) {
    EXPECT_TRUE(parse_polygon(text, problem).empty()) << text;
    EXPECT_NE(problem, "") << text;
  }
}

}  // namespace
}  // namespace relief
