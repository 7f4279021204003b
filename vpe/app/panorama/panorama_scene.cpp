#include "vpe/app/panorama/panorama_scene.h"

#include <filesystem>
#include <stdexcept>
#include <string>

#include "vpe/app/cli/digest.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/picture/scene_digests.h"

namespace vpe::app {

void resolve_scene(PanoramaRequest& request) {
  if (request.settings.values().scene.empty()) return;
  const std::string file =
      std::filesystem::absolute(request.settings.values().scene).lexically_normal().string();
  if (const std::string trouble = request.settings.set("scene", file); !trouble.empty())
    throw UsageError("--scene: " + trouble);
  Digest digest;
  for (const std::string& checksum : SceneDigests().of(file).checksums) digest.add(checksum);
  const std::string checksum = digest.hex();
  if (!request.scene_checksum.empty() && request.scene_checksum != checksum) {
    throw std::runtime_error(
        file +
        " or one of its models has changed since the image was made, so its objects differ; "
        "restore the old files, or make a new image with --scene " +
        file);
  }
  request.scene_checksum = checksum;
}

}  // namespace vpe::app
