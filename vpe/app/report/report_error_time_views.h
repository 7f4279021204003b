// The views of `vpe report error-time`.
#pragma once

#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "paging/surface/surface.h"

namespace vpe::app {

struct NamedView {
  std::string name;
  std::string about;
  mars::Pose pose;
  bool panorama = false;  // near enough to the ground to look around
};

// Of the embedded Mars: orbit, high oblique, canyon floor, rim, crater, plain, grazing, polar.
std::vector<NamedView> embedded_views(const paging::Surface& surface);

// The same names for any planet: about its roughest and its smoothest finest tile with data, and at the pole.
// Heights go by the posts' spacing there. Throws paging::PlanetError for tiles that cannot be read.
std::vector<NamedView> views_of(const paging::Surface& surface);

}  // namespace vpe::app
