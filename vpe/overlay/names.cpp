// Names of places.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/overlay/layer_functions.h"
#include "vpe/overlay/number_format.h"

namespace vpe::overlay {

namespace {

// Limits of the elevation on any planet, to discard invisible places early.
constexpr double kHighest_m = 30e3;
constexpr double kLowest_m = -12e3;
constexpr std::size_t kMostNames = 100;

// Returns true if a place could be above the horizon of a sphere below all terrain.
bool may_be_seen(const VisibleTerrain& terrain, const glm::dvec3& up) {
  const Scene& scene = terrain.scene();
  const double exaggeration = scene.appearance.exaggeration;
  const double lowest = scene.radius_m + kLowest_m * exaggeration;
  if (lowest <= 0) return true;
  const glm::dvec3& camera = scene.view.camera.position_m;
  const auto reach = [lowest](double radius_m) { return std::acos(std::min(1.0, lowest / radius_m)); };
  const double most = reach(glm::length(camera)) + reach(scene.radius_m + kHighest_m * exaggeration);
  return mars::angle_between_rad(up, camera) <= most;
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

}  // namespace

void draw_names(LabelLayout& layout, const VisibleTerrain& terrain, bool distances) {
  constexpr double kSmallest_px = 4;
  const Scene& scene = terrain.scene();
  const Font font = layout.font(14);
  const double dot_px = layout.line_px(2.4);
  const double f = core::focal_px(scene.view);
  std::size_t count = 0;
  for (const core::Place& place : scene.places) {
    const glm::dvec3 up = mars::direction({place.lon_deg, place.lat_deg});
    if (!may_be_seen(terrain, up) || !may_be_inside(terrain, up)) continue;
    const double height_m = scene.height_m ? scene.height_m(place) : 0.0;
    const glm::dvec3 point_m = up * (scene.radius_m + height_m * scene.appearance.exaggeration);
    const std::optional<glm::dvec2> at = terrain.to_image(point_m);
    if (!at || at->x < 0 || at->y < 0 || at->x >= terrain.width() || at->y >= terrain.height()) continue;
    const double distance_m = glm::length(point_m - scene.view.camera.position_m);
    if (place.diameter_m > 0 && place.diameter_m * f < layout.px(kSmallest_px) * distance_m) continue;
    if (is_hidden(terrain, *at, distance_m)) continue;

    const Box dot = Box::about(*at, {2 * dot_px, 2 * dot_px});
    const std::string text = distances ? name_text(place.name, distance_m) : place.name;
    const TextSize size = layout.canvas().measure(text, font);
    const double beside = 0.5 * size.width + 2.2 * dot_px;
    const double over = 0.5 * size.height + 1.2 * dot_px;
    const std::array<glm::dvec2, 4> offsets{glm::dvec2{beside, 0}, glm::dvec2{-beside, 0}, glm::dvec2{0, -over},
                                            glm::dvec2{0, over}};
    if (!layout.is_free(dot)) continue;
    const auto offset = std::find_if(offsets.begin(), offsets.end(), [&](const glm::dvec2& o) {
      return layout.is_free(Box::about(*at + o, size));
    });
    if (offset == offsets.end()) continue;
    layout.take(dot.grown(layout.px(2)));
    layout.take(Box::about(*at + *offset, size).grown(layout.px(4)));
    const auto disc = [&](double radius_px, const Ink& ink) {
      std::vector<glm::dvec2> circle;
      for (int n = 0; n < 16; ++n) {
        const mars::SinCos a = mars::sin_cos_deg(n * 22.5);
        circle.push_back(*at + glm::dvec2(a.cos, a.sin) * radius_px);
      }
      layout.canvas().polygon(circle, ink);
    };
    disc(dot_px + layout.line_px(1), kShade);
    disc(dot_px, kWhite);
    layout.label(text, *at + *offset, font);
    if (++count == kMostNames) return;
  }
}

}  // namespace vpe::overlay
