#include "vpe/app/report/report_error_time_images.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vpe::app {

namespace {

constexpr double kLowest_deg = -25;
constexpr double kHighest_deg = 15;
constexpr int kStripRows = 720;

// Facets reach as high in their corners as the cylinder does everywhere.
panorama::PanoramaMap plan(std::int64_t columns, int facets) {
  panorama::PlanOptions options;
  options.kind = facets > 0 ? panorama::MapKind::kFacets : panorama::MapKind::kCylinder;
  options.width_px = columns;
  if (facets > 0) options.facets = facets;
  const double off_axis_magnification = facets > 0 ? std::cos(mars::kPi / facets) : 1.0;
  const auto stretched = [&](double elevation_deg) {
    return std::atan(std::tan(elevation_deg * mars::kRadiansPerDegree) / off_axis_magnification) /
           mars::kRadiansPerDegree;
  };
  options.lowest_deg = stretched(kLowest_deg);
  options.highest_deg = stretched(kHighest_deg);
  return panorama::plan_panorama(options).map;
}

std::vector<panorama::Piece> pieces_of(const panorama::PanoramaMap& map, const panorama::PoseOnSphere& stand) {
  std::vector<panorama::Piece> all;
  for (const panorama::Strip& strip : panorama::strips_of(map)) {
    const std::vector<panorama::Piece> pieces = panorama::pieces_of(map, stand, strip, 0);
    all.insert(all.end(), pieces.begin(), pieces.end());
  }
  return all;
}

core::Frame blank(const glm::ivec2& size) {
  core::Frame frame;
  frame.width = size.x;
  frame.height = size.y;
  const std::size_t pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  frame.colour.resize(pixels);
  return frame;
}

// Ranges too where the frames have them.
core::Frame mosaic(const panorama::PanoramaMap& map, const std::vector<core::Frame>& frames) {
  core::Frame whole = blank({static_cast<int>(map.width_px), static_cast<int>(map.height_px)});
  const std::vector<panorama::Piece> pieces = pieces_of(map, {});
  if (pieces.size() != frames.size()) throw std::invalid_argument("mosaic: other pieces than were drawn");
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

}  // namespace

std::vector<core::DrawRequest> enlarged(const core::DrawRequest& request, int times) {
  core::DrawRequest large = request;
  large.view.width *= times;
  large.view.height *= times;
  if (large.view.height <= kStripRows) return {large};
  std::vector<core::DrawRequest> strips;
  const int rows = kStripRows / times * times;
  for (int y = 0; y < large.view.height; y += rows) {
    strips.push_back(large);
    strips.back().view.part = {0, y, large.view.width, std::min(rows, large.view.height - y)};
  }
  return strips;
}

report::Compose average(const core::View& view, int times) {
  return [size = glm::ivec2(view.width, view.height), times](std::vector<core::Frame> frames) {
    core::Frame small = blank(size);
    const int count = times * times;
    int top = 0;
    for (const core::Frame& frame : frames) {
      for (int y = 0; y < frame.height / times; ++y) {
        for (int x = 0; x < size.x; ++x) {
          int red = count / 2, green = count / 2, blue = count / 2;
          for (int j = 0; j < times; ++j) {
            const auto row = static_cast<std::size_t>(y * times + j) * static_cast<std::size_t>(frame.width);
            for (int i = 0; i < times; ++i) {
              const base::Rgb& c = frame.colour[row + static_cast<std::size_t>(x * times + i)];
              red += c.r;
              green += c.g;
              blue += c.b;
            }
          }
          const auto mean = [&](int sum) { return static_cast<std::uint8_t>(sum / count); };
          small.colour[static_cast<std::size_t>(top + y) * static_cast<std::size_t>(size.x) +
                       static_cast<std::size_t>(x)] = {mean(red), mean(green), mean(blue)};
        }
      }
      top += frame.height / times;
    }
    return small;
  };
}

core::DrawRequest reduced(const core::DrawRequest& request, int times) {
  core::DrawRequest small = request;
  core::View& view = small.view;
  view.width = (view.width + times - 1) / times;
  view.height = (view.height + times - 1) / times;
  const double focal_px = core::focal_px(request.view) / times;
  view.fov_deg = 2 * std::atan(0.5 * view.height / focal_px) / mars::kRadiansPerDegree;
  return small;
}

report::Compose off_axis_magnification(const core::View& view, int times) {
  return [size = glm::ivec2(view.width, view.height), times](std::vector<core::Frame> frames) {
    const core::Frame& small = frames.at(0);
    core::Frame large = blank(size);
    // Both images' middles are one place.
    const auto place = [times](int k, int large_side, int small_side) {
      return std::clamp(0.5 * (small_side - 1) + (k + 0.5 - 0.5 * large_side) / times, 0.0, small_side - 1.0);
    };
    const auto pixel = [&small](int x, int y) {
      const base::Rgb& c = small.colour[static_cast<std::size_t>(y) * static_cast<std::size_t>(small.width) +
                                        static_cast<std::size_t>(x)];
      return glm::dvec3(c.r, c.g, c.b);
    };
    for (int y = 0; y < size.y; ++y) {
      const double row = place(y, size.y, small.height);
      const int top = static_cast<int>(row);
      const int below = std::min(top + 1, small.height - 1);
      for (int x = 0; x < size.x; ++x) {
        const double column = place(x, size.x, small.width);
        const int left = static_cast<int>(column);
        const int right = std::min(left + 1, small.width - 1);
        const glm::dvec3 colour =
            glm::mix(glm::mix(pixel(left, top), pixel(right, top), column - left),
                     glm::mix(pixel(left, below), pixel(right, below), column - left), row - top);
        large.colour[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) +
                     static_cast<std::size_t>(x)] = {static_cast<std::uint8_t>(colour.r + 0.5),
                                                     static_cast<std::uint8_t>(colour.g + 0.5),
                                                     static_cast<std::uint8_t>(colour.b + 0.5)};
      }
    }
    return large;
  };
}

