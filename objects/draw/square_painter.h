// Draws the objects of one square of pixels. Internal to objects/draw.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "objects/draw/composer.h"
#include "objects/draw/dome_painter.h"
#include "objects/draw/pixel_square.h"
#include "objects/draw/volume_shader.h"

namespace objects {

inline constexpr int kSquare_px = 64;
// Returns the size up to which an object is smoothed in all pixels beside it, as rays of pixels' centres may miss it or
// parts of it: the larger, the less its silhouette fills its ball, 12 to 64 pixels.
double most_small_px(const PlacedObject& object);

// Gives the places of a pixel, from its middle, at which edges are cast: no two share a row or a column of sixteenths.
inline constexpr std::array<glm::dvec2, 8> kEdgeOffsets{{{0.0625, -0.1875},
                                                         {-0.0625, 0.1875},
                                                         {0.3125, 0.0625},
                                                         {-0.1875, -0.3125},
                                                         {-0.3125, 0.3125},
                                                         {-0.4375, -0.0625},
                                                         {0.1875, 0.4375},
                                                         {0.4375, -0.4375}}};

// Return a colour in bytes, rounded, and the reverse.
inline vpe::base::Rgb to_rgb(const glm::dvec3& c) {
  const auto byte = [](double x) { return static_cast<std::uint8_t>(std::lround(std::clamp(x, 0.0, 255.0))); };
  return {byte(c.x), byte(c.y), byte(c.z)};
}
inline glm::dvec3 to_dvec3(const vpe::base::Rgb& c) { return {c.r, c.g, c.b}; }

// Holds what the first step found at a pixel.
struct SeenPixel {
  std::uint32_t front =
      0;            // 1 + instance, or 1 + image with kPosterBit, of the first surface that is met; 0: none
  float light = 1;  // of the sun on the ground there
  ObjectColour object;
};

// Draws a square in two steps, so that the second one knows the pixels beside it. Different threads may draw different
// squares; the first step of all ends before the second of any begins.
class SquarePainter {
 public:
  struct Image {
    const ObjectRays& rays;
    const SunGrid& before_sun;
    const ViewRays& view_rays;
    ImageLight light;
    std::span<const std::uint8_t> only;
    int samples = 1;                              // at edges; 1: edges are not smoothed
    double pixel_rad = 0;                         // angle of a pixel at the image's middle
    const VolumeLights* volume_lights = nullptr;  // null: the scene has no volumes
    const SeenPosters* posters = nullptr;         // null: the camera sees none
    std::span<const DomePainter> domes = {};
  };

  // `frame` is read only.
  SquarePainter(const Image& image, const vpe::core::Frame& frame, const PixelSquare& square);

  // Returns true if an object or a shadow of one may show in the square. Only then see() and paint() do anything.
  bool may_show() const { return !near_to_far_.empty() || may_be_shaded_ || !posters_.empty(); }
  void see();
  const SeenPixel& at(int x, int y) const {
    if (dome_ != nullptr) return shows_dome(x, y) ? dome_seen_ : nothing_seen_;
    return seen_[static_cast<std::size_t>(y - square_.y0) * static_cast<std::size_t>(square_.x1 - square_.x0) +
                 static_cast<std::size_t>(x - square_.x0)];
  }

  // Returns what was seen at a pixel of the image, or null where nothing may show.
  using Seen = std::function<const SeenPixel*(int x, int y)>;
  void paint(const Seen& seen, vpe::core::Frame& frame);

  struct Drawn {
    std::vector<std::uint32_t> instances;
    ComposedObjects counts;
  };
  const Drawn& drawn() const { return drawn_; }

