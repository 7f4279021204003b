// Planets and appearances for comparing images of either backend with their definition.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/gl/appearance_reference.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/core/frame.h"

namespace test_support {

// An image whose colours rise and fall over some 400 km.
class WavyImage : public FakeImage {
 public:
  void sample(std::span<const glm::dvec3> directions, double, std::span<vpe::base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const glm::dvec3 d = glm::normalize(directions[n]);
      const auto byte = [](double x) {
        return static_cast<std::uint8_t>(std::lround(127 + 110 * std::sin(x)));
      };
      colours[n] = {byte(53 * d.x + 1), byte(47 * d.y), byte(59 * d.z + 2)};
      alpha[n] = 255;
    }
  }
  double spacing_in(const mars::Cap&) const override { return 20000; }
};

inline const glm::dvec3 kWavyMiddle = glm::normalize(glm::dvec3(0.9, 0.3, 0.35));

// Builds a planet with an image and posts of some 5 km round kWavyMiddle.
inline std::shared_ptr<const paging::PlanetFile> wavy_planet(const std::filesystem::path& path) {
  paging::BuildOptions options;
  options.output = path.string();
  options.base_spacing_m = 100000;
  options.threads = 2;
  options.tile_k = 5;
  options.resampling_posts = 1000;
  const WavyImage image;
  paging::build_planet(options, FakeElevation(bumpy_height, fine_around(kWavyMiddle, 0.06, 5000)), &image);
  return paging::PlanetFile::open(options.output);
}

// Returns every mode that shows ground with every shading and colour, on black.
inline std::vector<vpe::core::Appearance> all_appearances() {
  using vpe::core::Colour;
  using vpe::core::Mode;
  using vpe::core::Shading;
  std::vector<vpe::core::Appearance> all;
  for (const auto mode : {Mode::kUnlit, Mode::kLit, Mode::kColoured, Mode::kTextured}) {
    for (const auto shading : {Shading::kFlat, Shading::kGouraud}) {
      for (const auto colour :
           {Colour::kNone, Colour::kElevation, Colour::kSlope, Colour::kAspect, Colour::kImage}) {
        for (const bool colourise : {false, true}) {
          if (colourise && (mode != Mode::kTextured || colour == Colour::kImage)) continue;
          if (mode == Mode::kLit && colour != Colour::kNone) continue;
          vpe::core::Appearance& a = all.emplace_back();
          a.mode = mode;
          a.shading = shading;
          a.colour = colour;
          a.colourise = colourise;
          a.palette_high = colour == Colour::kElevation ? 4000 : 0;
          a.palette_low = colour == Colour::kElevation ? -4000 : 0;
          a.exaggeration = shading == Shading::kFlat ? 2 : 1;
          a.background = vpe::core::Background::kBlack;
        }
      }
    }
  }
  for (const auto mode : {Mode::kLit, Mode::kTextured}) {
    for (const auto shading : {Shading::kFlat, Shading::kGouraud}) {
      vpe::core::Appearance& a = all.emplace_back();
      a.mode = mode;
      a.shading = shading;
      a.light = vpe::core::Light::kOff;
      a.colour = Colour::kNone;
      a.background = vpe::core::Background::kBlack;
    }
  }
  vpe::core::Appearance& stretched = all.emplace_back();
  stretched.mode = Mode::kTextured;
  stretched.image_low = 30;
  stretched.image_high = 180;
  stretched.image_gamma = 1.6;
  stretched.background = vpe::core::Background::kBlack;
  return all;
}

inline std::string name(const vpe::core::Appearance& a) {
  return "mode " + std::to_string(static_cast<int>(a.mode)) + " shading " +
         std::to_string(static_cast<int>(a.shading)) + " colour " + std::to_string(static_cast<int>(a.colour)) +
         (a.colourise ? " colourised" : "") + (a.light == vpe::core::Light::kOff ? " without light" : "") +
         (a.image_low > 0 ? " stretched" : "");
}

// Returns the share of pixels within 2 of the reference in every channel, among those that the reference has.
inline double agreement(vpe::core::Renderer& draw, const paging::Surface& surface,
                        const vpe::core::DrawRequest& request) {
  const vpe::core::DrawResult result = draw.draw(request);
  const GroundReference reference(surface, request.settings, request.sun);
  const int width = request.view.width, height = request.view.height;
  int known = 0, good = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::size_t>(y * width + x);
      if (!std::isfinite(result.frame.range_m[at])) continue;
      const glm::dvec3 hit =
          request.view.camera.position_m +
          static_cast<double>(result.frame.range_m[at]) * vpe::core::pixel_ray(request.view, x + 0.5, y + 0.5);
      const auto wanted = reference.at(glm::normalize(hit));
      if (!wanted) continue;
      ++known;
      const vpe::base::Rgb c = result.frame.colour[at];
      const glm::dvec3 off = glm::abs(glm::dvec3(c.r, c.g, c.b) - glm::clamp(*wanted, 0.0, 255.0));
      good += std::max({off.x, off.y, off.z}) <= 2.0 ? 1 : 0;
    }
  }
  EXPECT_GT(known, width * height / 2);
  return static_cast<double>(good) / std::max(1, known);
}

}  // namespace test_support
