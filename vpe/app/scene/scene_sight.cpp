#include "vpe/app/scene/scene_sight.h"

#include <optional>
#include <utility>

#include "objects/draw/single_ray.h"
#include "vpe/app/scene/scene_library.h"

namespace vpe::app {

namespace {

// Holds the models of a scene, which are read for the first line of sight.
struct SightLibrary {
  std::shared_ptr<const paging::Surface> surface;
  std::optional<SceneLibrary> library = std::nullopt;

  vpe::explore::SceneSight open(const vpe::explore::SightScene& named) {
    if (!library) library.emplace(*surface);
    PlacedScene placed = library->scene(named.file, 1, named.time_s, named.tracks.get());
    (void)library->take_notes();  // images tell them
    const auto first_object = [scene = std::move(placed.scene)](
                                  const glm::dvec3& from_m, const glm::dvec3& direction,
                                  double until_m) -> std::optional<vpe::explore::SightObject> {
      const auto met = objects::first_object(*scene, {from_m, direction}, until_m);
      if (!met) return std::nullopt;
      return vpe::explore::SightObject{met->range_m, object_name(*scene, met->instance)};
    };
    return {first_object, placed.moves};
  }
};

}  // namespace

vpe::explore::OpenScene scene_sight(std::shared_ptr<const paging::Surface> surface) {
  auto library = std::make_shared<SightLibrary>(SightLibrary{std::move(surface)});
  return [library](const vpe::explore::SightScene& scene) { return library->open(scene); };
}

}  // namespace vpe::app
