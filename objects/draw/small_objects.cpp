// Objects that the rays of an image do not draw: those that are too small for it, and thin ones that no ray meets.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/ext/scalar_constants.hpp>
#include <glm/geometric.hpp>

#include "objects/draw/square_painter.h"

namespace objects {

namespace {

// Share of its area by which an object shows when it is just large enough to be drawn: less would be lost in bytes.
constexpr double kLeastFade = 0.5;
// Up to this size it is made sure that an object does not pass between all rays.
constexpr double kMostThin_px = 32;

// Places of a pixel, from its middle, at which objects are looked for that did: a lattice of which no two share a row or a
// column of their number.
template <std::size_t kCount, std::size_t kStep>
constexpr std::array<glm::dvec2, kCount> lattice() {
  std::array<glm::dvec2, kCount> out{};
  const auto place = [](std::size_t n) { return (static_cast<double>(n) + 0.5) / kCount - 0.5; };
  for (std::size_t n = 0; n < kCount; ++n) out[n] = glm::dvec2(place(n), place(n * kStep % kCount));
  return out;
}
constexpr std::array<glm::dvec2, 64> kThinOffsets = lattice<64, 39>();
constexpr std::array<glm::dvec2, 256> kTinyOffsets = lattice<256, 159>();
// Up to this size there are few pixels, so that more rays cost little.
constexpr double kMostTiny_px = 4;

std::span<const glm::dvec2> thin_offsets(const PlacedObject& o) {
  if (o.diameter_px <= kMostTiny_px) return kTinyOffsets;
  return kThinOffsets;
}

}  // namespace

double most_small_px(const PlacedObject& object) {
  // A ball of 12 pixels, and what is 6 pixels wide on the mean.
  constexpr double kLeast_px = 12;
  constexpr double kWide_px = 6;
  constexpr double kMost_px = 64;
  const double radius_m = static_cast<double>(object.model->ball().radius_m);
  const double filled = object.model->mean_silhouette_m2() / (glm::pi<double>() * radius_m * radius_m);
  return filled > kWide_px / kMost_px ? std::clamp(kWide_px / filled, kLeast_px, kMost_px) : kMost_px;
}

// An object covers its share of the four pixels around its middle, which sum to its size wherever it lies.
bool SquarePainter::paint_by_area(const PlacedObject& o, const Seen& seen, vpe::core::Frame& frame) {
  const SceneBall& ball = o.around;
  const vpe::core::Projected at = vpe::core::project(view_, ball.centre_m);
  if (at.behind) return false;
  const glm::dvec3 to = ball.centre_m - view_.camera.position_m;
  const double range_m = glm::length(to);
  const double area_m2 =
      o.model->mean_silhouette_m2() * static_cast<double>(o.scale) * static_cast<double>(o.scale);
  const double fade =
      glm::mix(kLeastFade, 1.0, glm::smoothstep(kLeastDiameter_px, kFullDiameter_px, o.diameter_px));
  const double covered =
      fade * o.model->mean_opacity() * area_m2 / (range_m * range_m) / pixel_solid_angle(view_, to / range_m);
  const glm::dvec2 place = at.xy - glm::dvec2(drawn_part_.x, drawn_part_.y) - 0.5;
  const glm::dvec2 corner = glm::floor(place);
  const glm::dvec2 beside = place - corner;
  const glm::dvec3 colour = shader_->mean_colour(o);
  bool shows = false;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const int x = static_cast<int>(corner.x) + i;
      const int y = static_cast<int>(corner.y) + j;
      if (x < square_.x0 || x >= square_.x1 || y < square_.y0 || y >= square_.y1 || !is_wanted(x, y)) continue;
      const SeenPixel* here = seen(x, y);
      const double front_m = std::min(static_cast<double>(ground_.at(x, y)), here->object.range_m);
      if (range_m > front_m) continue;
      const double weight = (i == 0 ? 1 - beside.x : beside.x) * (j == 0 ? 1 - beside.y : beside.y);
      const double share = std::min(1.0, covered * weight);
      add_small(o, x, y, share, colour, frame);
      shows = true;
    }
  }
  return shows;
}

PixelSquare SquarePainter::pixels_around(const PlacedObject& o) const {
  const vpe::core::Projected at = vpe::core::project(view_, o.around.centre_m);
  if (at.behind) return {};
  const glm::ivec2 middle(glm::floor(at.xy - glm::dvec2(drawn_part_.x, drawn_part_.y)));
  const int reach = static_cast<int>(std::ceil(0.5 * o.diameter_px + 0.75));
  return {std::max(0, middle.x - reach), std::max(0, middle.y - reach),
          std::min(drawn_part_.width, middle.x + reach + 1),
          std::min(drawn_part_.height, middle.y + reach + 1)};
}

