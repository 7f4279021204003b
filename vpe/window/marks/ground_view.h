// The ground as a view shows it: where places are seen, and whether nearer ground hides them.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>

#include "vpe/core/view.h"
#include "vpe/explore/session.h"

namespace vpe::window {

// Describes the image of an eye in the window: its view, and where its upper left corner is.
struct EyeImage {
  core::View view;
  double x0 = 0;  // framebuffer pixels
  double y0 = 0;
};

// Refers to a session, and copies the view.
class GroundView {
 public:
  GroundView(const explore::Session& session, const core::View& view) : session_(session), view_(view) {}

  const core::View& view() const { return view_; }
  double radius_m() const { return session_.ground().radius_m; }
  // Returns the point of the ground as drawn.
  glm::dvec3 on_ground(const glm::dvec3& direction) const {
    return direction * (session_.ground().radius_m + session_.ground().height_m(direction));
  }
  // Tests a point about two pixels above the ground, so that its own facet does not hide it. Casts a ray.
  bool is_hidden(const glm::dvec3& point_m) const {
    const glm::dvec3& camera_m = view_.camera.position_m;
    const double lift_m = std::max(0.5, 2 * glm::length(point_m - camera_m) / core::focal_px(view_));
    const glm::dvec3 path = point_m * (1 + lift_m / glm::length(point_m)) - camera_m;
    const double distance_m = glm::length(path);
    return session_.ground().cast_m(camera_m, path / distance_m) < distance_m * (1 - 1e-9);
  }
  core::Projected seen(const glm::dvec3& point_m) const { return core::project(view_, point_m); }
  bool is_in_view(const core::Projected& p) const {
    return !p.behind && p.xy.x >= 0 && p.xy.y >= 0 && p.xy.x <= view_.width && p.xy.y <= view_.height;
  }

 private:
  const explore::Session& session_;
  core::View view_;
};

}  // namespace vpe::window
