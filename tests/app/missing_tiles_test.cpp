// The message about an image that lacks tiles.
#include <gtest/gtest.h>

#include <stdexcept>

#include "vpe/app/picture/image_options.h"

namespace vpe::app {
namespace {

std::string message(int late, int unreadable) {
  core::DrawResult result;
  for (int n = 0; n < late; ++n) result.missing.push_back({"1/2/" + std::to_string(n), "not loaded yet"});
  for (int n = 0; n < unreadable; ++n)
    result.missing.push_back({"3/4/" + std::to_string(n), "its mesh is damaged", true});
  try {
    require_complete({}, result);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return {};
}

TEST(MissingTiles, UnreadableOnesComeBeforeWhatTheyHoldUp) {
  EXPECT_EQ(message(0, 0), "");
  EXPECT_EQ(
      message(40, 5),
      "45 tiles are missing in the image:\n     3/4/0: its mesh is damaged\n     3/4/1: its mesh is "
      "damaged\n     3/4/2: its mesh is damaged\n     2 more tiles are unreadable\n     40 other tiles are "
      "not loaded yet\n     'vpe verify' names all damage of the planet file; --allow-incomplete draws "
      "coarser terrain there");
  EXPECT_EQ(
      message(1, 1),
      "2 tiles are missing in the image:\n     3/4/0: its mesh is damaged\n     1 other tile is not loaded "
      "yet\n     'vpe verify' names all damage of the planet file; --allow-incomplete draws coarser terrain "
      "there");
  const std::string late = message(5, 0);
  EXPECT_NE(late.find("5 tiles are missing in the image:\n     1/2/0: not loaded yet"), std::string::npos);
  EXPECT_NE(late.find("and 2 more\n     --wait SECONDS waits longer"), std::string::npos);
}

}  // namespace
}  // namespace vpe::app
