#include "mars/vector/iau_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "mars/raster/iau_crs.h"

namespace mars {
namespace {

// ESRI's kind of WKT puts this before the names of geographic systems.
std::string words_of(const std::string& name) {
  std::string text = plain_crs_name(name);
  return text.starts_with("GCS_") ? text.substr(4) : text;
}

std::optional<OGRSpatialReference> system_of(const std::optional<std::string>& code) {
  OGRSpatialReference found;
  if (!code ||
      found.SetFromUserInput(("IAU_2015:" + *code).c_str(),
                             OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) != OGRERR_NONE)
    return std::nullopt;
  return found;
}

bool is_equal(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(1.0, std::abs(a)); }

bool agree(const OGRSpatialReference& a, const OGRSpatialReference& b) {
  if (!is_equal(a.GetSemiMajor(), b.GetSemiMajor()) ||
      std::abs(a.GetInvFlattening() - b.GetInvFlattening()) > 1e-6 || a.IsProjected() != b.IsProjected())
    return false;
  if (a.IsProjected() == 0) return true;
  return std::ranges::all_of(
      std::array{SRS_PP_CENTRAL_MERIDIAN, SRS_PP_LATITUDE_OF_ORIGIN, SRS_PP_STANDARD_PARALLEL_1,
                 SRS_PP_STANDARD_PARALLEL_2, SRS_PP_FALSE_EASTING, SRS_PP_FALSE_NORTHING},
      [&](const char* key) { return is_equal(a.GetNormProjParm(key, 0), b.GetNormProjParm(key, 0)); });
}

}  // namespace

std::optional<OGRSpatialReference> with_iau_axes(const OGRSpatialReference& crs) {
  const char* name = crs.GetName();
  const std::string words = words_of(name == nullptr ? "" : name);
  // Systems of a sphere lose nothing, and the list of all names is long.
  if (words.find("_2015_Ographic") == std::string::npos && words.find("_2015_Ocentric") == std::string::npos)
    return std::nullopt;
  const char* authority = crs.GetAuthorityName(nullptr);
  const char* own_code = crs.GetAuthorityCode(nullptr);
  const bool has_code =
      authority != nullptr && own_code != nullptr && std::string_view(authority).starts_with("IAU");
  auto found = system_of(has_code ? std::optional<std::string>(own_code) : iau_code(words));
  if (!found || !agree(crs, *found)) return std::nullopt;
  return found;
}

std::string iau_sphere_code(const std::string& body, double radius_m) {
  const auto code = iau_code(plain_crs_name(body + " (2015) - Sphere / Ocentric"));
  const auto found = system_of(code);
  return found && found->IsGeographic() != 0 && is_equal(found->GetSemiMajor(), radius_m) &&
                 found->GetInvFlattening() == 0
             ? *code
             : "";
}

}  // namespace mars