 private:
  // Describes a smaller square and what may show in it.
  struct SmallObject {
    glm::dvec2 middle_px;  // of the full image
    double reach_px;
  };
  struct SubSquare {
    PixelSquare square;
    ObjectNumbers near_to_far;  // without volumes
    bool may_be_shaded = false;
    std::vector<SmallObject> small;
    ObjectNumbers volumes;
    bool has_small_volumes = false;
    ObjectNumbers posters;  // of Image::posters
  };
  SeenPixel& seen_at(int x, int y) { return const_cast<SeenPixel&>(at(x, y)); }
  // Returns what draws the square if it shows nothing but ground and one dome, else null.
  const DomePainter* lone_dome() const;
  bool shows_dome(int x, int y) const {
    return (dome_mask_.rows[static_cast<std::size_t>(y - square_.y0)] >> static_cast<unsigned>(x - square_.x0) &
            1U) != 0;
  }
  void paint_dome(const Seen& seen, vpe::core::Frame& frame);
  void paint_dome_block(const DomeColours& colours, const Seen& seen, vpe::core::Frame& frame);
  bool is_wanted(int x, int y) const;
  bool find_shadows(const ViewCone& cone, double near_m, double far_m) const;
  SubSquare part_of(const PixelSquare& square, const ObjectNumbers& among) const;
  void see_parts(const PixelSquare& square, const ObjectNumbers& among);
  ObjectRay ray_of(int x, int y, const glm::dvec2& offset) const;
  void add_small(const PlacedObject& object, int x, int y, double share, const glm::dvec3& colour,
                 vpe::core::Frame& frame);
  // Finds what a ray meets before the ground at until_m, volumes apart, into scratch_.
  void meet(const SubSquare& part, const ObjectRay& ray, double until_m);
  void meet_posters(const SubSquare& part, const ObjectRay& ray, double until_m);
  std::uint32_t front_of(const ObjectHit& hit) const;
  ObjectColour object_at(const SubSquare& part, const ObjectRay& ray, double until_m, std::uint32_t& front);
  double light_sample(int x, int y, const glm::dvec2& offset) const;
  glm::dvec4 smooth_sample(const SubSquare& part, int x, int y);
  const SeenPixel* beside(int x, int y, const Seen& seen) const;
  void see_pixel(const SubSquare& part, int x, int y);
  void see_light(const SubSquare& part, int x, int y);
  bool is_sparse(const SubSquare& part) const;
  void see_sparsely(const SubSquare& part);
  std::optional<ObjectColour> between(const SubSquare& part, int x, int y) const;
  void paint_pixel(const SubSquare& part, int x, int y, const Seen& seen, vpe::core::Frame& frame);
  void paint_small(const Seen& seen, vpe::core::Frame& frame);
  bool paint_by_area(const PlacedObject& object, const Seen& seen, vpe::core::Frame& frame);
  bool paint_thin(std::uint32_t object, const Seen& seen, vpe::core::Frame& frame);
  void find_thin();
  bool is_met(std::uint32_t object);
  // Return whether rays of the image's pixels meet an object, whatever hides it there; in one pixel, or in any one, if
  // wanted only where the ray of its middle does, too.
  bool is_met_at(std::uint32_t object, int x, int y, std::span<const glm::dvec2> offsets);
  bool is_met(std::uint32_t object, std::span<const glm::dvec2> offsets, bool needs_middle);
  PixelSquare pixels_around(const PlacedObject& object) const;

  Image image_;
  const vpe::core::View& view_;
  vpe::core::SubRectangle drawn_part_;
  PixelSquare square_;
  int frame_width_;
  GroundRanges ground_;
  ViewCone cone_;  // of the square and what lies beside it
  std::vector<PlacedObject> near_to_far_;
  bool may_be_shaded_ = false;
  ObjectNumbers thin_;  // objects that pass between all rays of the image, ascending
  std::optional<ObjectShader> shader_;
  std::optional<VolumeShader> volume_shader_;  // where volumes may show
  ObjectNumbers volumes_;                      // of near_to_far_
  ObjectNumbers posters_;                      // of Image::posters
  std::vector<SeenPixel> seen_;                // empty where a painter of domes draws the square
  const DomePainter* dome_ = nullptr;
  DomeMask dome_mask_;
  SeenPixel dome_seen_;
  SeenPixel nothing_seen_;
  std::vector<SubSquare> parts_;
  RayResult scratch_;
  Drawn drawn_;
};

}  // namespace objects
