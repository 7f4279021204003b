#include "vpe/overlay/draped_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "vpe/core/view.h"

namespace vpe::overlay {
namespace {

// Limits of the elevation on any planet, so that lines out of sight are left out early.
constexpr double kHighestGround_m = 30e3;
constexpr double kLowestGround_m = -12e3;
constexpr double kMargin_px = 8;  // beside the image, for wide lines
constexpr double kLongestStep_px = 1;
constexpr int kMostHalvings = 26;

glm::dvec3 direction_of(glm::dvec2 place_deg) { return mars::direction({place_deg.x, place_deg.y}); }

bool is_hidden_at(const VisibleTerrain& terrain, glm::dvec2 at, double distance_m) {
  const auto x = static_cast<int>(std::floor(at.x));
  const auto y = static_cast<int>(std::floor(at.y));
  for (int j = std::max(0, y - 1); j <= std::min(terrain.height() - 1, y + 1); ++j) {
    for (int i = std::max(0, x - 1); i <= std::min(terrain.width() - 1, x + 1); ++i) {
      const std::size_t p = terrain.index(i, j);
      if (!terrain.is_ground(p)) continue;
      const double reach_m =
          static_cast<double>(terrain.scene().range_m[p]) + terrain.noise_m(p) + terrain.deviation_m(p);
      if (distance_m <= reach_m + kHiddenLineShare * distance_m) return false;
    }
  }
  return true;
}

// The pyramid of a perspective view, with a margin; of other views all of space.
class ViewPyramid {
 public:
  explicit ViewPyramid(const core::View& view)
      : camera_m_(view.camera.position_m), is_open_(view.projection != core::Projection::kPerspective) {
    if (is_open_) return;
    const core::SubRectangle part = core::drawn_part(view);
    const mars::Axes& axes = view.camera.axes;
    const double focal = core::focal_px(view);
    const glm::dvec2 principal = 0.5 * glm::dvec2(view.width, view.height) + view.principal_offset_px;
    const glm::dvec2 low = glm::dvec2(part.x, part.y) - principal - kMargin_px;
    const glm::dvec2 high = glm::dvec2(part.x + part.width, part.y + part.height) - principal + kMargin_px;
    const auto plane = [&](const glm::dvec3& side, double edge) {
      return glm::normalize(side * focal - axes.forward * edge);
    };
    inward_ = {plane(axes.right, low.x), -plane(axes.right, high.x), plane(-axes.up, low.y),
               -plane(-axes.up, high.y)};
  }
  bool may_hold(const glm::dvec3& centre_m, double radius_m) const {
    if (is_open_) return true;
    return std::ranges::all_of(
        inward_, [&](const glm::dvec3& n) { return glm::dot(n, centre_m - camera_m_) > -radius_m; });
  }

 private:
  glm::dvec3 camera_m_;
  bool is_open_;
  std::array<glm::dvec3, 4> inward_{};
};

// Follows lines and collects the run that is open.
class LineWalk {
 public:
  LineWalk(const VisibleTerrain& terrain, const std::function<void(const DrapedRun&)>& draw)
      : terrain_(terrain),
        draw_(draw),
        scene_(terrain.scene()),
        pyramid_(scene_.view),
        exaggeration_(scene_.appearance.exaggeration) {
    const double lowest_m = scene_.radius_m + kLowestGround_m * exaggeration_;
    const auto reach = [lowest_m](double radius_m) { return std::acos(std::min(1.0, lowest_m / radius_m)); };
    const double camera_m = glm::length(scene_.view.camera.position_m);
    horizon_rad_ =
        lowest_m > 0 ? reach(camera_m) + reach(scene_.radius_m + kHighestGround_m * exaggeration_) : mars::kPi;
  }

  void follow(const GroundFeatures::Piece& piece) {
    if (piece.begins || piece.feature != run_.feature) end_run();
    run_.feature = piece.feature;
    if (!may_be_seen(piece.centre, piece.radius_rad)) {
      end_run();
      return;
    }
    Place from = place(piece.places[0]);
    add(from);
    for (std::size_t i = 1; i < piece.places.size(); ++i) {
      const Place to = place(piece.places[i]);
      follow(from, to, 0);
      from = to;
    }
  }

  void end_run() {
    if (run_.points_px.size() > 1) {
      run_.distance_m /= static_cast<double>(run_.points_px.size());
      draw_(run_);
    }
    run_.points_px.clear();
    run_.distance_m = 0;
  }

 private:
  struct Place {
    glm::dvec2 place_deg;
    glm::dvec3 point_m;
    std::optional<glm::dvec2> at;
  };

  Place place(glm::dvec2 place_deg) const {
    const glm::dvec3 up = direction_of(place_deg);
    const glm::dvec3 point_m = up * (scene_.radius_m + scene_.ground_m(up) * exaggeration_);
    return {place_deg, point_m, terrain_.to_image(point_m)};
  }

