// Small planet files from fake sources.
#pragma once

#include <memory>

#include "paging/build/builder.h"
#include "paging/surface/surface.h"
#include "tests/support/fake_source.h"
#include "tests/support/support.h"

namespace test_support {

// Builds a planet file from a fake source and opens it.
inline std::shared_ptr<const paging::PlanetFile> build_fake(const std::filesystem::path& path,
                                                            const FakeElevation& source, double base_spacing_m,
                                                            int threads = 2, const std::string& body = "Mars") {
  paging::BuildOptions options;
  options.output = path.string();
  options.base_spacing_m = base_spacing_m;
  options.threads = threads;
  options.tile_k = 5;
  options.resampling_posts = 5000;
  options.body = body;
  paging::build_planet(options, source, nullptr);
  return paging::PlanetFile::open(path.string());
}

// Returns a spacing that is fine around one direction and coarse elsewhere.
inline FakeElevation::Spacing fine_around(const glm::dvec3& centre, double reach_rad, double spacing_m) {
  return [=](const mars::Cap& cap) {
    return glm::length(cap.centre - centre) < cap.radius_rad + reach_rad ? spacing_m : 1e9;
  };
}

// Adds to each height an offset that shows at which spacing it was sampled.
class SpacingElevation : public FakeElevation {
 public:
  using FakeElevation::FakeElevation;
  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override {
    FakeElevation::sample(directions, spacing_m, heights_m);
    for (double& h : heights_m) h += 20 * std::log2(spacing_m);
  }
};

// Gives colours that are a function of the place.
class FakeImage : public mars::ImageSource {
 public:
  std::vector<mars::SourceInfo> infos() const override { return {FakeElevation(bumpy_height).infos().front()}; }
  void sample(std::span<const glm::dvec3> directions, double, std::span<vpe::base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const auto byte = [](double x) { return static_cast<std::uint8_t>(127.0 * (x + 1)); };
      colours[n] = {byte(directions[n].x), byte(directions[n].y), byte(directions[n].z)};
      alpha[n] = 255;
    }
  }
  double spacing_in(const mars::Cap& cap) const override { return cap.centre.x > 0 ? 20000 : 100000; }
};

}  // namespace test_support
