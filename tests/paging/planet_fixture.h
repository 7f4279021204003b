// Small planet files from fake sources.
#pragma once

#include <memory>

#include "paging/builder.h"
#include "paging/surface.h"
#include "tests/support/fake_source.h"
#include "tests/support/support.h"

namespace test_support {

inline std::shared_ptr<const paging::PlanetFile> build_fake(const std::filesystem::path& path, const FakeElevation& source,
                                                            double base_spacing_m, int threads = 2) {
  paging::BuildOptions options;
  options.output = path.string();
  options.base_spacing_m = base_spacing_m;
  options.threads = threads;
  options.tile_k = 5;
  options.resampling_posts = 5000;
  paging::build_planet(options, source, nullptr);
  return paging::PlanetFile::open(path.string());
}

// Fine around one direction, coarse elsewhere.
inline FakeElevation::Spacing fine_around(const glm::dvec3& centre, double reach_rad, double spacing_m) {
  return [=](const mars::Cap& cap) {
    return glm::length(cap.centre - centre) < cap.radius_rad + reach_rad ? spacing_m : 1e9;
  };
}

}  // namespace test_support
