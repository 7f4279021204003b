#include "vpe/map/ground_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>

#include "lod/tree/posts.h"
#include "paging/surface/place_cursor.h"
#include "vpe/base/number.h"
#include "vpe/base/parallel.h"

namespace vpe::map {

namespace {

constexpr int kRowsAtOnce = 16;
constexpr int kMostHalvings = 24;

// Describes the posts that hold directions, counted from one at the first direction.
struct PostsAround {
  LocalMap map;
  glm::dvec2 first_m{0};
  double west = 0;
  double east = 0;
  double north = 0;
  double south = 0;

  double columns() const { return west + east + 1; }
  double rows() const { return north + south + 1; }
};

PostsAround find_posts(std::span<const glm::dvec3> directions, double spacing_m, double margin_m,
                       double radius_m) {
  if (directions.empty()) throw std::invalid_argument("frame_around: there are no places");
  if (!(std::isfinite(spacing_m) && spacing_m > 0))
    throw std::invalid_argument("frame_around: the spacing must be above 0");
  if (!(std::isfinite(margin_m) && margin_m >= 0))
    throw std::invalid_argument("frame_around: the margin must be 0 or above");
  glm::dvec3 sum(0);
  for (const glm::dvec3& direction : directions) sum += glm::normalize(direction);
  const bool has_mean = glm::length(sum) > 1e-6 * static_cast<double>(directions.size());
  PostsAround around{LocalMap(mars::lon_lat(has_mean ? sum : directions[0]), radius_m)};
  around.first_m = around.map.to_map(directions[0]);
  glm::dvec2 least = around.first_m;
  glm::dvec2 most = around.first_m;
  for (const glm::dvec3& direction : directions) {
    const glm::dvec2 at = around.map.to_map(direction);
    least = {std::min(least.x, at.x), std::min(least.y, at.y)};
    most = {std::max(most.x, at.x), std::max(most.y, at.y)};
  }
  // Lets rounding pass where a place is a post.
  const auto posts = [&](double length_m) { return std::ceil((length_m + margin_m) / spacing_m - 1e-6); };
  around.west = posts(around.first_m.x - least.x);
  around.east = posts(most.x - around.first_m.x);
  around.south = posts(around.first_m.y - least.y);
  around.north = posts(most.y - around.first_m.y);
  return around;
}

glm::dvec2 lon_lat_degrees(const GridFrame& frame, glm::dvec2 grid) {
  const mars::LonLat place = frame.to_place(grid);
  return {place.lon_deg, place.lat_deg};
}

bool is_pole(glm::dvec2 place_deg) { return 90 - std::abs(place_deg.y) < 1e-9; }

// Adds places between two ends of a straight piece until lines between them are near enough, then the second
// end.
void add_places(const GridFrame& frame, glm::dvec2 begin, glm::dvec2 end, double tolerance_m, int halvings,
                std::vector<glm::dvec2>& places) {
  const glm::dvec2 from = places.back();
  glm::dvec2 to = lon_lat_degrees(frame, end);
  if (is_pole(to)) to.x = from.x;
  if (is_pole(from)) places.back().x = to.x;
  to.x = places.back().x + std::remainder(to.x - places.back().x, 360.0);
  const glm::dvec2 middle = (begin + end) * 0.5;
  const glm::dvec2 straight = (places.back() + to) * 0.5;
  const double off_m =
      frame.map.radius_m() *
      mars::angle_between_rad(frame.map.to_direction(frame.to_map(middle)),
                              mars::direction({straight.x, std::clamp(straight.y, -90.0, 90.0)}));
  if (halvings < kMostHalvings && off_m > tolerance_m) {
    add_places(frame, begin, middle, tolerance_m, halvings + 1, places);
    add_places(frame, middle, end, tolerance_m, halvings + 1, places);
    return;
  }
  places.push_back(to);
}

}  // namespace

glm::dvec2 GridFrame::to_grid(mars::LonLat place) const {
  const glm::dvec2 at_m = map.to_map(place) - first_m;
  return {at_m.x / spacing_m, -at_m.y / spacing_m};
}

double GridFrame::scale_error() const {
  double farthest_m = 0;
  for (const int column : {0, columns - 1})
    for (const int row : {0, rows - 1}) farthest_m = std::max(farthest_m, glm::length(to_map({column, row})));
  return map.scale_across(farthest_m) - 1;
}

double posts_around(std::span<const glm::dvec3> directions, double spacing_m, double margin_m,
                    double radius_m) {
  const PostsAround around = find_posts(directions, spacing_m, margin_m, radius_m);
  return around.columns() * around.rows();
}

GridFrame frame_around(std::span<const glm::dvec3> directions, double spacing_m, double margin_m,
                       double radius_m) {
  const PostsAround around = find_posts(directions, spacing_m, margin_m, radius_m);
  if (around.columns() * around.rows() > static_cast<double>(kMostGridPosts))
    throw std::invalid_argument(
        "a grid of posts " + base::format_significant(spacing_m, 6) + " m apart needs " +
        base::format_significant(around.columns() * around.rows() / 1e6, 3) + " million of them, and at most " +
        std::to_string(kMostGridPosts / 1'000'000) + " million are possible");
  GridFrame frame{around.map};
  frame.first_m = {around.first_m.x - around.west * spacing_m, around.first_m.y + around.north * spacing_m};
  frame.spacing_m = spacing_m;
  frame.columns = static_cast<int>(around.columns());
  frame.rows = static_cast<int>(around.rows());
  return frame;
}

GroundGrid sample_ground(const paging::Surface& surface, const GridFrame& frame, int threads,
                         const std::function<void(double)>& progress) {
  const auto columns = static_cast<std::size_t>(frame.columns);
  const auto rows = static_cast<std::size_t>(frame.rows);
  const paging::PlanetMeta& meta = surface.planet().meta();
  GroundGrid grid;
  grid.heights = {frame.columns, frame.rows, frame.spacing_m, std::vector<float>(columns * rows)};
  const std::size_t strips = (rows + kRowsAtOnce - 1) / kRowsAtOnce;
  std::mutex mutex;
  std::size_t done = 0;
  base::parallel_for(strips, threads, [&](std::size_t strip) {
    MapGround ground;
    paging::PlaceCursor cursor(surface);
    const std::size_t end = std::min(rows, (strip + 1) * kRowsAtOnce);
    for (std::size_t row = strip * kRowsAtOnce; row < end; ++row) {
      for (std::size_t column = 0; column < columns; ++column) {
        const glm::dvec2 at(static_cast<double>(column), static_cast<double>(row));
        const paging::SurfacePoint& point = cursor.move_to(frame.map.to_direction(frame.to_map(at)));
        grid.heights.heights_m[row * columns + column] =
            point.nodata ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(point.height_m);
        ++ground.pixels;
        ground.nodata += point.nodata ? 1 : 0;
        const double spacing_m = lod::post_spacing_m(point.tile.level, meta.tile.intervals(), meta.radius_m);
        ground.finest_spacing_m = std::min(ground.finest_spacing_m, spacing_m);
        ground.coarsest_spacing_m = std::max(ground.coarsest_spacing_m, spacing_m);
        const std::optional<int> source = cursor.source();
        if (!source) continue;
        ground.sources.insert(*source);
        ground.synthetic += meta.sources.at(static_cast<std::size_t>(*source)).illustration ? 1 : 0;
        const auto resampling = cursor.resampling(*source);
        if (resampling.error.posts > 0)
          ground.error_max_m = std::max(ground.error_max_m, double{resampling.error.max_m});
      }
    }
    const std::lock_guard lock(mutex);
    grid.ground.add(ground);
    ++done;
    if (progress) progress(static_cast<double>(done) / static_cast<double>(strips));
  });
  return grid;
}

std::vector<glm::dvec2> places_of_line(const GridFrame& frame, std::span<const glm::dvec2> line, bool is_closed,
                                       double tolerance_m) {
  std::vector<glm::dvec2> places;
  if (line.empty()) return places;
  places.push_back(lon_lat_degrees(frame, line[0]));
  for (std::size_t n = 0; n + (is_closed ? 0 : 1) < line.size(); ++n)
    add_places(frame, line[n], line[(n + 1) % line.size()], tolerance_m, 0, places);
  if (is_closed) {
    const double turns = std::round((places.back().x - places.front().x) / 360);
    places.back() = {places.front().x + 360 * turns, places.front().y};
  }
  return places;
}

}  // namespace vpe::map
