// Fingerprints of images: digests of everything that an image depends on.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vpe/core/backend.h"
#include "vpe/core/frame.h"
#include "vpe/core/stereo.h"

namespace vpe::app {

class SceneDigests;

// Inputs of an image beside its DrawRequest. The number of threads is not among them: it changes no pixel.
struct RenderBasis {
  std::string program;  // version
  std::string planet;   // PlanetMeta::identity
  core::Backend backend = core::Backend::kPolygon;
  int memory_mb = 0;  // bounds the number of triangles and the textures
  // Keeps what images of scenes depend on, for many fingerprints; null: it is read for each.
  std::shared_ptr<SceneDigests> scenes = nullptr;
};

// Describes how an image is made of others.
struct FingerprintOrigin {
  std::optional<core::StereoPair> stereo;
  std::optional<double> carried_gap_px;  // of a second eye that is carried from the first
  // The key frame whose pixels a frame of a film takes.
  struct Reuse {
    std::string key;  // its fingerprint
    double most_added_px = 0;
    glm::ivec2 margin_px{};  // of the key frame
  };
  std::optional<Reuse> reuse;
  std::vector<std::string> ground = {};  // what changes the ground of the planet file; a line each
};

// Returns a digest of everything that the image depends on, so that equal fingerprints mean equal images. Files
// that the settings name count by their content. The name of the flight and the number of the frame do not
// count; the time counts only where the image shows it. In stereo the request is that of the middle between both
// eyes. Throws base::FileError.
std::string fingerprint_of(const RenderBasis& basis, const core::DrawRequest& request,
                           const core::Settings& settings, double time_s = 0,
                           const FingerprintOrigin& origin = {});

}  // namespace vpe::app
