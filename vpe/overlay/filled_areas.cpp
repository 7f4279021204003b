#include "vpe/overlay/filled_areas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <optional>

namespace vpe::overlay {
namespace {

constexpr int kGridSide = 64;

struct Premultiplied {
  double r = 0, g = 0, b = 0, a = 0;
};

// The areas that may hold a place, by cells of the part of the planet that an image shows. Longitudes count from `middle_`.
class VisibleAreas {
 public:
  VisibleAreas(const GroundFeatures& features, const ShownPlaces& places) : features_(features) {
    for (std::size_t i = 0; i < places.lon_deg.size() && !found_; ++i) {
      found_ = std::isfinite(places.lon_deg[i]);
      if (found_) middle_ = places.lon_deg[i];
    }
    if (!found_) return;
    low_ = glm::dvec2(std::numeric_limits<double>::infinity());
    high_ = -low_;
    for (std::size_t i = 0; i < places.lon_deg.size(); ++i) {
      if (!std::isfinite(places.lon_deg[i])) continue;
      const glm::dvec2 p(relative(places.lon_deg[i]), places.lat_deg[i]);
      low_ = glm::min(low_, p);
      high_ = glm::max(high_, p);
    }
    cells_.resize(static_cast<std::size_t>(kGridSide) * kGridSide);
    for (std::uint32_t a = 0; a < features.areas().size(); ++a) add(a);
  }

  bool empty() const { return !any_; }

  // Lays the fills of a place over each other.
  Premultiplied colour(glm::dvec2 place_deg, double opacity) const {
    Premultiplied sum;
    const glm::dvec2 p(relative(place_deg.x), place_deg.y);
    for (const std::uint32_t a : cells_[cell(p)]) {
      const GroundFeatures::Area& area = features_.areas()[a];
      if (!area.index.contains(place_deg)) continue;
      const mars::StyleColour& fill = *features_.style(area.feature).fill;
      const double alpha = fill.opacity * opacity;
      sum.r = sum.r * (1 - alpha) + fill.rgb.r * alpha;
      sum.g = sum.g * (1 - alpha) + fill.rgb.g * alpha;
      sum.b = sum.b * (1 - alpha) + fill.rgb.b * alpha;
      sum.a = sum.a * (1 - alpha) + alpha;
    }
    return sum;
  }

 private:
  double relative(double lon_deg) const { return std::remainder(lon_deg - middle_, 360.0); }

  int column(double x) const {
    const double width = high_.x - low_.x;
    return width > 0 ? static_cast<int>(std::clamp((x - low_.x) / width * kGridSide, 0.0, kGridSide - 1.0)) : 0;
  }
  int row(double y) const {
    const double height = high_.y - low_.y;
    return height > 0 ? static_cast<int>(std::clamp((y - low_.y) / height * kGridSide, 0.0, kGridSide - 1.0))
                      : 0;
  }
  std::size_t cell(glm::dvec2 p) const {
    return static_cast<std::size_t>(row(p.y)) * kGridSide + static_cast<std::size_t>(column(p.x));
  }

  void add(std::uint32_t a) {
    const AreaIndex& index = features_.areas()[a].index;
    if (index.high_deg().y < low_.y || index.low_deg().y > high_.y) return;
    const double west = index.low_deg().x - middle_;
    const double width = index.high_deg().x - index.low_deg().x;
    // Each turn in which the area meets what is shown.
    for (double x = west - 360 * std::ceil((west + width - low_.x) / 360); x <= high_.x; x += 360) {
      if (x + width < low_.x) continue;
      for (int j = row(index.low_deg().y); j <= row(index.high_deg().y); ++j) {
        for (int i = column(x); i <= column(x + width); ++i) {
          auto& own = cells_[static_cast<std::size_t>(j) * kGridSide + static_cast<std::size_t>(i)];
          if (own.empty() || own.back() != a) own.push_back(a);
        }
      }
      any_ = true;
    }
  }

  const GroundFeatures& features_;
  bool found_ = false;
  bool any_ = false;
  double middle_ = 0;
  glm::dvec2 low_{0, 0};
  glm::dvec2 high_{0, 0};
  std::vector<std::vector<std::uint32_t>> cells_;
};

bool differ(const Premultiplied& a, const Premultiplied& b) {
  return a.r != b.r || a.g != b.g || a.b != b.b || a.a != b.a;
}

core::Rgba to_rgba(const Premultiplied& p) {
  if (!(p.a > 0)) return {0, 0, 0, 0};
  const auto byte = [](double x) { return static_cast<std::uint8_t>(std::clamp(std::round(x), 0.0, 255.0)); };
  return {byte(p.r / p.a), byte(p.g / p.a), byte(p.b / p.a), byte(255 * p.a)};
}

}  // namespace

ShownPlaces shown_places(const VisibleTerrain& terrain) {
  return {terrain.longitudes_deg(), terrain.latitudes_deg()};
}

Layer fill_areas(const GroundFeatures& features, const VisibleTerrain& terrain, const ShownPlaces& places,
                 double opacity) {
  const VisibleAreas areas(features, places);
  if (areas.empty()) return {};
  const int width = terrain.width();
  const int height = terrain.height();
  std::vector<Premultiplied> colours(places.lon_deg.size());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    if (std::isfinite(places.lon_deg[i]))
      colours[i] = areas.colour({places.lon_deg[i], places.lat_deg[i]}, opacity);
  }
  Layer out{width, height, std::vector<core::Rgba>(colours.size())};
  const auto place = [&](std::size_t i) { return glm::dvec2(places.lon_deg[i], places.lat_deg[i]); };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = terrain.index(x, y);
      const auto down = static_cast<std::size_t>(width);
      Premultiplied own = colours[i];
      const bool inner = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
      if (inner && std::isfinite(places.lon_deg[i]) &&
          (differ(own, colours[i - 1]) || differ(own, colours[i + 1]) || differ(own, colours[i - down]) ||
           differ(own, colours[i + down])) &&
          terrain.is_whole(x - 1, y - 1) && terrain.is_whole(x, y)) {
        glm::dvec2 across = place(i + 1) - place(i - 1);
        glm::dvec2 along = place(i + down) - place(i - down);
        across.x = std::remainder(across.x, 360.0);
        along.x = std::remainder(along.x, 360.0);
        own = {};
        for (const auto& [u, v] : {std::pair(-1, -1), std::pair(1, -1), std::pair(-1, 1), std::pair(1, 1)}) {
          // A quarter of a pixel from the middle; differences are over two pixels.
          const Premultiplied part = areas.colour(place(i) + across * (u / 8.0) + along * (v / 8.0), opacity);
          own.r += 0.25 * part.r;
          own.g += 0.25 * part.g;
          own.b += 0.25 * part.b;
          own.a += 0.25 * part.a;
        }
      }
      out.pixels[i] = to_rgba(own);
    }
  }
  return out;
}

}  // namespace vpe::overlay
