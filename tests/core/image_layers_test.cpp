#include "vpe/core/appearance/image_layers.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace vpe::core {
namespace {

TEST(ImageLayers, AreReadAndWritten) {
  const std::vector<ImageLayerLook> layers =
      parse_image_layers("viking;ctx mosaic@0.6 low=20 high=200 gamma=1.4;a@b high=9");
  const std::vector<ImageLayerLook> expected{
      {"viking", 1, 0, 255, 1}, {"ctx mosaic", 0.6, 20, 200, 1.4}, {"a@b", 1, 0, 9, 1}};
  EXPECT_EQ(layers, expected);
  EXPECT_EQ(parse_image_layers(image_layers_text(layers)), layers);
  EXPECT_TRUE(parse_image_layers("").empty());
  EXPECT_EQ(image_layers_text({}), "");
  EXPECT_EQ(image_layers_problem("viking;ctx@0"), "");
}

TEST(ImageLayers, WrongTextIsRefusedWithItsWord) {
  const auto refused = [](const char* text, const char* word) {
    EXPECT_NE(image_layers_problem(text).find(word), std::string::npos)
        << text << ": " << image_layers_problem(text);
    EXPECT_THROW(parse_image_layers(text), std::invalid_argument) << text;
  };
  refused(";", "empty");
  refused("a;", "';' at the end");
  refused("@0.5", "empty");
  refused("a@1.5", "1.5");
  refused("a@-0.1", "-0.1");
  refused("a low=-1", "low '-1'");
  refused("a high=256", "high '256'");
  refused("a gamma=0", "gamma '0'");
  refused("a gamma=x", "gamma 'x'");
  refused("a gamma=nan", "gamma 'nan'");
  refused("a;b;a@0.2", "twice");
}

RC_GTEST_PROP(ImageLayers, AnyListSurvivesItsText, ()) {
  const auto names = *rc::gen::unique<std::vector<std::string>>(
      rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::elementOf(std::string("abc-_.")))));
  std::vector<ImageLayerLook> layers;
  for (const std::string& name : names) {
    const auto share = [] { return *rc::gen::inRange(0, 1000) / 999.0; };
    layers.push_back({name, share(), 255 * share(), 255 * share(), 0.1 + 9.9 * share()});
  }
  for (ImageLayerLook& look : layers) look.gamma = std::min(look.gamma, 10.0);
  RC_ASSERT(parse_image_layers(image_layers_text(layers)) == layers);
}

}  // namespace
}  // namespace vpe::core
