// Palettes, the scale from values to colours, HSV.
#include "vpe/core/appearance/palette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "tests/support/support.h"

// After GoogleTest, which it does not include.
#include <rapidcheck/gtest.h>

namespace vpe::core {
namespace {

using Scale = Palette::Scale;
using test_support::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool holds(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

double furthest(const glm::dvec3& a, const glm::dvec3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

ColourScale scale_of(const std::string& palette, Colour colour = Colour::kElevation, double low = 0,
                     double high = 0) {
  Appearance a;
  a.palette = palette;
  a.colour = colour;
  a.palette_low = low;
  a.palette_high = high;
  return ColourScale(a);
}

// Returns lightness, a and b of OKLab (B. Ottosson) of colours 0 to 255.
glm::dvec3 oklab(const glm::dvec3& rgb) {
  const auto linear = [](double x) {
    x /= 255;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  };
  const double r = linear(rgb.x);
  const double g = linear(rgb.y);
  const double b = linear(rgb.z);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

TEST(Palette, IsStraightBetweenStopsAndConstantBeyond) {
  const Palette p(Scale::kValue, {{-10, {0, 10, 255}}, {10, {100, 30, 55}}, {10, {1, 2, 3}}, {20, {11, 2, 3}}});
  EXPECT_EQ(p.colour(-10), glm::dvec3(0, 10, 255));
  EXPECT_EQ(p.colour(-1e9), glm::dvec3(0, 10, 255));
  EXPECT_EQ(p.colour(-kInfinity), glm::dvec3(0, 10, 255));
  EXPECT_EQ(p.colour(kNan), glm::dvec3(0, 10, 255));
  EXPECT_LT(furthest(p.colour(0), glm::dvec3(50, 20, 155)), 1e-12);
  EXPECT_LT(furthest(p.colour(std::nextafter(10, 0)), glm::dvec3(100, 30, 55)), 1e-9);
  EXPECT_EQ(p.colour(10), glm::dvec3(1, 2, 3));
  EXPECT_LT(furthest(p.colour(12.5), glm::dvec3(3.5, 2, 3)), 1e-12);
  EXPECT_EQ(p.colour(20), glm::dvec3(11, 2, 3));
  EXPECT_EQ(p.colour(kInfinity), glm::dvec3(11, 2, 3));
  const Palette one(Scale::kValue, {{5, {1, 2, 3}}});
  for (const double at : {-1.0, 5.0, 6.0}) EXPECT_EQ(one.colour(at), glm::dvec3(1, 2, 3));
  const Palette step(Scale::kValue, {{5, {1, 2, 3}}, {5, {4, 5, 6}}});
  EXPECT_EQ(step.colour(std::nextafter(5, 0)), glm::dvec3(1, 2, 3));
  EXPECT_EQ(step.colour(5), glm::dvec3(4, 5, 6));
}

TEST(Palette, RefusesStopsThatMakeNone) {
  const auto bad = [](Scale scale, std::vector<PaletteStop> stops) {
    EXPECT_THROW(Palette(scale, std::move(stops)), std::invalid_argument);
  };
  bad(Scale::kValue, {});
  bad(Scale::kValue, {{1, {0, 0, 0}}, {0, {0, 0, 0}}});
  bad(Scale::kValue, {{1, {0, 0, 0}}, {1, {0, 0, 0}}, {1, {0, 0, 0}}});
  bad(Scale::kValue, {{kNan, {0, 0, 0}}});
  bad(Scale::kValue, {{2e12, {0, 0, 0}}});
  bad(Scale::kFraction, {{-0.1, {0, 0, 0}}});
  bad(Scale::kFraction, {{1.1, {0, 0, 0}}});
  bad(Scale::kValue, {{0, {0, 256, 0}}});
  bad(Scale::kValue, {{0, {0, 0, -1}}});
  bad(Scale::kValue, {{0, {kNan, 0, 0}}});
}

// Compares with a search through all stops, also if they are close together.
TEST(Palette, FindsTheStopsOnBothSides) {
  rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint32_t>());
    const auto any = [&] {
      return glm::dvec3{random.uniform(0, 255), random.uniform(0, 255), random.uniform(0, 255)};
    };
    std::vector<PaletteStop> stops;
    double at = random.uniform(-1e4, 1e4);
    for (int n = random.integer(1, 300); n > 0; --n) {
      stops.push_back({at, any()});
      if (random.integer(0, 4) == 0) stops.push_back({at, any()});
      at += random.log_uniform(1e-9, 1e4);
    }
    const Palette p(Scale::kValue, stops);
    for (int trial = 0; trial < 50; ++trial) {
      const double near =
          stops[static_cast<std::size_t>(random.integer(0, static_cast<int>(stops.size()) - 1))].at;
      double x = random.uniform(stops.front().at - 1, stops.back().at + 1);
      if (trial % 3 == 0) x = near;
      if (trial % 3 == 1) x = std::nextafter(near, random.integer(0, 1) == 0 ? -1e300 : 1e300);
      glm::dvec3 wanted = stops.front().rgb;
      for (std::size_t n = 0; n < stops.size() && stops[n].at <= x; ++n) {
        wanted = stops[n].rgb;
        if (n + 1 == stops.size() || stops[n + 1].at <= x) continue;
        const double t = (x - stops[n].at) / (stops[n + 1].at - stops[n].at);
        wanted = stops[n].rgb * (1 - t) + stops[n + 1].rgb * t;
      }
      RC_ASSERT(furthest(p.colour(x), wanted) < 1e-9);
    }
  });
}

TEST(Palette, EveryNameIsAPaletteInEachColour) {
  EXPECT_GE(palette_names().size(), 10u);
  for (const std::string_view name : palette_names()) {
    EXPECT_EQ(palette_problem(std::string(name)), "");
    EXPECT_TRUE(holds(palette_grammar(), std::string(" ") + std::string(name) + ",")) << palette_grammar();
    for (const Colour colour : {Colour::kElevation, Colour::kSlope, Colour::kAspect}) {
      const ColourScale scale = scale_of(std::string(name), colour);
      EXPECT_LT(scale.low(), scale.high());
      double travelled = 0;
      glm::dvec3 before = scale(scale.low());
      for (int n = 1; n <= 100; ++n) {
        const glm::dvec3 at = scale(scale.low() + (scale.high() - scale.low()) * n / 100.0);
        travelled += furthest(at, before);
        before = at;
      }
      EXPECT_GT(travelled, 200) << name;  // it shows something of the whole range
    }
  }
}

// Entries of the published tables of 256 that are not stops here.
TEST(Palette, PublishedMapsAreMetWithinTwo) {
  struct Entry {
    int at;
    glm::dvec3 rgb;
  };
  const auto expect = [](const char* name, std::initializer_list<Entry> entries) {
    const ColourScale scale = scale_of(name, Colour::kElevation, 0, 255);
    for (const Entry& e : entries) EXPECT_LE(furthest(scale(e.at), e.rgb), 2) << name << " " << e.at;
  };
  expect("viridis", {{5, {70, 8, 92}},
                     {30, {71, 42, 122}},
                     {67, {57, 85, 140}},
                     {99, {43, 117, 142}},
                     {129, {32, 146, 140}},
                     {173, {58, 186, 118}},
                     {188, {86, 198, 103}},
                     {229, {186, 222, 40}},
                     {253, {248, 230, 33}}});
  expect("cividis", {{5, {0, 38, 86}},
                     {30, {22, 55, 112}},
                     {67, {70, 81, 108}},
                     {99, {100, 103, 112}},
                     {129, {126, 124, 120}},
                     {173, {168, 158, 115}},
                     {188, {184, 170, 110}},
                     {229, {228, 206, 83}},
                     {253, {254, 229, 53}}});
  expect("inferno", {{5, {2, 2, 12}},
                     {30, {30, 12, 69}},
                     {67, {92, 18, 110}},
                     {99, {143, 36, 105}},
                     {129, {189, 56, 83}},
                     {173, {239, 110, 33}},
                     {188, {248, 135, 14}},
                     {229, {246, 213, 67}},
                     {253, {249, 252, 157}}});
  expect("turbo", {{5, {54, 33, 95}},
                   {30, {70, 102, 221}},
                   {67, {35, 195, 228}},
                   {99, {60, 245, 142}},
                   {129, {167, 252, 58}},
                   {173, {252, 179, 54}},
                   {188, {253, 138, 38}},
                   {229, {197, 38, 3}},
                   {253, {129, 6, 2}}});
}

TEST(Palette, LightnessRisesAlongPerceptualOnes) {
  for (const char* name : {"viridis", "cividis", "inferno", "grey", "black-body"}) {
    const ColourScale scale = scale_of(name, Colour::kSlope, 0, 1);
    double before = -1;
    for (int n = 0; n <= 1000; ++n) {
      const double lightness = oklab(scale(n / 1000.0)).x;
      EXPECT_GT(lightness, before) << name << " " << n;
      before = lightness;
    }
  }
}

TEST(Palette, AspectGoesRoundInEvenSteps) {
  const ColourScale scale = scale_of("auto", Colour::kAspect);
  EXPECT_EQ(scale.low(), 0);
  EXPECT_EQ(scale.high(), 360);
  EXPECT_EQ(scale.unit(), "deg");
  EXPECT_EQ(scale(0), scale(360));
  std::vector<double> steps;
  for (int n = 0; n < 32; ++n) {
    const glm::dvec3 a = oklab(scale(11.25 * n));
    const glm::dvec3 b = oklab(scale(11.25 * (n + 1)));
    steps.push_back(std::sqrt(std::pow(a.x - b.x, 2) + std::pow(a.y - b.y, 2) + std::pow(a.z - b.z, 2)));
    const double angle_rad = 11.25 * n * std::numbers::pi / 180;
    EXPECT_NEAR(a.x, 0.68 + 0.135 * std::cos(angle_rad), 0.003);
    EXPECT_NEAR(std::hypot(a.y, a.z), 0.135 * std::abs(std::sin(angle_rad)), 0.003);
  }
  const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
  EXPECT_LT(*most / *least, 1.2);
}

// Simulates colour blindness by the matrices of Machado, Oliveira and Fernandes (2009), severity 1, on linear RGB.
constexpr std::array<std::array<double, 9>, 3> kColourBlindness{
    {{0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998},
     {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881},
     {1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900}}};

// Returns the CIE L*a*b* (D65) of a colour as such eyes see it.
glm::dvec3 seen_lab(const glm::dvec3& rgb, const std::array<double, 9>& eyes) {
  glm::dvec3 linear;
  for (int n = 0; n < 3; ++n) {
    const double c = rgb[n] / 255;
    linear[n] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  glm::dvec3 seen;
  for (int n = 0; n < 3; ++n) {
    const auto row = eyes.begin() + 3 * n;
    seen[n] = std::clamp(row[0] * linear.x + row[1] * linear.y + row[2] * linear.z, 0.0, 1.0);
  }
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const double x = f((0.4124564 * seen.x + 0.3575761 * seen.y + 0.1804375 * seen.z) / 0.95047);
  const double y = f(0.2126729 * seen.x + 0.7151522 * seen.y + 0.0721750 * seen.z);
  const double z = f((0.0193339 * seen.x + 0.1191920 * seen.y + 0.9503041 * seen.z) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

// A difference of 2.3 is just noticed.
TEST(Palette, TheUsualOnesTellATenthOfTheirRangeApartForColourBlindEyes) {
  constexpr int kSteps = 200;
  for (const Colour colour : {Colour::kElevation, Colour::kSlope, Colour::kAspect, Colour::kDifference}) {
    const ColourScale scale = scale_of("auto", colour, 0, 1);
    for (const auto& eyes : kColourBlindness) {
      std::vector<glm::dvec3> seen;
      for (int n = 0; n <= kSteps; ++n) seen.push_back(seen_lab(scale(n / double{kSteps}), eyes));
      for (int a = 0; a <= kSteps; ++a) {
        for (int b = a + kSteps / 10; b <= kSteps; ++b) {
          if (colour == Colour::kAspect && b - a > kSteps - kSteps / 10) continue;  // a circle
          EXPECT_GT(glm::length(seen[static_cast<std::size_t>(a)] - seen[static_cast<std::size_t>(b)]), 3.5)
              << static_cast<int>(colour) << " " << a << " " << b;
        }
      }
    }
  }
}

TEST(Palette, DivergingIsLightestAtTheDatumAndEvenAboutIt) {
  const ColourScale scale = scale_of("diverging");
  for (int z = 500; z <= 8000; z += 500) {
    const double above = oklab(scale(z)).x;
    EXPECT_NEAR(above, oklab(scale(-z)).x, 0.006);
    EXPECT_LT(above, oklab(scale(z - 500)).x);
    EXPECT_GT(scale(z).x, scale(z).z);
    EXPECT_LT(scale(-z).x, scale(-z).z);
  }
  EXPECT_EQ(scale(0), glm::dvec3(245));
}

TEST(ColourScale, RangesSuitWhatIsShown) {
  const auto expect = [](const ColourScale& s, double low, double high, std::string_view unit) {
    EXPECT_EQ(s.low(), low);
    EXPECT_EQ(s.high(), high);
    EXPECT_EQ(s.unit(), unit);
  };
  expect(scale_of("viridis"), -8200, 21300, "m");
  expect(scale_of("viridis", Colour::kSlope), 0, 45, "deg");
  expect(scale_of("hsv", Colour::kAspect), 0, 360, "deg");
  expect(scale_of("auto"), -8200, 21500, "m");
  expect(scale_of("mola", Colour::kSlope), 0, 45, "deg");
  expect(scale_of("viridis", Colour::kElevation, 5, 5), -8200, 21300, "m");
  expect(scale_of("viridis", Colour::kElevation, 1000, -1000), 1000, -1000, "m");
  EXPECT_EQ(scale_of("auto"), scale_of("relief"));
  EXPECT_EQ(scale_of("auto", Colour::kSlope), scale_of("viridis", Colour::kSlope));
  EXPECT_EQ(scale_of("auto", Colour::kAspect), scale_of("aspect", Colour::kAspect));
  EXPECT_NE(scale_of("auto"), scale_of("mola"));
  for (const Colour colour : {Colour::kNone, Colour::kImage}) {
    EXPECT_THROW(scale_of("auto", colour), std::invalid_argument);
  }
}

TEST(ColourScale, ValuesStayWhereTheyAreUntilARangeStretchesThem) {
  const ColourScale own = scale_of("relief");
  EXPECT_EQ(own(-8200), glm::dvec3(34, 17, 85));
  EXPECT_EQ(own(0), glm::dvec3(153, 153, 88));
  EXPECT_EQ(own(21500), glm::dvec3(252, 251, 249));
  EXPECT_LT(furthest(own(750), glm::dvec3(182, 157, 86.5)), 1e-9);
  const ColourScale wide = scale_of("relief", Colour::kElevation, 0, 29700);
  EXPECT_EQ(wide(0), glm::dvec3(34, 17, 85));
  EXPECT_LT(furthest(wide(8200), glm::dvec3(153, 153, 88)), 1e-9);
  EXPECT_EQ(wide(29700), glm::dvec3(252, 251, 249));
}

TEST(ColourScale, AReversedRangeTurnsThePaletteRound) {
  for (const std::string_view name : palette_names()) {
    const ColourScale up = scale_of(std::string(name), Colour::kElevation, -1000, 3000);
    const ColourScale down = scale_of(std::string(name), Colour::kElevation, 3000, -1000);
    for (int n = 0; n <= 200; ++n) {
      EXPECT_LT(furthest(up(-1000 + 20.0 * n), down(3000 - 20.0 * n)), 1e-9) << name;
    }
    EXPECT_EQ(up(kNan), up(-1000));
    EXPECT_EQ(down(kNan), down(3000));
    EXPECT_EQ(down(5000), up(-5000));
  }
}

TEST(ColourScale, NarrowRangesAreFine) {
  for (const double high : {std::nextafter(1000, 1001), 1000 + 1e-12, 1000 + 1e-9}) {
    for (const std::string_view name : palette_names()) {
      const ColourScale s = scale_of(std::string(name), Colour::kElevation, 1000, high);
      const ColourScale wide = scale_of(std::string(name), Colour::kElevation, 0, 1);
      EXPECT_EQ(s(999), wide(0)) << name;
      EXPECT_EQ(s(1001), wide(1)) << name;
    }
  }
}

TEST(Hsv, RoundTrip) {
  rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint32_t>());
    const Hsv hsv{random.uniform(0, 360), random.uniform(0.01, 1), random.uniform(0.01, 1)};
    const Hsv back = to_hsv(to_rgb(hsv));
    const double turn = std::abs(back.hue_deg - hsv.hue_deg);
    RC_ASSERT(std::min(turn, 360 - turn) < 1e-9);
    RC_ASSERT(back.hue_deg >= 0 && back.hue_deg < 360);
    RC_ASSERT(std::abs(back.saturation - hsv.saturation) < 1e-12);
    RC_ASSERT(std::abs(back.value - hsv.value) < 1e-12);
    const glm::dvec3 rgb{random.integer(0, 255), random.integer(0, 255), random.integer(0, 255)};
    RC_ASSERT(furthest(to_rgb(to_hsv(rgb)), rgb) < 1e-9);
    const double turns = 360.0 * random.integer(-3, 3);
    RC_ASSERT(furthest(to_rgb({hsv.hue_deg + turns, hsv.saturation, hsv.value}), to_rgb(hsv)) < 1e-9);
  });
  EXPECT_EQ(to_hsv({0, 0, 0}).saturation, 0);
  EXPECT_EQ(to_hsv({9, 9, 9}).hue_deg, 0);
  for (const auto& [hue, rgb] : std::initializer_list<std::pair<double, glm::dvec3>>{{0, {255, 0, 0}},
                                                                                     {60, {255, 255, 0}},
                                                                                     {120, {0, 255, 0}},
                                                                                     {240, {0, 0, 255}},
                                                                                     {300, {255, 0, 255}}}) {
    EXPECT_LT(furthest(to_rgb({hue, 1, 1}), rgb), 1e-9);
    EXPECT_NEAR(to_hsv(rgb).hue_deg, hue, 1e-9);
  }
}

TEST(Hsv, RampIsStraightInHueSaturationAndValue) {
  rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint32_t>());
    Appearance a;
    a.palette = "hsv";
    a.low_hue_deg = random.integer(0, 9) == 0 ? 60.0 * random.integer(-6, 12) : random.uniform(-360, 720);
    a.high_hue_deg = random.integer(0, 9) == 0 ? a.low_hue_deg : random.uniform(-360, 720);
    a.low_saturation = random.uniform(0, 1);
    a.high_saturation = random.uniform(0, 1);
    a.low_value = random.uniform(0, 1);
    a.high_value = random.uniform(0, 1);
    a.palette_low = -3;
    a.palette_high = 5;
    const ColourScale scale(a);
    for (int trial = 0; trial < 100; ++trial) {
      const double t = random.uniform(0, 1);
      const glm::dvec3 wanted = to_rgb({a.low_hue_deg + (a.high_hue_deg - a.low_hue_deg) * t,
                                        a.low_saturation + (a.high_saturation - a.low_saturation) * t,
                                        a.low_value + (a.high_value - a.low_value) * t});
      RC_ASSERT(furthest(scale(-3 + 8 * t), wanted) < 0.1);
    }
  });
}

