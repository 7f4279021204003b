#include "vpe/overlay/draped_lines.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "mars/geodesy/sphere.h"
#include "vpe/overlay/features/image_sight.h"

namespace vpe::overlay {
namespace {

// Limits of the elevation on any planet, so that lines out of sight are left out early.
constexpr double kHighestGround_m = 30e3;
constexpr double kLowestGround_m = -12e3;
constexpr double kLongestStep_px = 1;
constexpr double kLongestGap_px = 3;  // wider ones, as at a nadir, are not bridged
constexpr int kMostHalvings = 26;
// The middle of an edge is that of its ends' directions where that is so near to the middle in degrees.
constexpr double kBend_px = 0.005;
constexpr double kShortArc_rad = 0.02;

// Equals mars::direction() but for rounding: within 1e-15 for places of vector files.
glm::dvec3 direction_of(glm::dvec2 place_deg) {
  const glm::dvec2 place = place_deg * mars::kRadiansPerDegree;
  const double level = std::cos(place.y);
  return {level * std::cos(place.x), level * std::sin(place.x), std::sin(place.y)};
}

// Follows lines and collects the run that is open.
class LineWalk {
 public:
  LineWalk(const GroundFeatures& features, const GroundSight& sight,
           const std::function<void(const DrapedRun&)>& draw)
      : features_(features), draw_(draw), sight_(sight), frame_(sight.frame()) {
    const double lowest_m = frame_.radius_m + kLowestGround_m * frame_.exaggeration;
    const auto reach = [lowest_m](double radius_m) { return std::acos(std::min(1.0, lowest_m / radius_m)); };
    const double camera_m = glm::length(frame_.camera_m);
    horizon_rad_ = lowest_m > 0
                       ? reach(camera_m) + reach(frame_.radius_m + kHighestGround_m * frame_.exaggeration)
                       : mars::kPi;
  }

  void follow(const GroundFeatures::Piece& piece) {
    if (piece.begins || piece.feature != run_.feature) end_run();
    run_.feature = piece.feature;
    style_ = &features_.style(piece.feature);
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
    glm::dvec3 up;
    glm::dvec3 point_m;
    std::optional<glm::dvec2> at;
  };

  Place place(glm::dvec2 place_deg) const { return place(place_deg, direction_of(place_deg)); }
  Place place(glm::dvec2 place_deg, const glm::dvec3& up) const {
    const glm::dvec3 point_m = up * (frame_.radius_m + sight_.height_m(up) * frame_.exaggeration);
    return {place_deg, up, point_m, sight_.to_image(point_m)};
  }

  // Returns the place in the middle of an edge in degrees. That of the ends' directions is off it by less than a quarter of the
  // arc's square, radians, for short arcs anywhere.
  Place middle(const Place& from, const Place& to, double arc_m, double nearest_m) const {
    const glm::dvec2 place_deg = 0.5 * (from.place_deg + to.place_deg);
    const bool is_straight =
        arc_m <= kShortArc_rad * frame_.radius_m &&
        0.25 * arc_m * arc_m * frame_.scale.focal_px <= kBend_px * frame_.radius_m * nearest_m;
    return is_straight ? place(place_deg, glm::normalize(from.up + to.up)) : place(place_deg);
  }

  // Returns whether ground within a cap can be before the horizon and in the image.
  bool may_be_seen(const glm::dvec3& centre, double radius_rad) const {
    if (mars::angle_between_rad(centre, frame_.camera_m) > horizon_rad_ + radius_rad) return false;
    if (radius_rad > 1) return true;
    const double low_m = frame_.radius_m + kLowestGround_m * frame_.exaggeration;
    const double high_m = frame_.radius_m + kHighestGround_m * frame_.exaggeration;
    return may_show(centre * (0.5 * (low_m + high_m)), 0.5 * (high_m - low_m) + high_m * radius_rad);
  }

  bool may_show(const glm::dvec3& centre_m, double radius_m) const {
    const double distance_m = glm::length(centre_m - frame_.camera_m);
    return frame_.scale.may_show(*style_, distance_m - radius_m, distance_m + radius_m) &&
           sight_.may_show(centre_m, radius_m);
  }

  // Returns the position nearest to another one among those that an image that repeats has.
  glm::dvec2 beside(glm::dvec2 at, glm::dvec2 near) const {
    if (frame_.turn_px > 0) at.x += frame_.turn_px * std::round((near.x - at.x) / frame_.turn_px);
    return at;
  }