panorama::PanoramaMap cylinder_of(std::int64_t columns) { return plan(columns, 0); }

panorama::PanoramaMap facets_of(int facets, std::int64_t columns) { return plan(columns, facets); }

std::vector<core::DrawRequest> requests_of(const panorama::PanoramaMap& map, const Standing& standing) {
  std::vector<core::DrawRequest> requests;
  for (const panorama::Piece& piece : pieces_of(map, {standing.pose, standing.radius_m})) {
    requests.push_back(standing.request);
    requests.back().view = piece.view;
  }
  return requests;
}

report::Compose resample(const panorama::PanoramaMap& map, const panorama::PanoramaMap& onto) {
  return [map, onto](std::vector<core::Frame> frames) {
    const core::Frame drawn = mosaic(map, frames);
    core::Frame looked_up = blank({static_cast<int>(onto.width_px), static_cast<int>(onto.height_px)});
    const bool ranges = !drawn.range_m.empty();
    if (ranges) looked_up.range_m.resize(looked_up.colour.size());
    for (std::int64_t y = 0; y < onto.height_px; ++y) {
      for (std::int64_t x = 0; x < onto.width_px; ++x) {
        const glm::dvec2 place =
            map.place(onto.to_direction(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5));
        const auto column =
            std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(place.x)), 0, map.width_px - 1);
        const auto row =
            std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(place.y)), 0, map.height_px - 1);
        const auto from = static_cast<std::size_t>(row * map.width_px + column);
        const auto to = static_cast<std::size_t>(y * onto.width_px + x);
        looked_up.colour[to] = drawn.colour[from];
        if (ranges) looked_up.range_m[to] = drawn.range_m[from];
      }
    }
    return looked_up;
  };
}

}  // namespace vpe::app
