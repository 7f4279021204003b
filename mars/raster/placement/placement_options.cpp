#include "mars/raster/placement/placement_options.h"

namespace mars {

std::optional<GcpMethod> parse_gcp_method(std::string_view text) {
  if (text == "polynomial1") return GcpMethod::kPolynomial1;
  if (text == "polynomial2") return GcpMethod::kPolynomial2;
  if (text == "polynomial3") return GcpMethod::kPolynomial3;
  if (text == "tps") return GcpMethod::kSpline;
  return std::nullopt;
}

}  // namespace mars
