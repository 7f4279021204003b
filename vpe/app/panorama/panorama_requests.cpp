#include "vpe/app/panorama/panorama_requests.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/vector_int2_sized.hpp>
#include <stdexcept>

#include "vpe/report/resampling.h"

namespace vpe::app {

namespace {

constexpr double kLowest_deg = -25;
constexpr double kHighest_deg = 15;

// Plans a full circle whose facets reach as high in their corners as the cylinder does everywhere.
panorama::PanoramaMap plan(std::int64_t columns, int facets) {
  panorama::PlanOptions options;
  options.kind = facets > 0 ? panorama::MapKind::kFacets : panorama::MapKind::kCylinder;
  options.width_px = columns;
  if (facets > 0) options.facets = facets;
  const double corner = facets > 0 ? std::cos(mars::kPi / facets) : 1.0;
  const auto in_middle_deg = [&](double elevation_deg) {
    return std::atan(std::tan(elevation_deg * mars::kRadiansPerDegree) / corner) / mars::kRadiansPerDegree;
  };
  options.lowest_deg = in_middle_deg(kLowest_deg);
  options.highest_deg = in_middle_deg(kHighest_deg);
  return panorama::plan_panorama(options).map;
}

std::vector<panorama::Piece> pieces_of(const panorama::PanoramaMap& map, const panorama::Viewpoint& viewpoint) {
  std::vector<panorama::Piece> all;
  for (const panorama::Strip& strip : panorama::strips_of(map)) {
    const std::vector<panorama::Piece> pieces = panorama::pieces_of(map, viewpoint, strip, 0);
    all.insert(all.end(), pieces.begin(), pieces.end());
  }
  return all;
}

// Returns the pixel of `map` in the direction of each pixel of `onto`, row by row.
std::vector<glm::i64vec2> nearest_pixels(const panorama::PanoramaMap& map, const panorama::PanoramaMap& onto) {
  std::vector<glm::i64vec2> nearest;
  nearest.reserve(static_cast<std::size_t>(onto.width_px * onto.height_px));
  for (std::int64_t y = 0; y < onto.height_px; ++y) {
    for (std::int64_t x = 0; x < onto.width_px; ++x) {
      const glm::dvec2 place =
          map.place(onto.to_direction(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5));
      nearest.emplace_back(
          std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(place.x)), 0, map.width_px - 1),
          std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(place.y)), 0, map.height_px - 1));
    }
  }
  return nearest;
}

}  // namespace

panorama::PanoramaMap cylinder_of(std::int64_t columns) { return plan(columns, 0); }

panorama::PanoramaMap facets_of(int facets, std::int64_t columns) { return plan(columns, facets); }

std::vector<core::DrawRequest> requests_of(const panorama::PanoramaMap& map, const PanoramaView& view) {
  std::vector<core::DrawRequest> requests;
  for (const panorama::Piece& piece : pieces_of(map, panorama::viewpoint_of(view.pose, view.radius_m))) {
    requests.push_back(view.request);
    requests.back().view = piece.view;
  }
  return requests;
}

core::Frame mosaic(const panorama::PanoramaMap& map, const std::vector<core::Frame>& frames) {
  core::Frame whole = report::blank_frame({static_cast<int>(map.width_px), static_cast<int>(map.height_px)});
  const std::vector<panorama::Piece> pieces = pieces_of(map, {});
  if (pieces.size() != frames.size())
    throw std::invalid_argument("mosaic: the pieces differ from those that were drawn");
  const bool ranges = !frames.front().range_m.empty();
  if (ranges) whole.range_m.resize(whole.colour.size());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const panorama::Piece& piece = pieces[k];
    for (int y = 0; y < piece.height; ++y) {
      const auto from = static_cast<std::ptrdiff_t>(y) * piece.width;
      const auto to = static_cast<std::ptrdiff_t>((piece.y + y) * map.width_px + piece.x);
      std::copy_n(frames[k].colour.begin() + from, piece.width, whole.colour.begin() + to);
      if (ranges) std::copy_n(frames[k].range_m.begin() + from, piece.width, whole.range_m.begin() + to);
    }
  }
  return whole;
}

report::Compose resample(const panorama::PanoramaMap& map, const panorama::PanoramaMap& onto) {
  return [map, onto](std::size_t count, const report::NextFrame& next) {
    const std::vector<panorama::Piece> pieces = pieces_of(map, {});
    if (pieces.size() != count)
      throw std::invalid_argument("resample: the pieces differ from those that were drawn");
    const std::vector<glm::i64vec2> sources = nearest_pixels(map, onto);
    core::Frame resampled =
        report::blank_frame({static_cast<int>(onto.width_px), static_cast<int>(onto.height_px)});
    for (const panorama::Piece& piece : pieces) {
      const core::Frame drawn = next();
      const bool ranges = !drawn.range_m.empty();
      if (ranges) resampled.range_m.resize(resampled.colour.size());
      for (std::size_t to = 0; to < sources.size(); ++to) {
        const std::int64_t x = sources[to].x - piece.x;
        const std::int64_t y = sources[to].y - piece.y;
        if (x < 0 || x >= piece.width || y < 0 || y >= piece.height) continue;
        const auto from = static_cast<std::size_t>(y * piece.width + x);
        resampled.colour[to] = drawn.colour[from];
        if (ranges) resampled.range_m[to] = drawn.range_m[from];
      }
    }
    return resampled;
  };
}

}  // namespace vpe::app
