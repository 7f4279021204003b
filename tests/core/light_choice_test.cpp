// The choice whether the sun lights ground: its setting, and what auto becomes.
#include "vpe/core/appearance/light_choice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "vpe/core/appearance/settings.h"

namespace vpe::core {
namespace {

constexpr Mode kModes[] = {Mode::kWireframe, Mode::kMarkers,  Mode::kUnlit,
                           Mode::kLit,       Mode::kColoured, Mode::kTextured};
constexpr Colour kColours[] = {Colour::kNone,   Colour::kElevation, Colour::kSlope,
                               Colour::kAspect, Colour::kImage,     Colour::kDifference};

TEST(LightChoice, AutoIsOffWhereImageryWithItsOwnLightIsShown) {
  for (const Mode mode : kModes) {
    for (const Colour colour : kColours) {
      for (const bool has_own_light : {false, true}) {
        Appearance appearance;
        appearance.mode = mode;
        appearance.colour = colour;
        ASSERT_EQ(appearance.light, Light::kAuto);
        EXPECT_TRUE(is_lit_by_sun(appearance));
        Appearance wanted = appearance;
        const bool is_imagery =
            mode == Mode::kTextured || (mode == Mode::kColoured && colour == Colour::kImage);
        wanted.light = has_own_light && is_imagery ? Light::kOff : Light::kOn;
        resolve_light(appearance, has_own_light);
        EXPECT_EQ(appearance, wanted) << static_cast<int>(mode) << " " << static_cast<int>(colour);
        EXPECT_EQ(is_lit_by_sun(appearance), wanted.light == Light::kOn);
        // A second call changes nothing, whatever the imagery.
        resolve_light(appearance, !has_own_light);
        EXPECT_EQ(appearance, wanted);
      }
    }
  }
}

TEST(LightChoice, WhatIsAskedForStays) {
  for (const Light light : {Light::kOn, Light::kOff}) {
    for (const bool has_own_light : {false, true}) {
      Appearance appearance;
      appearance.light = light;
      resolve_light(appearance, has_own_light);
      EXPECT_EQ(appearance.light, light);
      EXPECT_EQ(is_lit_by_sun(appearance), light == Light::kOn);
    }
  }
}

TEST(LightChoice, TheSettingHasThreeWords) {
  const auto listed = Settings::list();
  const auto info = std::ranges::find(listed, std::string_view("light"), &SettingInfo::key);
  ASSERT_NE(info, listed.end());
  EXPECT_EQ(info->default_text, "auto");
  EXPECT_EQ(info->choices, (std::vector<std::string_view>{"auto", "on", "off"}));
  Settings settings;
  EXPECT_EQ(settings.values().light, Light::kAuto);
  const std::pair<const char*, Light> words[] = {
      {"on", Light::kOn}, {"off", Light::kOff}, {"auto", Light::kAuto}};
  for (const auto& [word, light] : words) {
    EXPECT_EQ(settings.assign(std::string("light=") + word), "");
    EXPECT_EQ(settings.values().light, light);
    EXPECT_EQ(settings.get("light"), word);
  }
  EXPECT_NE(settings.assign("light=yes").find("auto, on, off"), std::string::npos);
  EXPECT_EQ(settings.values().light, Light::kAuto);
}

}  // namespace
}  // namespace vpe::core
