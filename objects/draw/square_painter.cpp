#include "objects/draw/square_painter.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace objects {

namespace {

constexpr int kPart_px = 8;
constexpr int kGroup_px = 32;
// Difference of light between pixels beside each other from which on the edge of a shadow is smoothed.
constexpr float kShadowEdge = 0.05F;
constexpr std::uint32_t kNoObject = std::numeric_limits<std::uint32_t>::max();

// Returns a ball around what rays of a cone meet between two ranges.
SceneBall ball_between(const glm::dvec3& camera_m, const ViewCone& cone, double near_m, double far_m) {
  SceneBall ball;
  const double middle = 0.5 * (near_m + far_m);
  ball.centre_m = camera_m + middle * cone.axis;
  for (const double r : {near_m, far_m})
    ball.radius_m = std::max(ball.radius_m,
                             std::sqrt(std::max(0.0, r * r + middle * middle - 2 * r * middle * cone.cosine)));
  return ball;
}

}  // namespace

SquarePainter::SquarePainter(const Image& image, const vpe::core::Frame& frame, const PixelSquare& square)
    : image_(image),
      view_(image.light.request.view),
      drawn_part_(vpe::core::drawn_part(view_)),
      square_(square),
      frame_width_(frame.width),
      ground_(frame, square),
      cone_(cone_of(view_, image.view_rays, square, 1.5)) {
  near_to_far_ = image_.rays.in_cone(cone_, ground_.farthest_m());
  if (image_.posters != nullptr)
    posters_ = image_.posters->in_cone(cone_.axis, cone_.cosine, ground_.farthest_m());
  if (!frame.colour.empty() && ground_.has_ground())
    may_be_shaded_ = find_shadows(cone_, ground_.nearest_m(), ground_.farthest_ground_m());
}

bool SquarePainter::find_shadows(const ViewCone& cone, double near_m, double far_m) const {
  if (image_.before_sun.is_empty() || image_.light.ground == nullptr || !(near_m <= far_m)) return false;
  const SceneBall ball = ball_between(view_.camera.position_m, cone, near_m, far_m);
  // Below the horizon of all of it the sun casts no shadow.
  constexpr double kNightSine = -0.05;
  if (glm::dot(ball.centre_m, image_.light.request.sun) <
      kNightSine * glm::length(ball.centre_m) - ball.radius_m)
    return false;
  return image_.before_sun.may_shade(ball.centre_m, ball.radius_m);
}

bool SquarePainter::is_wanted(int x, int y) const {
  return image_.only.empty() ||
         image_.only[static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_width_) +
                     static_cast<std::size_t>(x)] != 0;
}

SquarePainter::SubSquare SquarePainter::part_of(const PixelSquare& square, const ObjectNumbers& among) const {
  SubSquare part{square, {}, false, {}, {}, false, {}};
  const ViewCone cone = cone_of(view_, image_.view_rays, square, 1);
  double near_m = std::numeric_limits<double>::infinity();
  double far_m = 0;
  double until_m = 0;
  for (int y = square.y0; y < square.y1; ++y) {
    for (int x = square.x0; x < square.x1; ++x) {
      const auto r = static_cast<double>(ground_.at(x, y));
      until_m = std::max(until_m, r);
      if (std::isinf(r)) continue;
      near_m = std::min(near_m, r);
      far_m = std::max(far_m, r);
    }
  }
  for (const std::uint32_t n : among) {
    const PlacedObject& o = near_to_far_[n];
    if (o.near_m > until_m) break;
    if (!o.by_rays || !meets(cone, view_.camera.position_m, o.around.centre_m, o.around.radius_m)) continue;
    (o.volume != nullptr ? part.volumes : part.near_to_far).push_back(n);
    if (image_.samples == 1 || o.diameter_px > most_small_px(o)) continue;
    part.has_small_volumes = part.has_small_volumes || o.volume != nullptr;
    const vpe::core::Projected at = vpe::core::project(view_, o.around.centre_m);
    if (!at.behind) part.small.push_back({at.xy, 0.5 * o.diameter_px + 0.75});
  }
  if (!posters_.empty()) part.posters = image_.posters->in_cone(cone.axis, cone.cosine, until_m);
  part.may_be_shaded = may_be_shaded_ && find_shadows(cone, near_m, far_m);
  return part;
}

ObjectRay SquarePainter::ray_of(int x, int y, const glm::dvec2& offset) const {
  return {view_.camera.position_m,
          image_.view_rays.at(drawn_part_.x + x + 0.5 + offset.x, drawn_part_.y + y + 0.5 + offset.y)};
}

