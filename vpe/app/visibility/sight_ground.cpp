#include "vpe/app/visibility/sight_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vpe/app/planet/measured_part.h"

namespace vpe::app {

SightGround sight_ground(const paging::Surface& surface, mars::LonLat from, mars::LonLat to) {
  const paging::PlanetMeta& meta = surface.planet().meta();
  const glm::dvec3 begin = mars::direction(from);
  const glm::dvec3 end = mars::direction(to);
  const double arc_m = mars::angle_between_rad(begin, end) * surface.planet_radius_m();
  const double spacing_m =
      std::min(paging::query(surface, from).spacing_m, paging::query(surface, to).spacing_m);
  SightGround ground;
  ground.points = static_cast<int>(std::clamp(std::ceil(arc_m / spacing_m) + 1, 2.0, double{kMostSightPoints}));
  ground.finest_spacing_m = std::numeric_limits<double>::infinity();
  for (int n = 0; n < ground.points; ++n) {
    const glm::dvec3 there = mars::slerp(begin, end, n / (ground.points - 1.0));
    const paging::PlaceAnswer answer = paging::query(surface, mars::lon_lat(there));
    const mars::SourceInfo* source = source_of(answer, meta);
    ground.nodata += answer.nodata ? 1 : 0;
    ground.synthetic += !answer.nodata && source != nullptr && source->illustration ? 1 : 0;
    ground.finest_spacing_m = std::min(ground.finest_spacing_m, answer.spacing_m);
    ground.coarsest_spacing_m = std::max(ground.coarsest_spacing_m, answer.spacing_m);
    ground.resampling_posts += answer.resampling.posts;
    if (answer.resampling.posts > 0)
      ground.resampling_max_m = std::max(ground.resampling_max_m, double{answer.resampling.max_m});
    if (source != nullptr && !answer.nodata) ground.sources.insert(source->name);
  }
  return ground;
}

}  // namespace vpe::app
