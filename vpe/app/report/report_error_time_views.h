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
  bool panorama = false;  // near enough to the ground for panoramas
};

// Returns the views of the embedded Mars: orbit, high oblique, canyon floor, rim, crater, plain, grazing,
// polar.
std::vector<NamedView> embedded_views(const paging::Surface& surface);

// Returns views of the same names for any planet: at its roughest and its smoothest finest tile with data, and
// at the pole. Heights scale with the post spacing there. Throws paging::PlanetError for tiles that cannot be
// read.
std::vector<NamedView> views_of(const paging::Surface& surface);

}  // namespace vpe::app