  void follow(const Place& from, const Place& to, int halvings) {
    // Ground between two places is within this sphere unless it rises by more than the distance between them.
    const double apart_m = glm::length(to.point_m - from.point_m);
    const double arc_m =
        frame_.radius_m * mars::kRadiansPerDegree *
        (std::abs(to.place_deg.x - from.place_deg.x) + std::abs(to.place_deg.y - from.place_deg.y));
    const double radius_m =
        std::max(apart_m, 0.5 * arc_m) + std::min(arc_m, kHighestGround_m * frame_.exaggeration);
    const glm::dvec3 middle_m = 0.5 * (from.point_m + to.point_m);
    if (!may_show(middle_m, radius_m)) {
      end_run();
      add(to);
      return;
    }
    const bool is_short =
        from.at && to.at && glm::length(beside(*to.at, *from.at) - *from.at) <= kLongestStep_px;
    const double distance_m = glm::length(middle_m - frame_.camera_m);
    // Both ends may be at one pixel while what lies between is not.
    const bool is_small = radius_m * frame_.scale.focal_px <= 4 * kLongestStep_px * distance_m;
    if ((is_short && is_small) || halvings >= kMostHalvings) {
      add(to);
      return;
    }
    const Place between = middle(from, to, arc_m, distance_m - radius_m);
    follow(from, between, halvings + 1);
    follow(between, to, halvings + 1);
  }

  void add(const Place& place) {
    if (!place.at) {
      end_run();
      return;
    }
    const double distance_m = glm::length(place.point_m - frame_.camera_m);
    const bool is_open = !run_.points_px.empty();
    const glm::dvec2 at = is_open ? beside(*place.at, run_.points_px.back()) : *place.at;
    if (!is_near_image(*place.at) || !frame_.scale.shows(*style_, distance_m)) {
      end_run();
      return;
    }
    const bool hidden = sight_.is_hidden(*place.at, place.point_m, distance_m);
    if (is_open && glm::length(at - run_.points_px.back()) > kLongestGap_px) end_run();
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
    if (!run_.points_px.empty() && glm::length(at - run_.points_px.back()) < kShortestStep_px) return;
    run_.points_px.push_back(at);
    run_.distance_m += distance_m;
    // Width and dashes follow the distance.
    constexpr std::size_t kMostPoints = 256;
    if (run_.points_px.size() >= kMostPoints) {
      end_run();
      run_.points_px.push_back(at);
      run_.distance_m = distance_m;
    }
  }

  bool is_near_image(glm::dvec2 at) const {
    if (at.y < -kLineMargin_px || at.y > frame_.size_px.y + kLineMargin_px) return false;
    const double middle_px = 0.5 * frame_.size_px.x;
    const double beside_px =
        std::abs(frame_.turn_px > 0 ? std::remainder(at.x - middle_px, frame_.turn_px) : at.x - middle_px);
    return beside_px <= middle_px + kLineMargin_px;
  }

  const GroundFeatures& features_;
  const std::function<void(const DrapedRun&)>& draw_;
  const GroundSight& sight_;
  const GroundSight::Frame& frame_;
  const mars::FeatureStyle* style_ = nullptr;
  double horizon_rad_ = 0;
  DrapedRun run_;
};

}  // namespace

void drape_lines(const GroundFeatures& features, std::size_t begin, std::size_t end, const GroundSight& sight,
                 const std::function<void(const DrapedRun&)>& draw) {
  LineWalk walk(features, sight, draw);
  for (const GroundFeatures::Piece& piece : std::span(features.pieces()).subspan(begin, end - begin))
    walk.follow(piece);
  walk.end_run();
}

void drape_lines(const GroundFeatures& features, const GroundSight& sight,
                 const std::function<void(const DrapedRun&)>& draw) {
  drape_lines(features, 0, features.pieces().size(), sight, draw);
}

void drape_lines(const GroundFeatures& features, const VisibleTerrain& terrain,
                 const std::function<void(const DrapedRun&)>& draw) {
  drape_lines(features, ImageSight(terrain), draw);
}

std::optional<DrapedPlace> drape(const GroundSight& sight, glm::dvec2 place_deg) {
  const GroundSight::Frame& frame = sight.frame();
  const glm::dvec3 up = direction_of(place_deg);
  const glm::dvec3 point_m = up * (frame.radius_m + sight.height_m(up) * frame.exaggeration);
  const auto at = sight.to_image(point_m);
  if (!at) return std::nullopt;
  const double distance_m = glm::length(point_m - frame.camera_m);
  return DrapedPlace{*at, distance_m, sight.is_hidden(*at, point_m, distance_m)};
}

std::optional<DrapedPlace> drape(const VisibleTerrain& terrain, glm::dvec2 place_deg) {
  return drape(ImageSight(terrain), place_deg);
}

}  // namespace vpe::overlay
