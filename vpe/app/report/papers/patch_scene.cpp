#include "vpe/app/report/papers/patch_scene.h"

#include <system_error>

#include "lod/tree/tile_key.h"
#include "paging/surface/surface.h"

namespace vpe::app {

PatchScene::~PatchScene() {
  build.planet.reset();
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
}

void build_patch_scene(const std::filesystem::path& file, const PatchSceneSpec& spec, PatchScene& scene) {
  constexpr int kFinestLevel = 13;
  const PatchSpec patch{lod::tile_at({mars::Face::kPlusX, 0.17, -0.19}, kFinestLevel - spec.levels),
                        spec.levels};
  scene.file = file;
  scene.build = build_patch(patch, file, spec.threads, [](double) {});
  const glm::dvec3 middle = lod::bounding_cap(patch.patch).centre;
  const mars::LonLat place = mars::lon_lat(middle);
  const double side_m = patch.spacing_m() * (patch.side_posts() - 1);
  const double ground_m = paging::Surface(scene.build.planet, std::size_t{1} << 26).at(middle).height_m;
  scene.pose = {place.lon_deg, place.lat_deg, ground_m + spec.height_share * side_m, 30, 0, 0};
}

}  // namespace vpe::app
