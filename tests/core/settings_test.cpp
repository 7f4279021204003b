#include "vpe/core/appearance/settings.h"

#include <clocale>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <locale>
#include <set>
#include <utility>

#include "tests/support/support.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/core/registry/former_names.h"

namespace vpe::core {
namespace {

using test_support::Random;

// Returns a value other than the default for a key of type kText.
std::string other_text(std::string_view key) {
  if (key == "palette") return "viridis";
  if (key == "overlay.names" || key == "overlay.layers") return "/dev/null";  // any file that can be read
  return key == "sun" ? "2026-11-20T12:00Z" : "Other";
}

bool holds(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(Settings, EveryKeyIsListedOnceWithADefaultThatIsAllowed) {
  std::set<std::string_view> names;
  for (const SettingInfo& info : Settings::list()) {
    EXPECT_TRUE(names.insert(info.key).second) << info.key;
    EXPECT_FALSE(info.meaning.empty()) << info.key;
    Settings settings;
    EXPECT_EQ(settings.get(info.key), info.default_text);
    EXPECT_EQ(settings.set(info.key, info.default_text), "");
    EXPECT_EQ(settings, Settings());
  }
  for (const char* key : {"mode", "colour", "exaggeration", "sun.azimuth", "sun.elevation"}) {
    EXPECT_TRUE(names.contains(key)) << key;
  }
}

TEST(Settings, EveryKeyIsInTheGuide) {
  std::ifstream file(VPE_SOURCE_DIR "/docs/guide/settings.md");
  const std::string guide{std::istreambuf_iterator<char>(file), {}};
  for (const SettingInfo& info : Settings::list())
    EXPECT_TRUE(holds(guide, "`" + std::string(info.key) + "`")) << info.key;
}

TEST(Settings, EachKeyChangesItsOwnValueAlone) {
  if (!overlays_refused().empty()) GTEST_SKIP() << overlays_refused();
  for (const SettingInfo& info : Settings::list()) {
    std::string other;
    if (info.type == SettingType::kChoice) {
      for (const std::string_view choice : info.choices) {
        if (choice != info.default_text) other = choice;
      }
    } else if (info.type == SettingType::kTable) {
      other = "0:12,1000:4.5";
    } else if (info.type == SettingType::kText) {
      other = other_text(info.key);
    } else {
      other = base::format_number(info.default_text == base::format_number(info.max) ? info.min : info.max);
    }
    Settings settings;
    ASSERT_EQ(settings.set(info.key, other), "") << info.key;
    EXPECT_NE(settings, Settings()) << info.key;
    for (const SettingInfo& each : Settings::list()) {
      EXPECT_EQ(settings.get(each.key), each.key == info.key ? other : each.default_text) << info.key;
    }
  }
}

TEST(Settings, MapsKeysToTheirMembers) {
  if (!overlays_refused().empty()) GTEST_SKIP() << overlays_refused();
  Settings settings;
  EXPECT_EQ(settings.assign("mode=wireframe"), "");
  EXPECT_EQ(settings.assign("colour=none"), "");
  EXPECT_EQ(settings.assign("exaggeration=2.5"), "");
  EXPECT_EQ(settings.assign("sun.azimuth=90"), "");
  EXPECT_EQ(settings.assign("sun.elevation=10"), "");
  EXPECT_EQ(settings.assign("sun.ambient=0.5"), "");
  EXPECT_EQ(settings.assign("lod.tolerance=0"), "");
  EXPECT_EQ(settings.assign("lod.triangles=100000"), "");
  EXPECT_EQ(settings.assign("lod.metric=distance"), "");
  EXPECT_EQ(settings.assign("lod.distance.scale=5e5"), "");
  EXPECT_EQ(settings.assign("lod.distance.offset=2"), "");
  EXPECT_EQ(settings.assign("lod.distance.weight=0.5"), "");
  EXPECT_EQ(settings.assign("lod.distance.table=0:12,1e5:8"), "");
  EXPECT_EQ(settings.assign("lod.centre.scale=0.5"), "");
  EXPECT_EQ(settings.assign("lod.centre.offset=-2"), "");
  EXPECT_EQ(settings.assign("lod.centre.weight=1"), "");
  EXPECT_EQ(settings.assign("lod.centre.table=0:2,0.5:0,1:-1"), "");
  EXPECT_EQ(settings.assign("lod.interest.weight=2"), "");
  EXPECT_EQ(settings.assign("lod.frame_ms=33"), "");
  EXPECT_EQ(settings.assign("samples=2"), "");
  EXPECT_EQ(settings.assign("background=black"), "");
  EXPECT_EQ(settings.assign("shading=flat"), "");
  EXPECT_EQ(settings.assign("palette=viridis"), "");
  EXPECT_EQ(settings.assign("palette.low=-100"), "");
  EXPECT_EQ(settings.assign("palette.high=100"), "");
  EXPECT_EQ(settings.assign("ramp.low.hue=10"), "");
  EXPECT_EQ(settings.assign("ramp.low.saturation=0.1"), "");
  EXPECT_EQ(settings.assign("ramp.low.value=0.2"), "");
  EXPECT_EQ(settings.assign("ramp.high.hue=20"), "");
  EXPECT_EQ(settings.assign("ramp.high.saturation=0.3"), "");
  EXPECT_EQ(settings.assign("ramp.high.value=0.4"), "");
  EXPECT_EQ(settings.assign("colourise=on"), "");
  EXPECT_EQ(settings.assign("sun=Ls90,15:00"), "");
  EXPECT_EQ(settings.assign("sun.diffuse=2"), "");
  EXPECT_EQ(settings.assign("light=off"), "");
  EXPECT_EQ(settings.assign("image.low=20"), "");
  EXPECT_EQ(settings.assign("image.high=200"), "");
  EXPECT_EQ(settings.assign("image.gamma=1.5"), "");
  EXPECT_EQ(settings.assign("shadows=on"), "");
  EXPECT_EQ(settings.assign("gamma=2.2"), "");
  EXPECT_EQ(settings.assign("haze.visibility=50000"), "");
  EXPECT_EQ(settings.assign("markers.size=5"), "");
  EXPECT_EQ(settings.assign("overlay.legend=on"), "");
  EXPECT_EQ(settings.assign("overlay.graticule=on"), "");
  EXPECT_EQ(settings.assign("overlay.graticule.step=10"), "");
  EXPECT_EQ(settings.assign("overlay.contours=on"), "");
  EXPECT_EQ(settings.assign("overlay.contours.step=500"), "");
  EXPECT_EQ(settings.assign("overlay.scale=on"), "");
  EXPECT_EQ(settings.assign("overlay.north=on"), "");
  EXPECT_EQ(settings.assign("overlay.time=on"), "");
  EXPECT_EQ(settings.assign("overlay.title=Olympus Mons"), "");
  EXPECT_EQ(settings.assign("overlay.names=/dev/null"), "");
  EXPECT_EQ(settings.assign("cull.occlusion=off"), "");
  EXPECT_EQ(settings.assign("edges=hard"), "");
  EXPECT_EQ(settings.assign("inspect=levels"), "");
  SettingsValues wanted;
  wanted.mode = Mode::kWireframe;
  wanted.colour = Colour::kNone;
  wanted.exaggeration = 2.5;
  wanted.sun_azimuth_deg = 90;
  wanted.sun_elevation_deg = 10;
  wanted.sun_ambient = 0.5;
  wanted.lod_tolerance_px = 0;
  wanted.lod_triangles = 100000;
  wanted.lod_metric = LodMetric::kDistance;
  wanted.lod_distance_scale_m = 5e5;
  wanted.lod_distance_offset = 2;
  wanted.lod_distance_weight = 0.5;
  wanted.lod_distance_table = {{0, 12}, {1e5, 8}};
  wanted.lod_centre_scale = 0.5;
  wanted.lod_centre_offset = -2;
  wanted.lod_centre_weight = 1;
  wanted.lod_centre_table = {{0, 2}, {0.5, 0}, {1, -1}};
  wanted.lod_interest_weight = 2;
  wanted.lod_frame_ms = 33;
  wanted.samples = 2;
  wanted.background = Background::kBlack;
  wanted.shading = Shading::kFlat;
  wanted.palette = "viridis";
  wanted.palette_low = -100;
  wanted.palette_high = 100;
  wanted.low_hue_deg = 10;
  wanted.low_saturation = 0.1;
  wanted.low_value = 0.2;
  wanted.high_hue_deg = 20;
  wanted.high_saturation = 0.3;
  wanted.high_value = 0.4;
  wanted.colourise = true;
  wanted.sun = "Ls90,15:00";
  wanted.sun_diffuse = 2;
  wanted.light = Light::kOff;
  wanted.image_low = 20;
  wanted.image_high = 200;
  wanted.image_gamma = 1.5;
  wanted.shadows = true;
  wanted.gamma = 2.2;
  wanted.haze_visibility_m = 50000;
  wanted.marker_px = 5;
  wanted.legend = true;
  wanted.graticule = true;
  wanted.graticule_deg = 10;
  wanted.contours = true;
  wanted.contour_m = 500;
  wanted.scale_bar = true;
  wanted.north_arrow = true;
  wanted.time_code = vpe::core::TimeCode::kFlight;
  wanted.title = "Olympus Mons";
  wanted.names = "/dev/null";
  wanted.occlusion = Occlusion::kOff;
  wanted.smooth_edges = false;
  wanted.inspect = Inspect::kLevels;
  EXPECT_EQ(settings.values(), wanted);
}

TEST(Settings, RangesIncludeTheirEndsAndNothingBeyond) {
  for (const SettingInfo& info : Settings::list()) {
    if (info.type != SettingType::kNumber && info.type != SettingType::kInteger) continue;
    Settings settings;
    EXPECT_EQ(settings.set(info.key, base::format_number(info.min)), "");
    EXPECT_EQ(settings.set(info.key, base::format_number(info.max)), "");
    const Settings before = settings;
    const bool whole = info.type == SettingType::kInteger;
    const double below = whole ? info.min - 1 : std::nextafter(info.min, -1e300);
    const double above = whole ? info.max + 1 : std::nextafter(info.max, 1e300);
    for (const std::string& text : {base::format_number(below), base::format_number(above), std::string("nan"),
                                    std::string(""), std::string("1x"), std::string("inf")}) {
      const std::string problem = settings.set(info.key, text);
      EXPECT_TRUE(holds(problem, info.key)) << problem;
      EXPECT_TRUE(holds(problem, base::format_number(info.max))) << problem;
    }
    EXPECT_EQ(settings, before) << info.key;
  }
  Settings settings;
  EXPECT_TRUE(holds(settings.set("lod.triangles", "1.5"), "whole number"));
}

TEST(Settings, EndsOfThePaletteAreNumbersOrAuto) {
  Settings settings;
  EXPECT_EQ(settings.values().palette_low, 0.0);
  for (const char* key : {"palette.low", "palette.high"}) {
    EXPECT_EQ(settings.set(key, "auto"), "");
    EXPECT_EQ(settings.get(key), "auto");
    for (const char* text : {"Auto", "view", "auto ", "none"}) {
      const std::string problem = settings.set(key, text);
      EXPECT_TRUE(holds(problem, "a number from -1000000 to 1000000, or auto")) << problem;
      EXPECT_EQ(settings.get(key), "auto");
    }
  }
  EXPECT_TRUE(has_auto_ends(settings.values()));
  EXPECT_FALSE(settings.values().palette_low || settings.values().palette_high);
  EXPECT_THROW(ColourScale{settings.values()}, std::invalid_argument);
  EXPECT_EQ(settings.set("palette.high", "1200.5"), "");
  EXPECT_EQ(ends_of(settings.values(), {-300, 900}), (PaletteEnds{-300, 1200.5}));
  EXPECT_EQ(settings.set("palette.low", "1"), "");
  EXPECT_FALSE(has_auto_ends(settings.values()));
  EXPECT_EQ(ends_of(settings.values(), {-300, 900}), (PaletteEnds{1, 1200.5}));
}

TEST(Settings, WrongWordsNameTheRightOnes) {
  Settings settings;
  const std::string problem = settings.set("mode", "shiny");
  EXPECT_TRUE(holds(problem, "mode=shiny")) << problem;
  EXPECT_TRUE(holds(problem, "wireframe, markers, unlit, lit, coloured, textured")) << problem;
  EXPECT_TRUE(holds(settings.set("samples", "3"), "1, 2, 4"));
  EXPECT_TRUE(holds(settings.set("mode", "Lit"), "not allowed"));
}

TEST(Settings, ARejectedTextSaysWhyAndWhatIsAllowed) {
  Settings settings;
  const std::string problem = settings.set("palette", "viridish");
  EXPECT_TRUE(holds(problem, "palette=viridish is not allowed: no palette and no file has this name"))
      << problem;
  EXPECT_TRUE(holds(problem, "expected auto, hsv, relief, mola, viridis")) << problem;
  EXPECT_EQ(settings, Settings());
}

TEST(Settings, WithoutCairoOverlaysAreRefusedWithTheReason) {
  if (overlays_refused().empty()) GTEST_SKIP() << "this build has Cairo";
  Settings settings;
  for (const SettingInfo& info : Settings::list()) {
    if (!info.key.starts_with("overlay.")) continue;
    const std::string problem = settings.set(info.key, info.type == SettingType::kNumber ? "1" : "on");
    EXPECT_TRUE(holds(problem, info.key) && holds(problem, "libcairo2-dev")) << problem;
    EXPECT_EQ(settings.set(info.key, info.default_text), "");
  }
  EXPECT_EQ(settings, Settings());
}

TEST(Settings, TextHasNoControlCharacters) {
  if (!overlays_refused().empty()) GTEST_SKIP() << overlays_refused();
  Settings settings;
  EXPECT_EQ(settings.set("overlay.title", "Olympus Mons, s\u00fcdlich"), "");
  for (const char* text : {"a\nb", "a\tb", "\x1b[2J", "a\x7f"}) {
    EXPECT_TRUE(holds(settings.set("overlay.title", text), "control characters")) << text;
  }
  EXPECT_EQ(settings.get("overlay.title"), "Olympus Mons, s\u00fcdlich");
}

TEST(Settings, AGazetteerThatIsNotThereIsRefused) {
  if (!overlays_refused().empty()) GTEST_SKIP() << overlays_refused();
  Settings settings;
  const std::string problem = settings.set("overlay.names", "/nowhere/names.csv");
  EXPECT_TRUE(
      holds(problem, "overlay.names=/nowhere/names.csv is not allowed: it cannot be read: No such file"))
      << problem;
  EXPECT_TRUE(holds(problem, "name, lon, lat")) << problem;
  EXPECT_EQ(settings, Settings());
}

TEST(Settings, TablesAreReadWholeOrNotAtAll) {
  Settings settings;
  ASSERT_EQ(settings.set("lod.distance.table", "0:12,1e5:8.5,1e6:-3"), "");
  EXPECT_EQ(settings.get("lod.distance.table"), "0:12,100000:8.5,1000000:-3");
  std::string full;
  for (int n = 0; n < 64; ++n) full += (n == 0 ? "" : ",") + std::to_string(n) + ":1";
  const Settings before = settings;
  for (const std::string& text :
       {std::string(), std::string("1"), std::string("0:"), std::string(":1"), std::string("0:1,"),
        std::string(",0:1"), std::string("0:1;5:2"), std::string("5:1,5:2"), std::string("5:1,4:2"),
        std::string("-1:2"), std::string("0:31"), std::string("0:-30.5"), std::string("0:nan"),
        std::string("inf:1"), std::string("0:1:2"), std::string("0: 1"), std::string("None"), full + ",64:1"}) {
    const std::string problem = settings.set("lod.distance.table", text);
    EXPECT_TRUE(holds(problem, "lod.distance.table")) << text;
    EXPECT_TRUE(holds(problem, "X:LEVELS")) << problem;
  }
  EXPECT_EQ(settings, before);
  EXPECT_EQ(settings.set("lod.distance.table", full), "");
  EXPECT_EQ(settings.get("lod.distance.table"), full);
  EXPECT_EQ(settings.set("lod.distance.table", "none"), "");
  EXPECT_EQ(settings, Settings());
}

TEST(LevelTable, ComesBackToTheBit) {
  Random random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    LevelTable table;
    double x = random.integer(0, 1) == 0 ? 0 : random.log_uniform(1e-9, 1);
    for (int n = random.integer(0, 8); n > 0; --n) {
      table.push_back({x, random.uniform(-30, 30)});
      x += random.log_uniform(1e-3, 1e6);
    }
    const std::optional<LevelTable> read = parse_level_table(format_level_table(table));
    ASSERT_TRUE(read.has_value()) << format_level_table(table);
    ASSERT_EQ(*read, table);
  }
}

TEST(Settings, UnknownKeysNameNearOnes) {
  Settings settings;
  EXPECT_TRUE(holds(settings.set("sun.azimut", "1"), "did you mean sun.azimuth?"));
  EXPECT_TRUE(holds(settings.set("color", "none"), "did you mean colour?"));
  EXPECT_TRUE(holds(settings.set("exageration", "1"), "did you mean exaggeration?"));
  EXPECT_TRUE(holds(settings.set("azimuth", "1"), "did you mean sun.azimuth?"));
  EXPECT_TRUE(holds(settings.set("sun.", "1"), "sun.azimuth, sun.elevation, sun.ambient"));
  const std::string far = settings.set("flux-capacitor", "1");
  EXPECT_TRUE(holds(far, "the settings are mode, shading, colour, palette")) << far;
  EXPECT_FALSE(settings.set("", "").empty());
  // The names of all keys, which the layers' keys have made longer, and a little of the text.
  EXPECT_LT(settings.set(std::string(1000000, 'x'), "1").size(), 1300u);
  EXPECT_EQ(settings, Settings());
  EXPECT_FALSE(settings.get("su").has_value());
}

// Splits "KEY=VALUE".
std::pair<std::string, std::string> key_and_value(std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  return {std::string(assignment.substr(0, equals)), std::string(assignment.substr(equals + 1))};
}

TEST(Settings, FormerKeysMeanTheCurrentOnes) {
  int rows = 0;
  for (const FormerName& row : former_names()) {
    if (row.kind != NameKind::kSetting) continue;
    ++rows;
    const Settings defaults;
    EXPECT_TRUE(defaults.get(row.current).has_value()) << row.current;
    EXPECT_EQ(defaults.get(row.former), defaults.get(row.current)) << row.former;
    for (const SettingInfo& info : Settings::list()) {
      EXPECT_NE(info.key, row.former);
      if (info.key != row.current) continue;
      for (const std::string_view choice : info.choices) {
        Settings by_former;
        Settings by_current;
        EXPECT_EQ(by_former.set(row.former, choice), "");
        EXPECT_EQ(by_current.set(row.current, choice), "");
        EXPECT_EQ(by_former, by_current) << row.former << "=" << choice;
      }
    }
    Settings settings;
    EXPECT_TRUE(holds(settings.set(row.former, "\x01"), std::string(row.current) + "=")) << row.former;
  }
  EXPECT_GE(rows, 1);
}

TEST(Settings, FormerValuesMeanTheCurrentOnes) {
  int rows = 0;
  for (const FormerName& row : former_names()) {
    if (row.kind != NameKind::kSettingValue) continue;
    ++rows;
    const auto [key, value] = key_and_value(row.current);
    Settings by_former;
    Settings by_current;
    ASSERT_EQ(by_former.assign(row.former), "") << row.former;
    ASSERT_EQ(by_current.assign(row.current), "") << row.current;
    EXPECT_EQ(by_former, by_current) << row.former;
    EXPECT_EQ(by_former.get(key), value);
    EXPECT_NE(by_former, Settings()) << row.former << ": the test sees nothing in a default";
    // A former key and a former value go together, as in scripts of earlier versions.
    for (const FormerName& other : former_names()) {
      if (other.kind != NameKind::kSetting || other.current != key) continue;
      Settings both;
      EXPECT_EQ(both.set(other.former, key_and_value(row.former).second), "");
      EXPECT_EQ(both, by_current) << other.former;
    }
    const std::string message = by_former.set(key, "no-such-value");
    EXPECT_FALSE(holds(message, key_and_value(row.former).second)) << message;
    EXPECT_TRUE(holds(message, value)) << message;
  }
  EXPECT_GE(rows, 2);
}

TEST(FormerNames, LeaveOtherNamesAlone) {
  EXPECT_EQ(current_name(NameKind::kSetting, "mode"), "mode");
  EXPECT_EQ(current_name(NameKind::kSetting, "voxel"), "voxel");
  EXPECT_EQ(current_value(NameKind::kSettingValue, "mode", "plain"), "plain");
  EXPECT_EQ(current_value(NameKind::kSettingValue, "rays.mode", "plain"), "reference");
  EXPECT_EQ(current_value(NameKind::kSettingValue, "rays.mode", "plai"), "plai");
  EXPECT_EQ(current_value(NameKind::kSettingValue, "rays", "mode=plain"), "mode=plain");
  EXPECT_EQ(current_value(NameKind::kOptionValue, "--backend", "voxel"), "ray");
}

TEST(Settings, AssignNeedsAnEqualsSign) {
  Settings settings;
  EXPECT_TRUE(holds(settings.assign("mode"), "KEY=VALUE"));
  EXPECT_FALSE(settings.assign("=1").empty());
  EXPECT_FALSE(settings.assign("exaggeration=").empty());
  EXPECT_FALSE(settings.assign("exaggeration=1=2").empty());
  EXPECT_EQ(settings, Settings());
}

class CommaPoint : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Settings, NumbersDoNotDependOnTheLocale) {
  // Streams follow the C++ locale, the C library its own, where a German one is installed.
  const std::locale old = std::locale::global(std::locale(std::locale::classic(), new CommaPoint));
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  Settings settings;
  const std::string problem = settings.set("exaggeration", "2.5");
  const std::string cap_problem = settings.set("lod.triangles", "1234567");
  const std::optional<std::string> text = settings.get("exaggeration");
  const std::optional<std::string> cap_text = settings.get("lod.triangles");
  std::locale::global(old);
  std::setlocale(LC_ALL, "C");
  EXPECT_EQ(problem, "");
  EXPECT_EQ(cap_problem, "");
  EXPECT_EQ(text, "2.5");
  EXPECT_EQ(cap_text, "1234567");
}

}  // namespace
}  // namespace vpe::core