void SquarePainter::meet(const SubSquare& part, const ObjectRay& ray, double until_m) {
  nearest_object(near_to_far_, part.near_to_far, ray, until_m, image_.pixel_rad, scratch_);
  if (!part.posters.empty()) meet_posters(part, ray, until_m);
}

// Puts them into their order among the surfaces that the ray meets. An opaque one ends the ray.
void SquarePainter::meet_posters(const SubSquare& part, const ObjectRay& ray, double until_m) {
  for (const std::uint32_t n : part.posters) {
    const std::optional<PosterHit> met = image_.posters->meet(n, ray.direction, until_m);
    if (!met || (scratch_.has_front && met->range_m >= scratch_.front.range_m)) continue;
    ObjectHit hit;
    hit.range_m = met->range_m;
    hit.object = n | kPosterBit;
    hit.weights = met->uv;
    hit.opacity = met->texels;
    const auto behind =
        std::upper_bound(scratch_.layers.begin(), scratch_.layers.end(), hit.range_m,
                         [](double range_m, const ObjectHit& layer) { return range_m < layer.range_m; });
    if (!image_.posters->is_opaque(n)) {
      scratch_.layers.insert(behind, hit);
      continue;
    }
    scratch_.layers.erase(behind, scratch_.layers.end());
    scratch_.front = hit;
    scratch_.has_front = true;
  }
}

std::uint32_t SquarePainter::front_of(const ObjectHit& hit) const {
  return 1 + (is_poster(hit.object) ? hit.object : near_to_far_[hit.object].instance);
}

ObjectColour SquarePainter::object_at(const SubSquare& part, const ObjectRay& ray, double until_m,
                                      std::uint32_t& front) {
  meet(part, ray, until_m);
  const bool has_surface = scratch_.has_front || !scratch_.layers.empty();
  if (!has_surface && part.volumes.empty()) return {};
  if (!has_surface) return volume_shader_->colour(ray, scratch_, part.volumes, until_m);
  front = front_of(scratch_.layers.empty() ? scratch_.front : scratch_.layers.front());
  return part.volumes.empty() ? shader_->colour(ray, scratch_)
                              : volume_shader_->colour(ray, scratch_, part.volumes, until_m);
}

// Covers the pixel by many rays, and colours each object that they meet once: colour changes little within a pixel. So does
// that of volumes before an object, or before the ground.
glm::dvec4 SquarePainter::smooth_sample(const SubSquare& part, int x, int y) {
  struct ColouredObject {
    std::uint32_t object;
    glm::dvec4 over;
  };
  std::array<ColouredObject, kEdgeOffsets.size()> known;
  std::size_t count = 0;
  glm::dvec4 sum(0);
  for (const glm::dvec2& offset : kEdgeOffsets) {
    const ObjectRay ray = ray_of(x, y, offset);
    const double ground_m = ground_.beside(x, y, offset);
    meet(part, ray, ground_m);
    if (!scratch_.has_front && scratch_.layers.empty() && part.volumes.empty()) continue;
    const auto colour = [&] {
      return (part.volumes.empty() ? shader_->colour(ray, scratch_)
                                   : volume_shader_->colour(ray, scratch_, part.volumes, ground_m))
          .over;
    };
    if (!scratch_.layers.empty() || part.has_small_volumes) {
      sum += colour();
      continue;
    }
    const std::uint32_t object = scratch_.has_front ? scratch_.front.object : kNoObject;
    const auto end = known.begin() + static_cast<std::ptrdiff_t>(count);
    auto at = std::find_if(known.begin(), end, [&](const ColouredObject& s) { return s.object == object; });
    if (at == end) *at = {object, colour()}, ++count;
    sum += at->over;
  }
  return sum / static_cast<double>(kEdgeOffsets.size());
}

double SquarePainter::light_sample(int x, int y, const glm::dvec2& offset) const {
  const ObjectRay ray = ray_of(x, y, offset);
  const double range_m = ground_.beside(x, y, offset);
  if (std::isinf(range_m)) return 1;
  return image_.before_sun.light_at(ray.origin_m + range_m * ray.direction);
}

void SquarePainter::see_pixel(const SubSquare& part, int x, int y) {
  SeenPixel& seen = seen_at(x, y);
  const ObjectRay ray = ray_of(x, y, {0, 0});
  const auto range_m = static_cast<double>(ground_.at(x, y));
  if (!part.near_to_far.empty() || !part.volumes.empty() || !part.posters.empty())
    seen.object = object_at(part, ray, range_m, seen.front);
  see_light(part, x, y);
}

