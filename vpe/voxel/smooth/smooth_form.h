// Which smooth patches an image shows, and how high.
#pragma once

#include "vpe/core/appearance/settings.h"

namespace vpe::voxel {

struct SmoothForm {
  core::RayPatch patch = core::RayPatch::kBicubic;
  double exaggeration = 1;
};

}  // namespace vpe::voxel
