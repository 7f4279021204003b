#include "vpe/core/appearance/settings.h"

#include <clocale>
#include <cmath>
#include <limits>
#include <locale>
#include <set>

#include "tests/support/support.h"
#include "vpe/base/number.h"

namespace vpe::core {
namespace {

using test_support::Random;

// Another value than the default of a key of type kText.
std::string other_text(std::string_view key) {
  if (key == "palette") return "viridis";
  if (key == "overlay.names") return "/dev/null";  // any file that can be read
  return key == "sun" ? "2026-11-20T12:00Z" : "Other";
}

bool holds(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(Number, ReadsWhatItWritesToTheBit) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double sign = random.integer(0, 1) == 0 ? -1.0 : 1.0;
    const double value = sign * random.log_uniform(1e-300, 1e300);
    const std::optional<double> read = base::parse_number(base::format_number(value));
    ASSERT_TRUE(read.has_value()) << base::format_number(value);
    ASSERT_EQ(*read, value);
  }
  for (const double value : {0.0, -0.0, 1e-6, 1e16, 123456789.0, std::numeric_limits<double>::denorm_min(),
                             std::numeric_limits<double>::max()}) {
    EXPECT_EQ(base::parse_number(base::format_number(value)), value);
  }
}

TEST(Number, IsPlainWherePeopleRead) {
  EXPECT_EQ(base::format_number(1000000), "1000000");
  EXPECT_EQ(base::format_number(-74.25), "-74.25");
  EXPECT_EQ(base::format_number(0.1), "0.1");
  EXPECT_EQ(base::format_number(0), "0");
  EXPECT_EQ(base::format_number(1e20), "1e+20");
}

TEST(Number, TakesOnlyWholeFiniteDecimals) {
  EXPECT_EQ(base::parse_number("+1.5"), 1.5);
  EXPECT_EQ(base::parse_number("-.5e1"), -5.0);
  for (const char* text : {"", "+", "-", "+-1", "-+1", "++1", "1 ", " 1", "1,5", "1.5m", "nan", "inf", "-inf",
                           "infinity", "0x10", "1e999", "1e", "--1", "1_000"}) {
    EXPECT_FALSE(base::parse_number(text).has_value()) << text;
  }
  EXPECT_EQ(base::parse_integer("+3"), 3);
  for (const char* text : {"", "3.0", "1e3", "99999999999999999999", "0x1"}) {
    EXPECT_FALSE(base::parse_integer(text).has_value()) << text;
  }
}

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
      other = base::format_number(info.max);
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
  EXPECT_EQ(settings.assign("lod.rule=hitchner"), "");
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
  wanted.time_code = true;
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

TEST(Settings, WrongWordsNameTheRightOnes) {
  Settings settings;
  const std::string problem = settings.set("mode", "shiny");
  EXPECT_TRUE(holds(problem, "mode=shiny")) << problem;
  EXPECT_TRUE(holds(problem, "wireframe, markers, unlit, lit, coloured, textured")) << problem;
  EXPECT_TRUE(holds(settings.set("samples", "3"), "1, 2, 4"));
  EXPECT_TRUE(holds(settings.set("mode", "Lit"), "not allowed"));
}

TEST(Settings, ARejectedTextTellsWhyAndWhatIsAllowed) {
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
    double x = random.integer(0, 1) * random.log_uniform(1e-9, 1);
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
  EXPECT_LT(settings.set(std::string(1000000, 'x'), "1").size(), 1000u);
  EXPECT_EQ(settings, Settings());
  EXPECT_FALSE(settings.get("su").has_value());
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
