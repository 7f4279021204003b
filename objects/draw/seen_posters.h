// Images of a scene as one camera sees them: which rays meet them where, and their colours.
//
// A rectangle is met where the ray meets its plane, a dome on its far side, from within. Images carry their own light: no sun,
// shadow or haze changes them. Colours are for an image before gamma (core::apply_gamma), after which they are their own.
//
// Typical usage:
//   const SeenPosters posters(placed, request.view, request.settings.gamma);
//   for (const std::uint32_t n : posters.in_cone(cone, until_m)) {
//     if (const auto hit = posters.meet(n, ray, until_m)) colour = posters.colour(*hit);
//   }
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "objects/posters/placed_poster.h"
#include "vpe/core/view.h"

namespace objects {

// An image that is seen from its side covers many of its pixels by one; beyond this it is left to be coarse.
inline constexpr double kLeastPosterCosine = 0.02;

// Describes a place where a ray meets an image.
struct PosterHit {
  double range_m = 0;  // along the unit ray
  std::uint32_t poster = 0;
  glm::vec2 uv{0, 0};
  float texels = 1;  // side of what a pixel covers, in pixels of the image
};

// Holds the images that a camera sees. Immutable; any thread may call any member.
class SeenPosters {
 public:
  // Images that are wholly transparent from there are left out. `posters` and `view` must outlive this.
  SeenPosters(std::span<const PlacedPoster> posters, const vpe::core::View& view, double gamma);

  bool is_empty() const { return seen_.empty(); }
  // Returns the number of images; they are numbered from 0.
  std::size_t size() const { return seen_.size(); }
  // Returns whether an image lets through what is behind it.
  bool is_see_through() const;
  bool is_opaque(std::uint32_t poster) const { return seen_[poster].opacity >= 1; }
  // Returns whether the image hides ground that is nearer than itself. It is met on that ground then.
  bool replaces_ground(std::uint32_t poster) const { return seen_[poster].replaces_ground; }
  // Returns the dome as it is placed, or null for other images.
  const PlacedPoster* dome(std::uint32_t poster) const {
    return seen_[poster].is_dome ? seen_[poster].placed : nullptr;
  }
  // Returns the share of an image in what is seen, 0 to 1, with fading.
  double opacity(std::uint32_t poster) const { return seen_[poster].opacity; }
  // Returns a distance from the camera within which there is no image.
  double clear_m() const { return clear_m_; }

  // Returns the numbers of images that rays from the camera may meet before until_m within an angle of an axis (unit),
  // ascending. Never leaves out one that they do.
  std::vector<std::uint32_t> in_cone(const glm::dvec3& axis, double cosine, double until_m) const;
  // Returns where a ray (unit direction, body-fixed) from the camera meets an image before until_m.
  std::optional<PosterHit> meet(std::uint32_t poster, const glm::dvec3& direction, double until_m) const;
  // Returns the colour at a hit, 0 to 255, with the opacity, 0 to 255, in w.
  glm::dvec4 colour(std::uint32_t poster, const glm::vec2& uv, float texels) const;

 private:
  struct Seen {
    const PlacedPoster* placed = nullptr;
    double opacity = 1;  // with fading
    bool is_dome = false;
    bool replaces_ground = false;
    glm::dvec3 from_camera_m{};  // to the middle
    mars::Axes axes;
    double radius_m = 0;  // of a ball around a rectangle
  };
  std::optional<PosterHit> meet_rectangle(const Seen& seen, const glm::dvec3& direction, double until_m) const;
  std::optional<PosterHit> meet_dome(const Seen& seen, const glm::dvec3& direction, double until_m) const;

  const vpe::core::View& view_;
  double gamma_;
  double clear_m_;
  std::vector<Seen> seen_;
};

}  // namespace objects