bool SquarePainter::is_met_at(std::uint32_t object, int x, int y, std::span<const glm::dvec2> offsets) {
  return std::any_of(offsets.begin(), offsets.end(), [&](const glm::dvec2& offset) {
    nearest_object(near_to_far_, {&object, 1}, ray_of(x, y, offset), std::numeric_limits<double>::infinity(),
                   image_.pixel_rad, scratch_);
    return scratch_.has_front || !scratch_.layers.empty();
  });
}

bool SquarePainter::is_met(std::uint32_t object, std::span<const glm::dvec2> offsets, bool needs_middle) {
  constexpr std::array<glm::dvec2, 1> kMiddle{};
  const PixelSquare around = pixels_around(near_to_far_[object]);
  const glm::ivec2 middle((around.x0 + around.x1) / 2, (around.y0 + around.y1) / 2);
  const int rings = std::max(around.x1 - around.x0, around.y1 - around.y0) / 2 + 1;
  // From the middle outwards, as the first ray nearly always meets it.
  for (int ring = 0; ring <= rings; ++ring) {
    for (int y = std::max(around.y0, middle.y - ring); y < std::min(around.y1, middle.y + ring + 1); ++y) {
      const int step = ring == 0 || std::abs(y - middle.y) == ring ? 1 : 2 * ring;
      for (int x = middle.x - ring; x <= middle.x + ring; x += step) {
        if (x < around.x0 || x >= around.x1) continue;
        if ((!needs_middle || is_met_at(object, x, y, kMiddle)) && is_met_at(object, x, y, offsets))
          return true;
      }
    }
  }
  return false;
}

// Returns whether the image shows an object that nothing hides. Where edges are smooth, a pixel whose middle alone meets it
// is none.
bool SquarePainter::is_met(std::uint32_t object) {
  constexpr std::array<glm::dvec2, 1> kMiddle{};
  if (image_.samples == 1) return is_met(object, kMiddle, false);
  return is_met(object, kEdgeOffsets, near_to_far_[object].diameter_px > most_small_px(near_to_far_[object]));
}

void SquarePainter::find_thin() {
  // A disc in place of the shape is off by half of its size.
  const double most_disc_px = 2 * image_.light.request.settings.lod_tolerance_px * image_.rays.rule().stretch;
  for (std::uint32_t n = 0; n < near_to_far_.size(); ++n) {
    PlacedObject& o = near_to_far_[n];
    if (!o.by_rays || o.volume != nullptr || o.diameter_px > kMostThin_px || is_met(n)) continue;
    if (is_met(n, thin_offsets(o), false)) {
      thin_.push_back(n);
    } else if (o.diameter_px <= most_disc_px) {
      o.by_rays = false;
    }
  }
}

// Covers each pixel by the share of many rays that meet the object.
bool SquarePainter::paint_thin(std::uint32_t object, const Seen& seen, vpe::core::Frame& frame) {
  const PixelSquare around = pixels_around(near_to_far_[object]);
  const std::span<const glm::dvec2> offsets = thin_offsets(near_to_far_[object]);
  bool shows = false;
  for (int y = std::max(around.y0, square_.y0); y < std::min(around.y1, square_.y1); ++y) {
    for (int x = std::max(around.x0, square_.x0); x < std::min(around.x1, square_.x1); ++x) {
      if (!is_wanted(x, y)) continue;
      const double front_m = std::min(static_cast<double>(ground_.at(x, y)), seen(x, y)->object.range_m);
      glm::dvec4 over(0);
      for (const glm::dvec2& offset : offsets) {
        const ObjectRay ray = ray_of(x, y, offset);
        nearest_object(near_to_far_, {&object, 1}, ray, front_m, image_.pixel_rad, scratch_);
        if (scratch_.has_front || !scratch_.layers.empty()) over += shader_->colour(ray, scratch_).over;
      }
      if (!(over.w > 0)) continue;
      add_small(near_to_far_[object], x, y, over.w / static_cast<double>(offsets.size()),
                glm::dvec3(over) / over.w, frame);
      shows = true;
    }
  }
  return shows;
}

void SquarePainter::paint_small(const Seen& seen, vpe::core::Frame& frame) {
  for (std::size_t k = near_to_far_.size(); k-- > 0;) {
    const auto n = static_cast<std::uint32_t>(k);
    const PlacedObject& o = near_to_far_[n];
    const bool is_thin = std::binary_search(thin_.begin(), thin_.end(), n);
    if (o.by_rays && !is_thin) continue;
    if (is_thin ? paint_thin(n, seen, frame) : paint_by_area(o, seen, frame))
      drawn_.instances.push_back(o.instance);
  }
}

}  // namespace objects