void SquarePainter::see_light(const SubSquare& part, int x, int y) {
  SeenPixel& seen = seen_at(x, y);
  const auto range_m = static_cast<double>(ground_.at(x, y));
  if (!part.may_be_shaded || seen.object.over.w >= 1 || std::isinf(range_m)) return;
  const ObjectRay ray = ray_of(x, y, {0, 0});
  seen.light = static_cast<float>(image_.before_sun.light_at(ray.origin_m + range_m * ray.direction));
}

// Most pixels beside one are in the same square.
const SeenPixel* SquarePainter::beside(int x, int y, const Seen& seen) const {
  const bool is_inside = x >= square_.x0 && x < square_.x1 && y >= square_.y0 && y < square_.y1;
  return is_inside ? &at(x, y) : seen(x, y);
}

void SquarePainter::see() {
  if (const DomePainter* dome = lone_dome()) {
    dome_mask_ = dome->find(square_, cone_, ground_);
    dome_seen_.front = 1 + (dome->poster() | kPosterBit);
    dome_ = dome;
    shader_.emplace(image_.rays, image_.before_sun, near_to_far_, image_.light, image_.posters);
    return;
  }
  seen_.resize(static_cast<std::size_t>(square_.x1 - square_.x0) *
               static_cast<std::size_t>(square_.y1 - square_.y0));
  shader_.emplace(image_.rays, image_.before_sun, near_to_far_, image_.light, image_.posters);
  const ObjectNumbers all = all_of(near_to_far_);
  if (image_.volume_lights != nullptr) {
    volume_shader_.emplace(*shader_, *image_.volume_lights, near_to_far_, image_.light);
    for (const std::uint32_t n : all) {
      if (near_to_far_[n].volume != nullptr) volumes_.push_back(n);
    }
  }
  for (int y = square_.y0; y < square_.y1; y += kGroup_px) {
    for (int x = square_.x0; x < square_.x1; x += kGroup_px) {
      const PixelSquare group{x, y, std::min(x + kGroup_px, square_.x1), std::min(y + kGroup_px, square_.y1)};
      const ViewCone cone = cone_of(view_, image_.view_rays, group, 1);
      ObjectNumbers among;
      for (const std::uint32_t n : all) {
        const SceneBall& ball = near_to_far_[n].around;
        if (meets(cone, view_.camera.position_m, ball.centre_m, ball.radius_m)) among.push_back(n);
      }
      if (!among.empty() || may_be_shaded_ || !posters_.empty()) see_parts(group, among);
    }
  }
}

void SquarePainter::see_parts(const PixelSquare& square, const ObjectNumbers& among) {
  for (int y = square.y0; y < square.y1; y += kPart_px) {
    for (int x = square.x0; x < square.x1; x += kPart_px) {
      SubSquare part =
          part_of({x, y, std::min(x + kPart_px, square.x1), std::min(y + kPart_px, square.y1)}, among);
      if (part.near_to_far.empty() && part.volumes.empty() && !part.may_be_shaded && part.posters.empty())
        continue;
      if (is_sparse(part)) {
        see_sparsely(part);
        parts_.push_back(std::move(part));
        continue;
      }
      for (int j = part.square.y0; j < part.square.y1; ++j) {
        for (int i = part.square.x0; i < part.square.x1; ++i) see_pixel(part, i, j);
      }
      parts_.push_back(std::move(part));
    }
  }
}

void SquarePainter::paint_pixel(const SubSquare& part, int x, int y, const Seen& seen,
                                vpe::core::Frame& frame) {
  const SeenPixel& here = at(x, y);
  bool is_edge = false;
  bool is_shadow_edge = false;
  if (image_.samples > 1) {
    constexpr std::array<glm::ivec2, 4> kBeside{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (const glm::ivec2& d : kBeside) {
      const SeenPixel* other = beside(x + d.x, y + d.y, seen);
      if (other == nullptr) continue;
      is_edge = is_edge || other->front != here.front;
      is_shadow_edge = is_shadow_edge || std::abs(other->light - here.light) > kShadowEdge;
    }
  }
  // Amid an object, where the pixels beside this one show it, too, rays miss nothing.
  if (!is_edge && here.front == 0) {
    const glm::dvec2 middle_px = glm::dvec2(drawn_part_.x + x, drawn_part_.y + y) + 0.5;
    for (const SmallObject& s : part.small)
      is_edge = is_edge || glm::distance(s.middle_px, middle_px) < s.reach_px;
  }
  if (!is_edge && !is_shadow_edge && !(here.object.over.w > 0) && here.light >= 1) return;
  ObjectColour object = here.object;
  double light = static_cast<double>(here.light);
  if (is_edge && (!part.near_to_far.empty() || part.has_small_volumes || !part.posters.empty()))
    object.over = smooth_sample(part, x, y);
  if (is_shadow_edge && part.may_be_shaded) {
    light = 0;
    for (const glm::dvec2& offset : kEdgeOffsets)
      light += light_sample(x, y, offset) / static_cast<double>(kEdgeOffsets.size());
  }
  const std::size_t pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_width_) + static_cast<std::size_t>(x);
  if (!frame.colour.empty()) {
    glm::dvec3 colour = to_dvec3(frame.colour[pixel]);
    if (light < 1 && object.over.w < 1) {
      const ObjectRay ray = ray_of(x, y, {0, 0});
      const auto range_m = static_cast<double>(ground_.at(x, y));
      const double in_shadow = image_.light.ground->shadow_factor(ray.origin_m + range_m * ray.direction,
                                                                  range_m * image_.pixel_rad);
      if (in_shadow < 1) {
        const Haze haze = haze_at(image_.light, ray.direction, range_m);
        colour = (colour - haze.added) * (1 - (1 - light) * (1 - in_shadow)) + haze.added;
        ++drawn_.counts.shaded;
      }
    }
    frame.colour[pixel] = to_rgb(colour * (1 - object.over.w) + glm::dvec3(object.over));
  }
  if (object.over.w > 0) ++drawn_.counts.pixels;
  if (!std::isinf(here.object.range_m)) ++drawn_.counts.covered;
  if (!frame.range_m.empty() && here.object.range_m < static_cast<double>(frame.range_m[pixel]))
    frame.range_m[pixel] = static_cast<float>(here.object.range_m);
}