TEST(ColourScale, OfDifferencesIsEvenAboutZero) {
  const ColourScale usual = scale_of("auto", Colour::kDifference);
  EXPECT_EQ(usual.low(), -10);
  EXPECT_EQ(usual.high(), 10);
  EXPECT_EQ(usual.unit(), "m");
  const ColourScale scale = scale_of("auto", Colour::kDifference, -3, 3);
  EXPECT_GT(oklab(scale(0)).x, oklab(scale(1)).x);
  for (const double value : {0.5, 1.0, 2.0, 3.0, 9.0}) {
    EXPECT_NEAR(oklab(scale(value)).x, oklab(scale(-value)).x, 0.02) << value;
    EXPECT_GT(scale(value).x, scale(value).z);    // red where it has risen
    EXPECT_GT(scale(-value).z, scale(-value).x);  // blue where it has sunk
  }
  EXPECT_EQ(scale(3), scale(9));
}

TEST(Colourised, TakesHueAndSaturationAndKeepsValue) {
  rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint32_t>());
    const auto any = [&] {
      return glm::dvec3{random.uniform(0, 255), random.uniform(0, 255), random.uniform(0, 255)};
    };
    const glm::dvec3 image = any();
    const glm::dvec3 colour = any();
    const Hsv got = to_hsv(colourised(image, colour));
    RC_ASSERT(std::abs(got.value - to_hsv(image).value) < 1e-12);
    RC_ASSERT(std::abs(got.saturation - to_hsv(colour).saturation) < 1e-9);
    RC_ASSERT(std::abs(got.hue_deg - to_hsv(colour).hue_deg) < 1e-6);
  });
  EXPECT_EQ(colourised({10, 200, 30}, {0, 0, 0}), glm::dvec3(200));
  EXPECT_EQ(colourised({0, 0, 0}, {9, 80, 7}), glm::dvec3(0));
}

}  // namespace
}  // namespace vpe::core
