// The model of a kiosk: a post with a sign on each of four sides, which tells that there is a panorama.
#pragma once

#include "objects/model/mesh.h"

namespace objects {

// Returns a kiosk of 1 m from its foot to its top, which stands on z = 0. Its signs show hills under a sky. The same on every
// machine.
Mesh make_kiosk();

}  // namespace objects
