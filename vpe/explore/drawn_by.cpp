#include "vpe/explore/drawn_by.h"

namespace vpe::explore {

std::string_view to_string(DrawnBy drawn_by) {
  switch (drawn_by) {
    case DrawnBy::kPolygon: return core::to_string(core::Backend::kPolygon);
    case DrawnBy::kRay: return core::to_string(core::Backend::kRay);
    case DrawnBy::kAuto: break;
  }
  return "auto";
}

DrawnBy drawn_by(std::optional<core::Backend> named) {
  if (!named) return DrawnBy::kAuto;
  return *named == core::Backend::kRay ? DrawnBy::kRay : DrawnBy::kPolygon;
}

core::Backend backend_for(DrawnBy drawn_by, const BackendInput& input) {
  constexpr double kKept = 0.1;
  if (drawn_by == DrawnBy::kPolygon) return core::Backend::kPolygon;
  if (drawn_by == DrawnBy::kRay) return core::Backend::kRay;
  if (input.has_gpu || !input.suits_rays) return core::Backend::kPolygon;
  const double reach = core::kRaysReach_radii * (input.now == core::Backend::kRay ? 1 + kKept : 1 - kKept);
  return input.height_radii < reach ? core::Backend::kRay : core::Backend::kPolygon;
}

}  // namespace vpe::explore
