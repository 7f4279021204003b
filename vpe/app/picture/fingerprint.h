// Fingerprints of images: digests of everything that an image depends on.
#pragma once

#include <string>

#include "vpe/core/frame.h"

namespace vpe::app {

// What a frame's image depends on beside its DrawRequest. The number of threads is not among it.
struct FilmBasis {
  std::string program;  // version
  std::string planet;   // PlanetMeta::identity
  std::string backend;
  int memory_mb = 0;  // bounds triangles and textures
};

// Digest of everything the image depends on, so that equal fingerprints mean equal images; of files that
// the settings name, what they hold. Neither the name of the flight nor the number of the frame counts, and its
// time only where the image shows it. Throws base::FileError.
std::string fingerprint_of(const FilmBasis& basis, const core::DrawRequest& request,
                           const core::Settings& settings, double time_s = 0);

}  // namespace vpe::app
