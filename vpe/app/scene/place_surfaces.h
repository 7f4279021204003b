// Finds what lies at a place of a planet with the objects of a scene: the highest object, and all surfaces along the
// vertical.
//
// Typical usage:
//   for (const PlaceSurface& s : surfaces_at(placed, place, ground, radius_m)) tell(s.object, s.height_m);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "objects/scene/scene.h"
#include "vpe/app/scene/scene_library.h"

namespace vpe::app {

// Holds the highest object at a place.
struct ObjectTop {
  std::string name;  // of the object, or of its model
  double top_m = 0;  // above the planet's sphere
};

// Returns the highest object at a place; nullopt if there is none. Any thread may call it.
std::optional<ObjectTop> highest_object(const objects::Scene& scene, const mars::LonLat& place,
                                        double planet_radius_m);

// Describes the ground at a place.
struct PlaceGround {
  double height_m = 0;           // above the planet's sphere
  double geometric_error_m = 0;  // of this height
  bool nodata = false;
};

// Describes a surface that the vertical through a place meets.
struct PlaceSurface {
  std::optional<std::string> object;  // the name of the object, or of its model; nullopt: the ground
  bool is_top = true;                 // air above, solid below; else an underside
  double height_m = 0;                // above the planet's sphere
  // Bounds the distance of the place on the vertical from the surface that the ground or the model stands for.
  // Where the surface is steep, heights differ by more (objects/draw/object_spans.h).
  double geometric_error_m = 0;
  bool nodata = false;  // the ground has no data: its height is that of the drawn surface
};

// Returns the surfaces along the vertical through a place, from the highest to the lowest, and the ground last
// where it has no data. Every object and the ground alternate between tops and undersides; surfaces of different
// objects and of the ground are all there, also where they lie in one another. The ground has more than one where
// something is cut out of it. At equal heights an underside comes before the top below it, and the ground last.
// Without a scene and parts it is the ground alone. Any thread may call it.
std::vector<PlaceSurface> surfaces_at(const PlacedScene& placed, const mars::LonLat& place,
                                      const PlaceGround& ground, double planet_radius_m);

}  // namespace vpe::app
