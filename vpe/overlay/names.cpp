// Names of places.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <optional>

#include "vpe/overlay/layer_functions.h"
#include "vpe/overlay/number_format.h"

namespace vpe::overlay {

namespace {

// Limits of the elevation on any planet, to discard invisible places early.
constexpr double kHighest_m = 30e3;
constexpr double kLowest_m = -12e3;
constexpr std::size_t kMostNames = 100;
constexpr double kSmallest_px = 4;  // diameters at 720 rows

// A point of a place in the image.
struct Spot {
  glm::dvec2 at;
  double distance_m;
};

// Returns true if a point within `reach_rad` of a place could be above the horizon of a sphere below all terrain.
bool may_be_seen(const VisibleTerrain& terrain, const glm::dvec3& up, double reach_rad) {
  const Scene& scene = terrain.scene();
  const double exaggeration = scene.appearance.exaggeration;
  const double lowest = scene.radius_m + kLowest_m * exaggeration;
  if (lowest <= 0) return true;
  const glm::dvec3& camera = scene.view.camera.position_m;
  const auto reach = [lowest](double radius_m) { return std::acos(std::min(1.0, lowest / radius_m)); };
  const double most = reach(glm::length(camera)) + reach(scene.radius_m + kHighest_m * exaggeration);
  return mars::angle_between_rad(up, camera) <= most + reach_rad;
}

// Returns true if the vertical between the lowest and highest possible elevation comes near the image.
bool may_be_inside(const VisibleTerrain& terrain, const glm::dvec3& up) {
  const Scene& scene = terrain.scene();
  const double exaggeration = scene.appearance.exaggeration;
  const auto low = terrain.to_image(up * (scene.radius_m + kLowest_m * exaggeration));
  const auto high = terrain.to_image(up * (scene.radius_m + kHighest_m * exaggeration));
  if (!low || !high || scene.view.projection != core::Projection::kPerspective) return true;
  const glm::dvec2 least = glm::min(*low, *high);
  const glm::dvec2 most = glm::max(*low, *high);
  return most.x >= 0 && most.y >= 0 && least.x <= terrain.width() && least.y <= terrain.height();
}

bool is_hidden(const VisibleTerrain& terrain, glm::dvec2 at, double distance_m) {
  const auto x = static_cast<int>(at.x);
  const auto y = static_cast<int>(at.y);
  for (int j = std::max(0, y - 1); j <= std::min(terrain.height() - 1, y + 1); ++j) {
    for (int i = std::max(0, x - 1); i <= std::min(terrain.width() - 1, x + 1); ++i) {
      const std::size_t p = terrain.index(i, j);
      if (terrain.is_ground(p) && terrain.scene().range_m[p] >= (1 - kHiddenShare) * distance_m) return false;
    }
  }
  return true;
}

// Returns where the image shows the ground in a direction, or nullopt if it does not.
std::optional<Spot> visible_spot(const VisibleTerrain& terrain, const glm::dvec3& up,
                                 const std::function<double()>& height_m) {
  if (!may_be_inside(terrain, up)) return std::nullopt;
  const Scene& scene = terrain.scene();
  const glm::dvec3 point_m = up * (scene.radius_m + height_m() * scene.appearance.exaggeration);
  const std::optional<glm::dvec2> at = terrain.to_image(point_m);
  if (!at || at->x < 0 || at->y < 0 || at->x >= terrain.width() || at->y >= terrain.height())
    return std::nullopt;
  const double distance_m = glm::length(point_m - scene.view.camera.position_m);
  if (is_hidden(terrain, *at, distance_m)) return std::nullopt;
  return Spot{*at, distance_m};
}

// Returns where the name of a place stands, or nullopt if nothing of it is seen or it looks smaller than
// `smallest_rad`.
std::optional<Spot> spot_of(const VisibleTerrain& terrain, const core::Place& place, double smallest_rad) {
  const Scene& scene = terrain.scene();
  const glm::dvec3 up = mars::direction({place.lon_deg, place.lat_deg});
  const bool has_extent = place.diameter_m > 0 && scene.ground_m;
  if (!may_be_seen(terrain, up, has_extent ? 0.5 * place.diameter_m / scene.radius_m : 0)) return std::nullopt;
  const auto is_large = [&](const Spot& spot) {
    return place.diameter_m <= 0 || place.diameter_m >= smallest_rad * spot.distance_m;
  };
  const auto centre = visible_spot(terrain, up, [&] { return scene.height_m ? scene.height_m(place) : 0.0; });
  if (centre) return is_large(*centre) ? centre : std::nullopt;
  if (!has_extent) return std::nullopt;
  // Nothing of it is nearer than this.
  const double nearest_m = glm::length(scene.view.camera.position_m - up * scene.radius_m) - place.diameter_m;
  if (place.diameter_m < smallest_rad * nearest_m) return std::nullopt;
  std::optional<Spot> highest;
  for (const glm::dvec3& direction : core::points_within(place, scene.radius_m)) {
    if (!may_be_seen(terrain, direction, 0)) continue;
    const auto spot = visible_spot(terrain, direction, [&] { return scene.ground_m(direction); });
    if (spot && is_large(*spot) && (!highest || spot->at.y < highest->at.y)) highest = spot;
  }
  return highest;
}

}  // namespace

void draw_names(LabelLayout& layout, const VisibleTerrain& terrain, bool distances) {
  const Font font = layout.font(14);
  const double dot_px = layout.line_px(2.4);
  const double smallest_rad = layout.px(kSmallest_px) / core::focal_px(terrain.scene().view);
  std::size_t count = 0;
  for (const core::Place& place : terrain.scene().places) {
    const std::optional<Spot> spot = spot_of(terrain, place, smallest_rad);
    if (!spot) continue;
    const glm::dvec2& at = spot->at;
    const Box dot = Box::about(at, {2 * dot_px, 2 * dot_px});
    const std::string text = distances ? name_text(place.name, spot->distance_m) : place.name;
    const TextSize size = layout.canvas().measure(text, font);
    const double beside = 0.5 * size.width + 2.2 * dot_px;
    const double over = 0.5 * size.height + 1.2 * dot_px;
    const std::array<glm::dvec2, 4> offsets{glm::dvec2{beside, 0}, glm::dvec2{-beside, 0}, glm::dvec2{0, -over},
                                            glm::dvec2{0, over}};
    if (!layout.is_free(dot)) continue;
    const auto offset = std::find_if(offsets.begin(), offsets.end(), [&](const glm::dvec2& o) {
      return layout.is_free(Box::about(at + o, size));
    });
    if (offset == offsets.end()) continue;
    layout.take(dot.grown(layout.px(2)));
    layout.take(Box::about(at + *offset, size).grown(layout.px(4)));
    const auto disc = [&](double radius_px, const Ink& ink) {
      std::vector<glm::dvec2> circle;
      for (int n = 0; n < 16; ++n) {
        const mars::SinCos a = mars::sin_cos_deg(n * 22.5);
        circle.push_back(at + glm::dvec2(a.cos, a.sin) * radius_px);
      }
      layout.canvas().polygon(circle, ink);
    };
    disc(dot_px + layout.line_px(1), kShade);
    disc(dot_px, kWhite);
    layout.label(text, at + *offset, font);
    if (++count == kMostNames) return;
  }
}

}  // namespace vpe::overlay
