// vpe render --screens: the image of a screen in a room.
#include <cmath>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

using vpe::core::read_image;
using vpe::core::RgbImage;

// A screen of 0.8 m by 0.45 m, 1 m before a head at rest: 2 atan(0.225) = 25.36 degrees high.
constexpr char kWall[] = R"(version = 1
scale = 1
head = [0, 0, 0]
eye_base = 0.06

[[screen]]
name = "wall"
monitor = 1
pixels = [320, 180]
upper_left = [-0.4, 0.225, -1]
upper_right = [0.4, 0.225, -1]
lower_left = [-0.4, -0.225, -1]
)";

constexpr char kTwo[] = R"(
[[screen]]
name = "glass"
eye = "left"
monitor = 2
pixels = [240, 270]
[screen.lens]
field = 90
distortion = [0.2, 0.1]
)";

class Screens : public AppTest {
 protected:
  void SetUp() override {
    write_text(dir_ / "wall.screens.toml", kWall);
    write_text(dir_ / "two.screens.toml", std::string(kWall) + kTwo);
  }

  Words words(const Words& more) const {
    Words all{"render", planet().string(), "-q", "--pose", "20,10,60000,30,-8,0", "--backend", "ray"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  RgbImage draw(const std::string& name, const Words& more) const {
    Words all = words(more);
    all.insert(all.end(), {"-o", path(name)});
    const Result result = vpe(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_image(path(name));
  }
};

// Returns the mean difference of channels, in steps of 255.
double difference(const RgbImage& a, const RgbImage& b) {
  if (a.pixels.size() != b.pixels.size()) return 255;
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    sum += std::abs(a.pixels[i].r - b.pixels[i].r) + std::abs(a.pixels[i].g - b.pixels[i].g) +
           std::abs(a.pixels[i].b - b.pixels[i].b);
  }
  return sum / (3.0 * static_cast<double>(a.pixels.size()));
}

TEST_F(Screens, AHeadAtRestSeesThePlainImageThroughAScreenBeforeIt) {
  const RgbImage screen = draw("screen.png", {"--screens", path("wall.screens.toml")});
  const std::string fov = std::to_string(2 * std::atan(0.225) * 180 / 3.14159265358979323846);
  const RgbImage plain = draw("plain.png", {"--size", "320x180", "--fov", fov});
  EXPECT_EQ(screen.width, 320);
  EXPECT_EQ(screen.height, 180);
  // The angle of view is rounded in its text.
  EXPECT_LT(difference(screen, plain), 0.3);
  // With the room turned, the head's own direction changes nothing: the screen stays where it is.
  EXPECT_LT(difference(screen,
                       draw("turned.png", {"--screens", path("wall.screens.toml"), "--head", "0,0,0,20,10,5"})),
            0.05);
}

TEST_F(Screens, AHeadToTheRightSeesMoreOfTheLeft) {
  const RgbImage rest = draw("rest.png", {"--screens", path("wall.screens.toml")});
  const RgbImage moved = draw("moved.png", {"--screens", path("wall.screens.toml"), "--head", "0.2,0,0"});
  // Far ground keeps its direction: the screen is as far from the eye as before, so what was at column x is now 0.2 m to
  // the right: 80 pixels.
  double sum = 0;
  double unmoved = 0;
  int count = 0;
  for (int y = 100; y < 180; ++y) {
    for (int x = 0; x < 240; ++x, ++count) {
      const auto at = [&](const RgbImage& image, int column) {
        return image.pixels[static_cast<std::size_t>(y * 320 + column)].r;
      };
      sum += std::abs(at(rest, x) - at(moved, x + 80));
      unmoved += std::abs(at(rest, x) - at(moved, x));
    }
  }
  EXPECT_LT(sum, 0.2 * unmoved);
  EXPECT_LT(sum / count, 1.0);
}

TEST_F(Screens, EyesDifferByTheirBase) {
  const RgbImage left = draw("l.png", {"--screens", path("wall.screens.toml"), "--screen-eye", "left"});
  const RgbImage head = draw("h.png", {"--screens", path("wall.screens.toml"), "--head", "-0.03,0,0"});
  EXPECT_LT(difference(left, head), 0.05);
}

TEST_F(Screens, ALensBendsTheImage) {
  const RgbImage glass = draw("g.png", {"--screens", path("two.screens.toml"), "--screen", "glass"});
  EXPECT_EQ(glass.width, 240);
  EXPECT_EQ(glass.height, 270);
  expect_failure(words({"--screens", path("two.screens.toml"), "--screen", "glass", "--range", path("r.tif"),
                        "-o", path("x.png")}),
                 2, {"--range", "lens"});
}

TEST_F(Screens, HaveNoRecipe) {
  draw("screen.png", {"--screens", path("wall.screens.toml")});
  expect_failure({"render", planet().string(), "--from-image", path("screen.png"), "-o", path("x.png")}, 1,
                 {"no recipe"});
}

TEST_F(Screens, WrongOnesAreRefused) {
  const std::string two = path("two.screens.toml");
  const auto refused = [&](const Words& more, const Words& parts) {
    Words all = words(more);
    all.insert(all.end(), {"-o", path("x.png")});
    expect_failure(all, 2, parts);
  };
  refused({"--screens", two}, {"several screens", "'wall', 'glass'"});
  refused({"--screens", two, "--screen", "door"}, {"door", "'wall', 'glass'"});
  refused({"--screen", "wall"}, {"--screens FILE"});
  refused({"--screens", two, "--screen", "wall", "--head", "1,2"}, {"--head", "X,Y,Z"});
  refused({"--screens", two, "--screen", "wall", "--head", "0,0,-2"}, {"shows nothing"});
  refused({"--screens", two, "--screen", "wall", "--stereo", "anaglyph"}, {"--screen-eye"});
  Words gone = words({"--screens", path("gone.screens.toml"), "-o", path("x.png")});
  expect_failure(gone, 1, {"gone.screens.toml"});
}

}  // namespace
}  // namespace app_test
