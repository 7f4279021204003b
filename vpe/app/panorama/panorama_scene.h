// The scene of a panorama, as its recipe has it.
#pragma once

#include "vpe/app/panorama/panorama_request.h"

namespace vpe::app {

// Makes the path of the scene file absolute, so that the recipe is valid in any folder, and stores the checksum of the file
// and its models in request.scene_checksum. Throws what objects::read_scene_file() throws, base::FileError, and
// std::runtime_error if the request has another checksum already: the objects would differ from those of the sidecar's
// image.
void resolve_scene(PanoramaRequest& request);

}  // namespace vpe::app
