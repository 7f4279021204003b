// Fixture of images in the world: a planet with ground that is fine enough around one place, and what draws there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {

using vpe::base::Rgb;
using vpe::core::FloatImage;
using vpe::core::RgbImage;

// The camera stands over 10 E, 5 N on hills of some hundred metres, with posts about 600 m apart within 35 km.
class PosterSceneTest : public AppTest {
 protected:
  // Colours of elevation and a low sun, so that neighbouring pixels differ.
  static Words look() {
    return {"--set", "mode=coloured",   "--set", "palette.low=-800", "--set", "palette.high=800",
            "--set", "sun.azimuth=300", "--set", "sun.elevation=25"};
  }

  // Returns a planet that is made once per process.
  std::filesystem::path hills() const {
    static const test_support::TempDir kDir;
    static const std::filesystem::path kPlanet = build_hills(kDir.path());
    return kPlanet;
  }

  void write_scene(const std::string& tables) const {
    write_text(dir_ / "a.scene.toml", "version = 1\n" + tables);
  }

  // Writes an image of one colour.
  void write_plain(const std::string& name, Rgb colour, int width = 8, int height = 8) const {
    const std::vector<Rgb> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), colour);
    vpe::core::write_image(dir_ / name, pixels, width, height);
  }

  // Draws an image of 320 x 240 with `words` added, and expects success.
  RgbImage draw(const std::string& output, const std::string& pose, const Words& words) const {
    Words all{"render", hills().string(), "--pose", pose, "--size", "320x240", "-o", output, "-q"};
    for (const Words& some : {look(), words}) all.insert(all.end(), some.begin(), some.end());
    const Result result = vpe(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / output);
  }
  RgbImage draw_scene(const std::string& output, const std::string& pose, const Words& words = {}) const {
    Words all{"--scene", "a.scene.toml"};
    all.insert(all.end(), words.begin(), words.end());
    return draw(output, pose, all);
  }

 private:
  std::filesystem::path build_hills(const std::filesystem::path& folder) const {
    Dem base;
    base.height_m = [](int, int) { return 0.0; };
    write_dem(folder / "base.tif", base);
    Dem inset;
    inset.width = inset.height = 120;
    inset.west_deg = 9.4;
    inset.north_deg = 5.6;
    inset.cell_deg = 0.01;
    inset.height_m = [](int column, int row) {
      const auto wave = [&](double across, double down, double shift) {
        return std::sin(across * column + down * row + shift);
      };
      return 300 * wave(0.21, 0.13, 0) + 150 * wave(-0.5, 0.6, 1) + 100 * wave(1.3, 0.7, 2) +
             60 * wave(0.9, -1.6, 3);
    };
    write_dem(folder / "inset.tif", inset);
    const std::filesystem::path planet = folder / "hills.vpe";
    const Result result = vpe({"build", (folder / "base.tif").string(), (folder / "inset.tif").string(), "-o",
                               planet.string(), "--base-spacing", "100000", "--feather", "1000", "-q"});
    if (result.exit_code != 0) throw std::runtime_error("cannot build the test planet: " + result.err);
    return planet;
  }
};

// Returns the largest difference of a channel.
inline int steps_between(const Rgb& a, const Rgb& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

inline std::size_t pixel_at(const RgbImage& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
}

}  // namespace app_test
