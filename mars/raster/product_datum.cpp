#include "mars/raster/product_datum.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>

#include "mars/raster/gdal_scope.h"

namespace mars {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

VerticalDatum datum_of_crs(const OGRSpatialReference& crs) {
  if (crs.IsVertical() != 0) {
    const char* name = crs.GetAttrValue("VERT_CS");
    const char* datum = crs.GetAttrValue("VERT_DATUM");
    const std::string words =
        lower(std::string(name != nullptr ? name : "") + " " + (datum != nullptr ? datum : ""));
    const auto says = [&](const char* word) { return words.find(word) != std::string::npos; };
    if (says("ellipsoid")) return VerticalDatum::ellipsoid(crs.GetSemiMajor(), crs.GetSemiMinor());
    if (says("radius")) return VerticalDatum::radius();
    // Heights of every other vertical datum are counted from an equipotential surface.
    return VerticalDatum::areoid();
  }
  if (crs.GetAxesCount() == 3) return VerticalDatum::ellipsoid(crs.GetSemiMajor(), crs.GetSemiMinor());
  return {};
}

VerticalDatum datum_of_name(const std::string& path) {
  const std::string name = lower(std::filesystem::path(path).filename().string());
  static const std::regex hirise("dt([er])[ep][a-z]_[0-9]{6}_[0-9]{4}_.*");
  static const std::regex hrsc("h[0-9a-z]{4}_[0-9]{4}_d([at])[0-9].*");
  std::smatch match;
  if (std::regex_match(name, match, hirise)) {
    return match[1] == "e" ? VerticalDatum::areoid() : VerticalDatum::radius();
  }
  if (std::regex_match(name, match, hrsc)) {
    return match[1] == "a" ? VerticalDatum::areoid() : VerticalDatum::sphere(3'396'000);
  }
  // The names of both images of the stereo pair come before it.
  static const std::regex ctx(
      "[a-z][0-9]{2}_[0-9]{6}_[0-9]{4}_x[a-z]_[0-9]{2}[ns][0-9]{3}w.*-dem(-geoid-adj)?(\\.[a-z]+)*");
  if (std::regex_match(name, match, ctx)) {
    return match[1].matched ? VerticalDatum::areoid() : VerticalDatum::sphere(3'396'190);
  }
  if (name.starts_with("mars_mgs_mola_dem") || name.starts_with("mars_hrsc_mola_blenddem")) {
    return VerticalDatum::areoid();
  }
  return {};
}

}  // namespace

ProductDatum product_datum(const std::string& path, GDALDataset& dataset,
                           const std::optional<PdsLabel>& label) {
  const GdalScope scope;
  if (label) {
    const VerticalDatum datum = pds_datum(*label);
    if (datum.is_known()) return {datum, false};
  }
  const OGRSpatialReference* crs = dataset.GetSpatialRef();
  if (crs != nullptr) {
    const VerticalDatum datum = datum_of_crs(*crs);
    if (datum.is_known()) return {datum, false};
  }
  const VerticalDatum datum = datum_of_name(path);
  return {datum, datum.is_known()};
}

double body_radius_m(GDALDataset& dataset) {
  const GdalScope scope;
  const OGRSpatialReference* crs = dataset.GetSpatialRef();
  if (crs == nullptr) return 0;
  OGRErr error = OGRERR_NONE;
  const double radius_m = crs->GetSemiMajor(&error);
  return error == OGRERR_NONE ? radius_m : 0;
}

}  // namespace mars
