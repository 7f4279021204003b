#include "vpe/app/viewshed/observers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "vpe/base/number.h"

namespace vpe::app {

map::GridFrame frame_of_observer(mars::LonLat place, const ViewshedRequest& request, double radius_m) {
  const double posts = std::floor(request.reach_m / request.spacing_m * (1 + 1e-12));
  const double all = (2 * posts + 1) * (2 * posts + 1);
  if (all > static_cast<double>(map::kMostGridPosts)) {
    throw std::invalid_argument("posts " + base::format_significant(request.spacing_m, 6) + " m apart within " +
                                base::format_significant(request.reach_m, 6) + " m are " +
                                base::format_significant(all / 1e6, 3) + " million; at most " +
                                std::to_string(map::kMostGridPosts / 1'000'000) +
                                " million are possible: choose a larger --spacing or a smaller --radius");
  }
  map::GridFrame frame{map::LocalMap(place, radius_m)};
  frame.first_m = {-posts * request.spacing_m, posts * request.spacing_m};
  frame.spacing_m = request.spacing_m;
  frame.columns = frame.rows = 2 * static_cast<int>(posts) + 1;
  return frame;
}

ObserverMap look_around(const paging::Surface& surface, const Observer& observer,
                        const ViewshedRequest& request, int threads,
                        const std::function<void(double)>& progress) {
  const double radius_m = surface.planet_radius_m();
  ObserverMap seen{frame_of_observer(observer.place, request, radius_m), {}, {}, 0};
  map::GroundGrid ground = map::sample_ground(surface, seen.frame, threads, progress);
  seen.ground = std::move(ground.ground);
  map::ViewshedOptions options;
  options.column = options.row = seen.frame.columns / 2;
  options.observer_height_m = observer.height_m;
  options.target_height_m = request.target_height_m;
  options.radius_m = radius_m;
  options.reach_m = request.reach_m;
  seen.elevation_m = double{ground.heights.at(options.column, options.row)};
  if (std::isnan(seen.elevation_m)) {
    throw std::runtime_error("no source has data at the observer " +
                             base::format_number(observer.place.lon_deg) + "," +
                             base::format_number(observer.place.lat_deg) +
                             ", so that the height of the eye is not known; choose a place with data");
  }
  base::ThreadPool pool(threads);
  if (request.needed) {
    seen.value = map::needed_heights(ground.heights, options, pool).heights_m;
    return seen;
  }
  const map::Viewshed shed = map::viewshed(ground.heights, options, pool);
  seen.value = std::move(ground.heights.heights_m);
  std::ranges::transform(shed.sights, seen.value.begin(), [](map::Sight sight) {
    return sight == map::Sight::unknown ? std::numeric_limits<float>::quiet_NaN()
                                        : (sight == map::Sight::seen ? 1.0F : 0.0F);
  });
  return seen;
}

void add_observer(const ObserverMap& seen, const ViewshedRequest& request,
                  const std::vector<glm::dvec2>& places_deg, std::vector<float>& sums) {
  for (std::size_t n = 0; n < places_deg.size(); ++n) {
    if (!std::isfinite(places_deg[n].x) || !std::isfinite(places_deg[n].y)) continue;
    const glm::dvec2 at = glm::round(seen.frame.to_grid({places_deg[n].x, places_deg[n].y}));
    if (!(at.x >= 0 && at.y >= 0 && at.x < seen.frame.columns && at.y < seen.frame.rows)) continue;
    const float value =
        seen.value[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(seen.frame.columns) +
                   static_cast<std::size_t>(at.x)];
    if (std::isnan(value)) continue;
    float& sum = sums[n];
    if (std::isnan(sum)) {
      sum = value;
    } else {
      sum = request.needed ? std::min(sum, value) : sum + value;
    }
  }
}

}  // namespace vpe::app
