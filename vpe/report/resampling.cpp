#include "vpe/report/resampling.h"

#include <algorithm>
#include <cmath>

#include "mars/geodesy/sphere.h"

namespace vpe::report {

core::Frame blank_frame(const glm::ivec2& size) {
  core::Frame frame;
  frame.width = size.x;
  frame.height = size.y;
  const std::size_t pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  frame.colour.resize(pixels);
  return frame;
}

std::vector<core::DrawRequest> enlarged(const core::DrawRequest& request, int factor) {
  core::DrawRequest large = request;
  large.view.width *= factor;
  large.view.height *= factor;
  const int most = std::min(kMostStripRows, kMostStripPixels / large.view.width);
  const int rows = std::max(1, most / factor) * factor;
  if (large.view.height <= rows) return {large};
  std::vector<core::DrawRequest> strips;
  for (int y = 0; y < large.view.height; y += rows) {
    strips.push_back(large);
    strips.back().view.part = {0, y, large.view.width, std::min(rows, large.view.height - y)};
  }
  return strips;
}

Compose average(const core::View& view, int factor) {
  return [size = glm::ivec2(view.width, view.height), factor](std::size_t strips, const NextFrame& next) {
    core::Frame small = blank_frame(size);
    const int count = factor * factor;
    int top = 0;
    for (std::size_t k = 0; k < strips; ++k) {
      const core::Frame frame = next();
      for (int y = 0; y < frame.height / factor; ++y) {
        for (int x = 0; x < size.x; ++x) {
          int red = count / 2, green = count / 2, blue = count / 2;
          for (int j = 0; j < factor; ++j) {
            const auto row = static_cast<std::size_t>(y * factor + j) * static_cast<std::size_t>(frame.width);
            for (int i = 0; i < factor; ++i) {
              const base::Rgb& c = frame.colour[row + static_cast<std::size_t>(x * factor + i)];
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
      top += frame.height / factor;
    }
    return small;
  };
}

core::DrawRequest reduced(const core::DrawRequest& request, int factor) {
  core::DrawRequest small = request;
  core::View& view = small.view;
  view.width = (view.width + factor - 1) / factor;
  view.height = (view.height + factor - 1) / factor;
  const double focal_px = core::focal_px(request.view) / factor;
  view.fov_deg = 2 * std::atan(0.5 * view.height / focal_px) / mars::kRadiansPerDegree;
  return small;
}

Compose magnified(const core::View& view, int factor) {
  return [size = glm::ivec2(view.width, view.height), factor](std::size_t, const NextFrame& next) {
    const core::Frame small = next();
    core::Frame large = blank_frame(size);
    // The middles of both images coincide.
    const auto place = [factor](int k, int large_side, int small_side) {
      return std::clamp(0.5 * (small_side - 1) + (k + 0.5 - 0.5 * large_side) / factor, 0.0, small_side - 1.0);
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

}  // namespace vpe::report