// Volumes before it veil it.
void SquarePainter::add_small(const PlacedObject& object, int x, int y, double share, const glm::dvec3& colour,
                              vpe::core::Frame& frame) {
  vpe::base::Rgb& pixel = frame.colour[static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_width_) +
                                       static_cast<std::size_t>(x)];
  glm::dvec3 shown = colour;
  if (!volumes_.empty()) {
    const double range_m = glm::distance(object.around.centre_m, view_.camera.position_m);
    const glm::dvec4 over = volume_shader_->colour(ray_of(x, y, {0, 0}), {}, volumes_, range_m).over;
    shown = glm::dvec3(over) + (1 - over.w) * colour;
  }
  pixel = to_rgb(glm::mix(to_dvec3(pixel), shown, share));
}

void SquarePainter::paint(const Seen& seen, vpe::core::Frame& frame) {
  if (dome_ != nullptr) {
    paint_dome(seen, frame);
    return;
  }
  for (const SubSquare& part : parts_) {
    for (int y = part.square.y0; y < part.square.y1; ++y) {
      for (int x = part.square.x0; x < part.square.x1; ++x) {
        if (is_wanted(x, y)) paint_pixel(part, x, y, seen, frame);
      }
    }
  }
  if (!frame.colour.empty()) {
    find_thin();
    paint_small(seen, frame);
  }
  for (const SeenPixel& pixel : seen_) {
    if (pixel.front != 0 && !is_poster(pixel.front) &&
        (drawn_.instances.empty() || drawn_.instances.back() != pixel.front - 1))
      drawn_.instances.push_back(pixel.front - 1);
  }
  for (const std::uint32_t n : volumes_) {
    if (volume_shader_->has_shown(n)) drawn_.instances.push_back(near_to_far_[n].instance);
  }
  std::sort(drawn_.instances.begin(), drawn_.instances.end());
  drawn_.instances.erase(std::unique(drawn_.instances.begin(), drawn_.instances.end()), drawn_.instances.end());
  // The image may lack an object because of the error of its level, so that all count that may show.
  std::vector<std::uint8_t> may_show(near_to_far_.size(), 0);
  for (const SubSquare& part : parts_) {
    for (const std::uint32_t n : part.near_to_far) may_show[n] = 1;
  }
  for (std::uint32_t n = 0; n < near_to_far_.size(); ++n) {
    const PlacedObject& o = near_to_far_[n];
    const bool is_drawn = std::binary_search(drawn_.instances.begin(), drawn_.instances.end(), o.instance);
    if (!is_drawn && may_show[n] == 0) continue;
    const double geometric_error_m = o.model->level_error_m(o.level_index) * static_cast<double>(o.scale);
    drawn_.counts.geometric_error_m = std::max(drawn_.counts.geometric_error_m, geometric_error_m);
    if (!o.by_rays) {
      // A disc in place of its shape.
      drawn_.counts.screen_space_error_px =
          std::max(drawn_.counts.screen_space_error_px, 0.5 * o.diameter_px / image_.rays.rule().stretch);
    } else if (geometric_error_m > 0) {
      drawn_.counts.screen_space_error_px = std::max(
          drawn_.counts.screen_space_error_px, geometric_error_m * image_.rays.rule().focal_px / o.near_m);
    }
  }
}

}  // namespace objects
