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

// Returns the cap of a rectangle of pixels, with a margin.
Cap rectangle_cap(const Georeference& georeference, const glm::dvec2& corner, const glm::dvec2& size) {
  std::array<glm::dvec2, kPoints * kPoints> pixels;
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const int row = i / kPoints;
    const glm::dvec2 along((i - row * kPoints) / (kPoints - 1.0), row / (kPoints - 1.0));
    pixels[static_cast<std::size_t>(i)] = corner + size * along - 0.5;
  }
  std::array<glm::dvec3, kPoints * kPoints> points;
  georeference.to_directions(pixels, points);
  Cap cap = enclose(points);
  if (cap.radius_rad >= 0) cap.radius_rad += 4 * georeference.resolution_m() / kMarsRadius_m;
  return cap;
}

// Returns one of the kParts x kParts parts of a raster, which may be empty in small ones.
PixelWindow part_of(const PixelGrid& grid, int part_column, int part_row) {
  const auto edge = [](int size, int part) {
    return static_cast<int>(static_cast<long>(size) * part / kParts);
  };
  const int column = edge(grid.width, part_column);
  const int row = edge(grid.height, part_row);
  return {column, row, edge(grid.width, part_column + 1) - column, edge(grid.height, part_row + 1) - row};
}

// Divides windows with some data until they are small or kMostQuestions have been asked.
class WindowSearch {
 public:
  explicit WindowSearch(const std::function<Coverage(const PixelWindow&)>& coverage) : coverage_(coverage) {}

  void add(const PixelWindow& window, std::vector<PixelWindow>& found) {
    if (window.columns <= 0 || window.rows <= 0) return;
    const Coverage coverage = ++questions_ > kMostQuestions ? Coverage::kAll : coverage_(window);
    left_out_ = left_out_ || coverage == Coverage::kNone;
    if (coverage == Coverage::kNone) return;
    const bool is_wide = window.columns > kSmallWindow;
    const bool is_high = window.rows > kSmallWindow;
    if (coverage == Coverage::kAll || (!is_wide && !is_high)) {
      found.push_back(window);
      return;
    }
    const int columns = is_wide ? window.columns / 2 : window.columns;
    const int rows = is_high ? window.rows / 2 : window.rows;
    add({window.column, window.row, columns, rows}, found);
    add({window.column + columns, window.row, window.columns - columns, rows}, found);
    add({window.column, window.row + rows, columns, window.rows - rows}, found);
    add({window.column + columns, window.row + rows, window.columns - columns, window.rows - rows}, found);
  }

  bool has_left_out() const { return left_out_; }

 private:
  static constexpr int kSmallWindow = 256;
  static constexpr int kMostQuestions = 4096;

  const std::function<Coverage(const PixelWindow&)>& coverage_;
  int questions_ = 0;
  bool left_out_ = false;
};

}  // namespace

std::vector<PixelWindow> data_windows(const PixelGrid& grid,
                                      const std::function<Coverage(const PixelWindow&)>& coverage) {
  std::vector<PixelWindow> found;
  WindowSearch search(coverage);
  for (int row = 0; row < kParts; ++row) {
    for (int column = 0; column < kParts; ++column) search.add(part_of(grid, column, row), found);
  }
  if (!search.has_left_out()) return {{0, 0, grid.width, grid.height}};
  return found;
}

bool overlaps(const std::vector<PixelWindow>& windows, const PixelWindow& window) {
  return std::ranges::any_of(windows, [&](const PixelWindow& w) {
    return w.column < window.column + window.columns && window.column < w.column + w.columns &&
           w.row < window.row + window.rows && window.row < w.row + w.rows;
  });
}

Footprint::Footprint(const Georeference& georeference, const std::vector<PixelWindow>& windows) {
  const PixelGrid& grid = georeference.grid();
  const glm::dvec2 size = glm::dvec2(grid.width, grid.height) / double{kParts};
  const bool is_whole =
      windows.size() == 1 && windows[0].columns == grid.width && windows[0].rows == grid.height;
  std::size_t next = 0;  // windows have the order of the parts
  for (int part_row = 0; part_row < kParts; ++part_row) {
    for (int part_column = 0; part_column < kParts; ++part_column) {
      Area area{rectangle_cap(georeference, size * glm::dvec2(part_column, part_row), size), {}};
      const PixelWindow pixels = part_of(grid, part_column, part_row);
      while (next < windows.size() && !is_whole && pixels.columns > 0 && pixels.rows > 0 &&
             windows[next].column >= pixels.column && windows[next].column < pixels.column + pixels.columns &&
             windows[next].row >= pixels.row && windows[next].row < pixels.row + pixels.rows) {
        const PixelWindow& w = windows[next++];
        const Cap cap = rectangle_cap(georeference, {w.column, w.row}, {w.columns, w.rows});
        if (cap.radius_rad >= 0) area.windows.push_back(cap);
      }
      if (area.cap.radius_rad >= 0 && (is_whole || !area.windows.empty())) areas_.push_back(std::move(area));
    }
  }
  whole_ = {{1, 0, 0}, kPi};
  glm::dvec3 sum(0);
  for (const Area& area : areas_) sum += area.cap.centre;
  if (glm::length(sum) < 0.1 * static_cast<double>(areas_.size())) return;
  whole_ = {glm::normalize(sum), 0};
  for (const Area& area : areas_) {
    whole_.radius_rad =
        std::max(whole_.radius_rad, angle_between_rad(whole_.centre, area.cap.centre) + area.cap.radius_rad);
  }
}

bool Footprint::touches(const Cap& cap) const {
  return overlap(whole_, cap) && std::ranges::any_of(areas_, [&](const Area& area) {
           return overlap(area.cap, cap) &&
                  (area.windows.empty() ||
                   std::ranges::any_of(area.windows, [&](const Cap& window) { return overlap(window, cap); }));
         });
}

}  // namespace mars
