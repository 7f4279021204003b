#include "mars/raster/iau_crs.h"

#include <cpl_conv.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace mars {
namespace {

constexpr std::string_view kLocalName = "GCS Name = ";

// Returns the name of the system. GeoTIFF keeps that of a local one among others.
std::string name_of(const OGRSpatialReference& crs) {
  const char* name = crs.GetName();
  std::string text = name == nullptr ? "" : name;
  if (!text.starts_with(kLocalName)) return text;
  text.erase(0, kLocalName.size());
  return text.substr(0, text.find('|'));
}

bool counts_west(const OGRSpatialReference& crs) {
  for (int i = 0; i < 2; ++i) {
    OGRAxisOrientation orientation = OAO_Other;
    crs.GetAxis(nullptr, i, &orientation);
    if (orientation == OAO_West) return true;
  }
  return false;
}

bool is_close(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(1.0, std::abs(a)); }

bool same_map(const OGRSpatialReference& a, const OGRSpatialReference& b) {
  if (!is_close(a.GetSemiMajor(), b.GetSemiMajor()) ||
      std::abs(a.GetInvFlattening() - b.GetInvFlattening()) > 1e-6) {
    return false;
  }
  if (a.IsProjected() != b.IsProjected()) return false;
  if (a.IsProjected() == 0) return true;
  return std::ranges::all_of(
      std::array{SRS_PP_CENTRAL_MERIDIAN, SRS_PP_LATITUDE_OF_ORIGIN, SRS_PP_STANDARD_PARALLEL_1,
                 SRS_PP_STANDARD_PARALLEL_2, SRS_PP_LONGITUDE_OF_CENTER, SRS_PP_LATITUDE_OF_CENTER,
                 SRS_PP_SCALE_FACTOR, SRS_PP_FALSE_EASTING, SRS_PP_FALSE_NORTHING},
      [&](const char* key) { return is_close(a.GetNormProjParm(key, 0), b.GetNormProjParm(key, 0)); });
}

}  // namespace

std::string plain_crs_name(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      text += c;
    } else if (!text.empty() && text.back() != '_') {
      text += '_';
    }
  }
  if (text.ends_with('_')) text.pop_back();
  return text;
}

std::optional<std::string> iau_code(std::string_view plain_name) {
  int count = 0;
  OSRCRSInfo** list = OSRGetCRSInfoListFromDatabase("IAU_2015", nullptr, &count);
  std::optional<std::string> code;
  for (int i = 0; i < count && !code; ++i) {
    if (plain_name == plain_crs_name(list[i]->pszName)) code = list[i]->pszCode;
  }
  OSRDestroyCRSInfoList(list);
  return code;
}

std::optional<OGRSpatialReference> restored_iau_crs(const OGRSpatialReference& crs) {
  const std::string name = plain_crs_name(name_of(crs));
  const bool local = crs.IsLocal() != 0;
  // The list of all names is long.
  const bool graphic = name.find("_2015_Ographic") != std::string::npos;
  const bool centric = local && name.find("_2015_Ocentric") != std::string::npos;
  if (!(graphic && !counts_west(crs)) && !centric) return std::nullopt;
  const auto code = iau_code(name);
  OGRSpatialReference found;
  if (!code || found.SetFromUserInput(("IAU_2015:" + *code).c_str()) != OGRERR_NONE) return std::nullopt;
  if (!local && !same_map(crs, found)) return std::nullopt;
  if (found.IsGeographic() != 0) found.SetDataAxisToSRSAxisMapping({2, 1});
  return found;
}

bool remove_iau_codes(OGRSpatialReference& crs) {
  const char* authority = crs.GetAuthorityName(nullptr);
  if (authority == nullptr || !std::string_view(authority).starts_with("IAU")) return false;
  char* exported = nullptr;
  const std::array<const char*, 3> options{"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  const bool done = crs.exportToWkt(&exported, options.data()) == OGRERR_NONE;
  std::string wkt = exported == nullptr ? "" : exported;
  CPLFree(exported);
  static const std::regex code(",ID\\[\"IAU[^\\]]*\\]");
  OGRSpatialReference without;
  if (!done || without.importFromWkt(std::regex_replace(wkt, code, "").c_str()) != OGRERR_NONE) return false;
  without.SetDataAxisToSRSAxisMapping(crs.GetDataAxisToSRSAxisMapping());
  crs = without;
  return true;
}

bool correct_axis_order(OGRSpatialReference& crs, const std::array<double, 6>& to_map, const PixelGrid& grid) {
  if (crs.IsGeographic() == 0 || !counts_west(crs)) return true;
  const std::vector<int> mapping = crs.GetDataAxisToSRSAxisMapping();
  if (mapping.size() < 2) return true;
  OGRAxisOrientation first = OAO_Other;
  crs.GetAxis(nullptr, 0, &first);
  const double quarter = std::asin(1.0) / crs.GetAngularUnits();
  // Returns whether the centres of the outermost pixels are latitudes along map coordinate x or y.
  const auto are_latitudes = [&](std::size_t axis) {
    const double* g = to_map.data() + 3 * axis;
    for (const double column : {0.5, grid.width - 0.5}) {
      for (const double row : {0.5, grid.height - 0.5}) {
        if (std::abs(g[0] + column * g[1] + row * g[2]) > quarter * (1 + 1e-9)) return false;
      }
    }
    return true;
  };
  // mapping[k] is the axis of the system, counted from 1, of map coordinate k.
  const int lat_axis = first == OAO_North || first == OAO_South ? 1 : 2;
  const std::size_t lat_at = mapping[0] == lat_axis ? 0 : 1;
  if (are_latitudes(lat_at)) return !are_latitudes(1 - lat_at);
  if (are_latitudes(1 - lat_at)) crs.SetDataAxisToSRSAxisMapping({mapping[1], mapping[0]});
  return true;
}

}  // namespace mars
