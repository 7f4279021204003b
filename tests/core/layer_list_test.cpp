// The list of vector files of overlay.layers.
#include "vpe/core/appearance/layer_list.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "tests/support/support.h"

namespace {

using vpe::core::LayerFile;
using vpe::core::parse_layer_list;

TEST(LayerList, HasPathsAndOpacities) {
  EXPECT_TRUE(parse_layer_list("").empty());
  const std::vector<LayerFile> expected{{"a b.gpkg", 0.4}, {"c@home.json", 1}, {"d", 0}};
  EXPECT_EQ(parse_layer_list("a b.gpkg@0.4;c@home.json;d@0"), expected);
  EXPECT_EQ(parse_layer_list(vpe::core::layer_list_text(expected)), expected);
}

TEST(LayerList, WrongOnesAreRefused) {
  for (const char* text : {";", "a;", ";a", "a;;b", "@0.5", "a@2", "a@-1"})
    EXPECT_THROW(parse_layer_list(text), std::invalid_argument) << text;
}

TEST(LayerList, FilesMustBeReadable) {
  const test_support::TempDir dir;
  std::ofstream(dir / "a.json") << "{}";
  EXPECT_EQ(vpe::core::layers_problem(""), "");
  EXPECT_EQ(vpe::core::layers_problem((dir / "a.json").string() + "@0.5"), "");
  EXPECT_NE(vpe::core::layers_problem((dir / "a.json").string() + ";" + (dir / "b.json").string()), "");
  EXPECT_NE(vpe::core::layers_problem(dir.path().string()).find("folder"), std::string::npos);
}

}  // namespace