  // Returns whether ground within a cap can be before the horizon and in the image.
  bool may_be_seen(const glm::dvec3& centre, double radius_rad) const {
    if (mars::angle_between_rad(centre, scene_.view.camera.position_m) > horizon_rad_ + radius_rad)
      return false;
    if (radius_rad > 1) return true;
    const double low_m = scene_.radius_m + kLowestGround_m * exaggeration_;
    const double high_m = scene_.radius_m + kHighestGround_m * exaggeration_;
    return pyramid_.may_hold(centre * (0.5 * (low_m + high_m)), 0.5 * (high_m - low_m) + high_m * radius_rad);
  }

  void follow(const Place& from, const Place& to, int halvings) {
    // Ground between two places is within this sphere unless it rises by more than the distance between them.
    const double apart_m = glm::length(to.point_m - from.point_m);
    const double arc_m =
        scene_.radius_m * mars::kRadiansPerDegree *
        (std::abs(to.place_deg.x - from.place_deg.x) + std::abs(to.place_deg.y - from.place_deg.y));
    const double radius_m = std::max(apart_m, 0.5 * arc_m) + std::min(arc_m, kHighestGround_m * exaggeration_);
    const glm::dvec3 middle_m = 0.5 * (from.point_m + to.point_m);
    if (!pyramid_.may_hold(middle_m, radius_m)) {
      end_run();
      add(to);
      return;
    }
    const bool is_short = from.at && to.at && glm::length(*to.at - *from.at) <= kLongestStep_px;
    const double distance_m = glm::length(middle_m - scene_.view.camera.position_m);
    // Both ends may be at one pixel while what lies between is not.
    const bool is_small = radius_m * core::focal_px(scene_.view) <= 4 * kLongestStep_px * distance_m;
    if ((is_short && is_small) || halvings >= kMostHalvings) {
      add(to);
      return;
    }
    const Place middle = place(0.5 * (from.place_deg + to.place_deg));
    follow(from, middle, halvings + 1);
    follow(middle, to, halvings + 1);
  }

  void add(const Place& at) {
    if (!at.at || !is_near_image(*at.at)) {
      end_run();
      return;
    }
    const double distance_m = glm::length(at.point_m - scene_.view.camera.position_m);
    const bool hidden = is_hidden_at(terrain_, *at.at, distance_m);
    if (!run_.points_px.empty() && hidden != run_.is_hidden) {
      // The change lies between two places that are a pixel apart: both runs reach it.
      const glm::dvec2 last = run_.points_px.back();
      end_run();
      if (!hidden) run_.points_px.push_back(last);
      run_.distance_m += hidden ? 0 : distance_m;
    }
    run_.is_hidden = hidden;
    // Many vertices may lie on one pixel.
    constexpr double kShortestStep_px = 0.25;
    if (!run_.points_px.empty() && glm::length(*at.at - run_.points_px.back()) < kShortestStep_px) return;
    run_.points_px.push_back(*at.at);
    run_.distance_m += distance_m;
    // Width and dashes follow the distance.
    constexpr std::size_t kMostPoints = 256;
    if (run_.points_px.size() >= kMostPoints) {
      end_run();
      run_.points_px.push_back(*at.at);
      run_.distance_m = distance_m;
    }
  }

  bool is_near_image(glm::dvec2 at) const {
    return at.x >= -kMargin_px && at.y >= -kMargin_px && at.x <= terrain_.width() + kMargin_px &&
           at.y <= terrain_.height() + kMargin_px;
  }

  const VisibleTerrain& terrain_;
  const std::function<void(const DrapedRun&)>& draw_;
  const Scene& scene_;
  ViewPyramid pyramid_;
  double exaggeration_;
  double horizon_rad_ = 0;
  DrapedRun run_;
};

}  // namespace

void drape_lines(const GroundFeatures& features, const VisibleTerrain& terrain,
                 const std::function<void(const DrapedRun&)>& draw) {
  LineWalk walk(terrain, draw);
  for (const GroundFeatures::Piece& piece : features.pieces()) walk.follow(piece);
  walk.end_run();
}

std::optional<DrapedPlace> drape(const VisibleTerrain& terrain, glm::dvec2 place_deg) {
  const Scene& scene = terrain.scene();
  const glm::dvec3 up = direction_of(place_deg);
  const glm::dvec3 point_m = up * (scene.radius_m + scene.ground_m(up) * scene.appearance.exaggeration);
  const auto at = terrain.to_image(point_m);
  if (!at) return std::nullopt;
  const double distance_m = glm::length(point_m - scene.view.camera.position_m);
  return DrapedPlace{*at, distance_m, is_hidden_at(terrain, *at, distance_m)};
}

}  // namespace vpe::overlay
