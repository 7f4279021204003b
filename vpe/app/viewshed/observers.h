// What observers on a planet see, each on a map around itself.
#pragma once

#include <functional>
#include <vector>

#include "paging/surface/surface.h"
#include "vpe/map/ground_grid.h"
#include "vpe/map/viewshed/viewshed.h"

namespace vpe::app {

// Describes an observer on the ground of a planet.
struct Observer {
  mars::LonLat place;   // planetocentric
  double height_m = 2;  // of the eye above the ground
};

// Holds what all observers share.
struct ViewshedRequest {
  std::vector<Observer> observers;
  double target_height_m = 0;
  double reach_m = 0;    // along the ground, from each observer
  double spacing_m = 0;  // between posts
  bool needed = false;   // heights that targets need, instead of verdicts
};

// Holds what one observer sees, on the azimuthal equidistant map around it.
struct ObserverMap {
  map::GridFrame frame;      // the observer is its middle post
  std::vector<float> value;  // by rows: 1 seen, 0 hidden, or metres; NaN where it is not known
  map::MapGround ground;     // under the posts
  double elevation_m = 0;    // of the observer's ground
};

// Returns the square of posts around a place that holds the reach. Throws std::invalid_argument for more posts than
// map::kMostGridPosts.
map::GridFrame frame_of_observer(mars::LonLat place, const ViewshedRequest& request, double radius_m);

// Computes what an observer sees. Calls progress() as map::sample_ground() does. The result does not depend on `threads`.
// Throws std::runtime_error where the observer's ground has no data, paging::PlanetError, and as frame_of_observer().
ObserverMap look_around(const paging::Surface& surface, const Observer& observer,
                        const ViewshedRequest& request, int threads,
                        const std::function<void(double)>& progress);

// Adds what an observer sees at places (degrees east and north) to that of others, by the nearest post: numbers of
// observers, or the least height that any of them needs. NaN: not known to any observer so far.
void add_observer(const ObserverMap& seen, const ViewshedRequest& request,
                  const std::vector<glm::dvec2>& places_deg, std::vector<float>& sums);

}  // namespace vpe::app
