#include "vpe/core/drawn_by.h"

namespace vpe::core {

std::string_view to_string(DrawnBy drawn_by) {
  switch (drawn_by) {
    case DrawnBy::kPolygon: return to_string(Backend::kPolygon);
    case DrawnBy::kRay: return to_string(Backend::kRay);
    case DrawnBy::kAuto: break;
  }
  return "auto";
}

DrawnBy drawn_by(std::optional<Backend> named) {
  if (!named) return DrawnBy::kAuto;
  return *named == Backend::kRay ? DrawnBy::kRay : DrawnBy::kPolygon;
}

std::optional<Backend> named_backend(DrawnBy drawn_by) {
  if (drawn_by == DrawnBy::kAuto) return std::nullopt;
  return drawn_by == DrawnBy::kRay ? Backend::kRay : Backend::kPolygon;
}

Backend backend_for(DrawnBy drawn_by, const BackendInput& input) {
  constexpr double kKept = 0.1;
  if (drawn_by == DrawnBy::kPolygon) return Backend::kPolygon;
  if (drawn_by == DrawnBy::kRay) return Backend::kRay;
  if (input.has_gpu || !input.suits_rays) return Backend::kPolygon;
  const double reach = kRaysReach_radii * (input.now == Backend::kRay ? 1 + kKept : 1 - kKept);
  return input.height_radii < reach ? Backend::kRay : Backend::kPolygon;
}

}  // namespace vpe::core
