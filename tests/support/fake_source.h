// Elevation from a function, so that every height of the planet is known.
#pragma once

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <string>

#include "mars/sources/source.h"

namespace test_support {

// Samples a function of the direction.
class FakeElevation : public mars::ElevationSource {
 public:
  using Height = std::function<double(const glm::dvec3& direction)>;
  using Spacing = std::function<double(const mars::Cap& cap)>;

  explicit FakeElevation(
      Height height, Spacing spacing = [](const mars::Cap&) { return 1e9; })
      : height_(std::move(height)), spacing_(std::move(spacing)) {}

  std::vector<mars::SourceInfo> infos() const override {
    mars::SourceInfo info;
    info.name = "fake";
    info.resolution_m = 1000;
    info.datum = mars::VerticalDatum::sphere(mars::kMarsRadius_m);
    return {info};
  }
  void sample(std::span<const glm::dvec3> directions, double, std::span<double> heights_m) const override {
    for (std::size_t n = 0; n < directions.size(); ++n) heights_m[n] = height_(directions[n]);
  }
  void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const override {
    for (std::size_t n = 0; n < directions.size(); ++n)
      source_index[n] = std::isfinite(height_(directions[n])) ? 0 : -1;
  }
  double spacing_in(const mars::Cap& cap) const override { return spacing_(cap); }
  void visit_posts(std::size_t max_posts, const mars::PostVisitor& visit) const override {
    // Posts on a spiral over the sphere.
    std::vector<glm::dvec3> directions;
    std::vector<double> heights;
    const auto count = std::min<std::size_t>(max_posts, 5000);
    for (std::size_t n = 0; n < count; ++n) {
      const double z = 1.0 - (2.0 * static_cast<double>(n) + 1.0) / static_cast<double>(count);
      const double angle = 2.399963229728653 * static_cast<double>(n);
      const double r = std::sqrt(1.0 - z * z);
      directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
      heights.push_back(height_(directions.back()));
    }
    visit(directions, heights);
  }

 private:
  Height height_;
  Spacing spacing_;
};

// Returns smooth heights with features from 2000 km down to about 30 km, within +-8 km.
inline double bumpy_height(const glm::dvec3& d) {
  double h = 0;
  double size = 3000;
  double frequency = 5;
  for (int octave = 0; octave < 6; ++octave) {
    h += size * std::sin(frequency * d.x + 1.3 * octave) * std::sin(frequency * d.y + 0.7 * octave) *
         std::cos(frequency * d.z + 2.1 * octave);
    size *= 0.5;
    frequency *= 2.1;
  }
  return h;
}

}  // namespace test_support
