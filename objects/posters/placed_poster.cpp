#include "objects/posters/placed_poster.h"

#include <cmath>
#include <glm/common.hpp>
#include <stdexcept>
#include <utility>

namespace objects {

PlacedPoster place_entry(const PosterEntry& entry, PosterImage image, double planet_radius_m,
                         const GroundRadius& ground_radius_m) {
  if (!entry.place) throw std::invalid_argument("an image of a scene has no place");
  const mars::LocalFrame frame = mars::local_frame(*entry.place);
  const double base_m =
      entry.height_kind == HeightKind::kAltitude ? planet_radius_m : ground_radius_m(frame.up);
  const glm::dvec3 place_m = (base_m + entry.height_m) * frame.up;
  const double aspect = static_cast<double>(image.width_px) / std::max(1, image.height_px);
  PlacedPoster out;
  out.form = entry.form;
  out.opacity = entry.opacity;
  out.width_m = entry.width_m;
  out.tall_m = entry.tall_m > 0 ? entry.tall_m : entry.width_m / aspect;
  switch (entry.form) {
    case PosterForm::kPane:
      // Who sees the front looks against its heading. Leaning back takes the top away from this viewer.
      out.axes = mars::oriented_axes(frame, entry.heading_deg + 180, -entry.pitch_deg, 0);
      out.middle_m = place_m + 0.5 * out.tall_m * out.axes.up;
      break;
    case PosterForm::kBillboard:
      out.axes = mars::oriented_axes(frame, 0, 0, 0);
      out.middle_m = place_m;
      break;
    case PosterForm::kPhotograph:
      out.axes = mars::oriented_axes(frame, entry.heading_deg, entry.pitch_deg, entry.roll_deg);
      out.middle_m = place_m + entry.distance_m * out.axes.forward;
      out.tall_m = 2 * entry.distance_m * std::tan(0.5 * entry.fov_deg * mars::kRadiansPerDegree);
      out.width_m = out.tall_m * aspect;
      break;
    case PosterForm::kDome:
      out.axes = mars::oriented_axes(frame, entry.heading_deg, 0, 0);
      out.middle_m = place_m;
      out.radius_m = entry.radius_m;
      out.fade_m = entry.fade_m;
      out.is_cylinder = entry.is_cylinder;
      out.replaces_ground = entry.replaces_ground;
      break;
  }
  out.image = std::move(image);
  return out;
}

double dome_share(double distance_m, double fade_m) {
  return 1 - glm::smoothstep(0.5 * fade_m, fade_m, distance_m);
}

}  // namespace objects
