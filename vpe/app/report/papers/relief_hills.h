// Hills as height maps of any resolution, and their images by the caster of relief.
#pragma once

#include <memory>

#include "relief/cast/caster.h"
#include "relief/field/height_map.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"

namespace vpe::app {

inline constexpr double kHillsSide_m = 1000;

struct HillsSpec {
  int posts = 0;  // on a side
  relief::Interpolation interpolation = relief::Interpolation::kBilinear;
  double side_m = kHillsSide_m;
  double vertical_scale = 1;
  bool is_tapered = false;  // heights fall to 0 at the border
};

// Returns a map of the same hills for every number of posts: seven octaves of noise, whose finest waves 1024 posts
// resolve. Its middle is at (0, 0). Throws as relief::HeightMap does.
std::shared_ptr<const relief::HeightMap> hills_map(const HillsSpec& spec);

// Returns the map on the plane z = 0, and nothing beyond its posts.
relief::Surface on_plane(const std::shared_ptr<const relief::HeightMap>& map);

// Returns a view from one place towards another, with z upwards.
core::View view_towards(const glm::dvec3& from_m, const glm::dvec3& at_m, int width, int height,
                        double fov_deg);

// Returns the view of 512 x 512 pixels over a map of kHillsSide_m in which casting is timed.
core::View hills_view();

// Casts a view, and shades the hits by their normals under a light from the side of the camera. The rest is sky.
core::RgbImage draw_relief(const relief::Surface& surface, const core::View& view,
                           const relief::CastOptions& options, base::ThreadPool& pool);

}  // namespace vpe::app
