#include "vpe/app/scene/placed_parts.h"

#include <limits>

#include "vpe/app/scene/scene_library.h"

namespace vpe::app {

namespace {

constexpr double kVoxelsOfPart = 128;

}  // namespace

std::vector<objects::ObjectSpan> part_spans(const PlacedPart& part, const glm::dvec3& up) {
  return objects::object_spans(*part.scene, {glm::dvec3(0), up}, std::numeric_limits<double>::infinity(),
                               part.role.solid_above_per_m);
}

std::shared_ptr<const core::GroundParts> ground_parts(const PlacedParts& parts, double planet_radius_m) {
  if (parts.empty()) return nullptr;
  auto made = std::make_shared<core::GroundParts>();
  for (const PlacedPart& part : parts) {
    const objects::SceneBall ball = part.scene->ball(0);
    core::GroundPart one;
    one.name = object_name(*part.scene, 0);
    one.is_cut = part.role.kind == objects::GroundRole::Kind::kCut;
    one.centre_m = ball.centre_m;
    one.radius_m = ball.radius_m;
    one.voxel_m = part.role.voxel_m > 0 ? part.role.voxel_m : 2 * ball.radius_m / kVoxelsOfPart;
    one.solids = [part, planet_radius_m](const glm::dvec3& up, std::vector<core::SolidSpan>& solids) {
      for (const objects::ObjectSpan& span : part_spans(part, up)) {
        if (span.end_m > span.begin_m)
          solids.push_back({span.begin_m - planet_radius_m, span.end_m - planet_radius_m});
      }
    };
    made->push_back(std::move(one));
  }
  return made;
}

}  // namespace vpe::app
