// Domes with panoramas of all kinds, with a formula and without, for the tests of how domes are drawn.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "tests/objects/posters/poster_fixture.h"

namespace objects::test {

using Kind = PanoramaFormula::Kind;

// Returns the formula of a panorama of the whole circle, from the nadir to the zenith or as far as 70 degrees from the horizon.
inline PanoramaFormula formula_of(Kind kind, double turn_px) {
  PanoramaFormula f;
  f.kind = kind;
  f.turn_px = turn_px;
  f.width_px = turn_px;
  f.turn_azimuth_deg = 37.5;
  f.facets = kind == Kind::kFacets ? 6 : 0;
  f.focal_px = kind == Kind::kFacets ? 0.5 * turn_px / f.facets / std::tan(mars::kPi / f.facets)
                                     : turn_px / (2 * mars::kPi);
  f.height_px = kind == Kind::kEquirectangular ? turn_px / 2 : std::round(turn_px * 0.8);
  f.horizon_px = 0.5 * f.height_px;
  return f;
}

// Returns where a panorama shows a direction, by the definitions of panorama_formula.h and nothing that the painter uses.
inline std::optional<PanoramaPlace> place_by_definition(const PanoramaFormula& f, const glm::dvec3& d) {
  const double level = std::hypot(d.x, d.y);
  const double length = glm::length(d);
  glm::dvec2 at(0);
  double pixel_sr = 0;
  if (f.kind == Kind::kFacets) {
    const double side = f.turn_px / f.facets;
    double best = -2;
    for (int n = 0; n < f.facets; ++n) {
      const double azimuth =
          f.turn_azimuth_deg * mars::kRadiansPerDegree + (n + 0.5) * 2 * mars::kPi / f.facets;
      const double ahead = d.x * std::sin(azimuth) + d.y * std::cos(azimuth);
      if (ahead <= best) continue;
      best = ahead;
      at.x = (n + 0.5) * side + f.focal_px * (d.x * std::cos(azimuth) - d.y * std::sin(azimuth)) / ahead;
      at.y = f.horizon_px - f.focal_px * d.z / ahead;
      pixel_sr = std::pow(ahead / length, 3) / (f.focal_px * f.focal_px);
    }
  } else {
    double turned = std::fmod(std::atan2(d.x, d.y) / mars::kRadiansPerDegree - f.turn_azimuth_deg, 360);
    if (turned < 0) turned += 360;
    at.x = turned / 360 * f.turn_px;
    const bool is_cylinder = f.kind == Kind::kCylinder;
    at.y = f.horizon_px - f.focal_px * (is_cylinder ? d.z / level : std::atan2(d.z, level));
    const double cosine = std::max(1e-6, level / length);
    pixel_sr = 2 * mars::kPi / f.turn_px * (is_cylinder ? cosine * cosine * cosine : cosine) / f.focal_px;
  }
  at.x -= f.crop_left_px;
  if (at.x < -1e-8) at.x += f.turn_px;
  if (!(at.x >= -1e-8 && at.x <= f.width_px + 1e-8 && at.y >= -1e-8 && at.y <= f.height_px + 1e-8))
    return std::nullopt;
  return PanoramaPlace{glm::clamp(at / glm::dvec2(f.width_px, f.height_px), 0.0, 1.0), pixel_sr};
}

// Returns a panorama whose colours rise and fall by at most a few steps from pixel to pixel, the same across its ends, and with
// `noise` steps of chance. It has the formula if asked for; the lookup always.
inline PosterImage panorama_image(const PanoramaFormula& f, int noise = 0) {
  const int width = static_cast<int>(f.width_px);
  const int height = static_cast<int>(f.height_px);
  Texture t{width, height, {}};
  std::mt19937 random(7);
  const auto wave = [](double at, double phase) { return 128 + 100 * std::sin(2 * mars::kPi * at + phase); };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double u = (x + 0.5) / f.turn_px;
      const double v = (y + 0.5) / height;
      const auto byte = [&](double value) {
        const int by_chance = noise > 0 ? static_cast<int>(random() % static_cast<unsigned>(noise)) : 0;
        return static_cast<std::uint8_t>(std::clamp(static_cast<int>(std::lround(value)) + by_chance, 0, 255));
      };
      t.texels.push_back({byte(wave(2 * u, 3 * v)), byte(wave(5 * v, 0)), byte(wave(3 * u, 9 * v)), 255});
    }
  }
  PosterImage image{std::make_shared<const TexturePyramid>(std::move(t)), width, height};
  image.lookup = [f](const glm::dvec3& d) { return place_by_definition(f, d); };
  image.is_full_circle = f.width_px == f.turn_px;
  image.formula = f;
  return image;
}

// Returns a dome about a place (planet's centre + kRadius_m + 1000 upwards), with the axes of the request's camera there.
inline PlacedPoster dome_of(const core::DrawRequest& r, PosterImage image, double radius_m = 100) {
  PlacedPoster p;
  p.form = PosterForm::kDome;
  p.image = std::move(image);
  p.axes = r.view.camera.axes;
  p.middle_m = r.view.camera.position_m;
  p.radius_m = radius_m;
  p.fade_m = 4 * radius_m;
  return p;
}

// Returns the dome without its formula: it is drawn a pixel at a time.
inline PlacedPoster by_pixels(PlacedPoster dome) {
  dome.image.formula.reset();
  return dome;
}

struct FrameDifference {
  double mean = 0;  // steps of 255, of the channel that differs most
  int most = 0;
  int parted = 0;  // pixels that only one of them covers, or whose ranges differ by more than a 2^19th
};

inline FrameDifference difference(const core::Frame& a, const core::Frame& b) {
  FrameDifference out;
  for (std::size_t n = 0; n < a.colour.size(); ++n) {
    const float ra = a.range_m[n];
    const float rb = b.range_m[n];
    const bool is_same = ra == rb || std::abs(ra - rb) <= std::ldexp(std::max(ra, rb), -19);
    if (!is_same) {
      ++out.parted;
      continue;
    }
    const Rgb& p = a.colour[n];
    const Rgb& q = b.colour[n];
    const int steps = std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)});
    out.mean += steps;
    out.most = std::max(out.most, steps);
  }
  out.mean /= static_cast<double>(a.colour.size());
  return out;
}

}  // namespace objects::test
