#include "mars/raster/gdal_footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"

namespace mars {
namespace {

constexpr int kParts = 16;  // along a side
constexpr int kPoints = 5;  // along a side of a part, both ends included

// Returns a cap around the points that are on the planet; its radius is negative if there are none. It is
// larger by the longest step between points, because between them the edge of the part may bulge and the map
// may end.
Cap enclose(const std::array<glm::dvec3, kPoints * kPoints>& points) {
  glm::dvec3 sum(0);
  const auto on_planet = [](const glm::dvec3& p) { return std::isfinite(p.x); };
  for (const glm::dvec3& p : points) {
    if (on_planet(p)) sum += p;
  }
  const auto first = std::find_if(points.begin(), points.end(), on_planet);
  if (first == points.end()) return {{1, 0, 0}, -1};
  const glm::dvec3 centre = glm::length(sum) > 1e-6 ? glm::normalize(sum) : *first;
  double radius = 0;
  double step = 0;
  for (int row = 0; row < kPoints; ++row) {
    for (int column = 0; column < kPoints; ++column) {
      const auto at = [&](int c, int r) { return points[static_cast<std::size_t>(r * kPoints + c)]; };
      const glm::dvec3 p = at(column, row);
      if (!on_planet(p)) continue;
      radius = std::max(radius, angle_between_rad(centre, p));
      if (column + 1 < kPoints && on_planet(at(column + 1, row))) {
        step = std::max(step, angle_between_rad(p, at(column + 1, row)));
      }
      if (row + 1 < kPoints && on_planet(at(column, row + 1))) {
        step = std::max(step, angle_between_rad(p, at(column, row + 1)));
      }
    }
  }
  return {centre, radius + step};
}

// Returns true if two caps overlap.
bool overlap(const Cap& a, const Cap& b) {
  const double reach = a.radius_rad + b.radius_rad;
  // The chord resolves small angles, unlike the dot product, but not those close to pi.
  return reach > 3.1 || glm::length(a.centre - b.centre) <= 2 * std::sin(reach / 2) * (1 + 1e-12);
}

}  // namespace

Footprint::Footprint(const Georeference& georeference) {
  const PixelGrid& grid = georeference.grid();
  const double pixel_rad = georeference.resolution_m() / kMarsRadius_m;
  for (int part_row = 0; part_row < kParts; ++part_row) {
    for (int part_column = 0; part_column < kParts; ++part_column) {
      std::array<glm::dvec2, kPoints * kPoints> pixels;
      for (int i = 0; i < kPoints * kPoints; ++i) {
        const int row = i / kPoints;
        const double u = part_column + (i - row * kPoints) / (kPoints - 1.0);
        const double v = part_row + row / (kPoints - 1.0);
        pixels[static_cast<std::size_t>(i)] = {grid.width * u / kParts - 0.5, grid.height * v / kParts - 0.5};
      }
      std::array<glm::dvec3, kPoints * kPoints> points;
      georeference.to_directions(pixels, points);
      Cap part = enclose(points);
      if (part.radius_rad < 0) continue;
      part.radius_rad += 4 * pixel_rad;
      parts_.push_back(part);
    }
  }
  whole_ = {{1, 0, 0}, kPi};
  glm::dvec3 sum(0);
  for (const Cap& part : parts_) sum += part.centre;
  if (glm::length(sum) < 0.1 * static_cast<double>(parts_.size())) return;
  whole_ = {glm::normalize(sum), 0};
  for (const Cap& part : parts_) {
    whole_.radius_rad =
        std::max(whole_.radius_rad, angle_between_rad(whole_.centre, part.centre) + part.radius_rad);
  }
}

bool Footprint::touches(const Cap& cap) const {
  return overlap(whole_, cap) &&
         std::any_of(parts_.begin(), parts_.end(), [&](const Cap& part) { return overlap(part, cap); });
}

}  // namespace mars
