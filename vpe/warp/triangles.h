// Triangles between pixels of the first image, drawn into a band of rows of the new one. Private to vpe/warp.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

#include "vpe/warp/hits.h"

namespace vpe::warp {

// Positions farther than this from the image are as good as it.
inline constexpr float kFar_px = 1e6F;

inline float cross(const glm::vec2& a, const glm::vec2& b) { return a.x * b.y - a.y * b.x; }

// Returns the larger side.
inline float largest(const glm::vec2& v) { return std::max(std::abs(v.x), std::abs(v.y)); }

inline glm::vec2 centre_of(int x, int y) {
  return {static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F};
}

// A corner of a triangle in the new image.
struct Corner {
  glm::vec2 xy{0, 0};
  float inverse_depth = 0;
};

// Returns the shares of the second and the third corner at a point.
inline glm::vec2 shares_at(const glm::vec2& point, const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
  const glm::vec2 ab = b - a;
  const glm::vec2 ac = c - a;
  const glm::vec2 p = point - a;
  return glm::vec2(cross(p, ac), cross(ab, p)) / cross(ab, ac);
}

// Draws triangles; the nearest surface stays.
class TriangleBand {
 public:
  TriangleBand(Hits& hits, int width) : hits_(hits), width_(width) {}

  // Draws a triangle with its corners clockwise in the image. One that turns its back is not drawn: a side that faces
  // the camera lies before it.
  void draw(const Corner& a, const Corner& b, const Corner& c, Half half) {
    const int y0 = std::max(first_centre(std::min(std::min(a.xy.y, b.xy.y), c.xy.y)), hits_.first_row);
    const int y1 = std::min(last_centre(std::max(std::max(a.xy.y, b.xy.y), c.xy.y)), hits_.end_row - 1);
    if (y0 > y1) return;
    const int x0 = std::max(first_centre(std::min(std::min(a.xy.x, b.xy.x), c.xy.x)), 0);
    const int x1 = std::min(last_centre(std::max(std::max(a.xy.x, b.xy.x), c.xy.x)), width_ - 1);
    if (x0 > x1) return;
    const glm::vec2 ab = b.xy - a.xy;
    const glm::vec2 ac = c.xy - a.xy;
    const float area = cross(ab, ac);
    if (!(area > 0)) return;
    const float per_area = 1 / area;
    const float edge = kEdge_px * (largest(ab) + largest(ac)) * per_area;
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const glm::vec2 p = centre_of(x, y) - a.xy;
        const float u = cross(p, ac) * per_area;
        const float v = cross(ab, p) * per_area;
        if (u < -edge || v < -edge || u + v > 1 + edge) continue;
        const float depth = std::max(
            a.inverse_depth + u * (b.inverse_depth - a.inverse_depth) + v * (c.inverse_depth - a.inverse_depth),
            0.0F);
        const std::size_t n = hits_.index(x, y);
        if (!(depth > hits_.inverse_depth[n])) continue;
        hits_.inverse_depth[n] = depth;
        hits_.half[n] = half;
      }
    }
  }

 private:
  // Triangles are wider by this, so that rounding leaves no crack between them.
  static constexpr float kEdge_px = 1.0F / 256;
  static int floor_of(float position) {
    const float clamped = std::clamp(position, -kFar_px, kFar_px);
    const auto cut = static_cast<int>(clamped);
    return cut - (clamped < static_cast<float>(cut) ? 1 : 0);
  }
  static int first_centre(float position) { return floor_of(position + (0.5F - kEdge_px)); }
  static int last_centre(float position) { return floor_of(position - (0.5F - kEdge_px)); }

  Hits& hits_;
  int width_;
};

}  // namespace vpe::warp
