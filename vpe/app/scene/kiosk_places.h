// Places of the kiosks of a scene file, also of those beside the hotspots of a file.
#pragma once

#include <string>
#include <vector>

#include "objects/files/scene_file.h"

namespace vpe::app {

struct KioskPlace {
  std::string name;  // "": none
  objects::Placing placing;
};

// Returns the kiosks of a scene, in the order of its entries. Those of a file of hotspots have the names of these. Throws
// base::FileError for a file that cannot be read, and std::runtime_error "FILE:LINE: what" for what is wrong in it.
std::vector<KioskPlace> kiosk_places(const objects::SceneFile& scene, double planet_radius_m);

}  // namespace vpe::app
