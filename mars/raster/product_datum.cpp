#include "mars/raster/product_datum.h"

#include <cpl_json.h>
#include <cpl_minixml.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>

#include "mars/geodesy/bodies.h"
#include "mars/raster/gdal/gdal_scope.h"

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

std::string first_metadata_of(GDALDataset& dataset, const char* domain) {
  char** lines = dataset.GetMetadata(domain);
  return lines == nullptr || lines[0] == nullptr ? "" : lines[0];
}

// Returns the target that a label names.
std::string target_of(GDALDataset& dataset, const std::optional<PdsLabel>& label) {
  if (label) {
    std::string name = label->text("TARGET_NAME");
    std::erase(name, '"');
    return name;
  }
  CPLJSONDocument isis;
  const std::string text = first_metadata_of(dataset, "json:ISIS3");
  if (!text.empty() && isis.LoadMemory(text)) return isis.GetRoot().GetString("IsisCube/Mapping/TargetName");
  const std::string xml = first_metadata_of(dataset, "xml:PDS4");
  if (xml.empty()) return "";
  CPLXMLTreeCloser root(CPLParseXMLString(xml.c_str()));
  if (root.get() == nullptr) return "";
  CPLStripXMLNamespace(root.get(), nullptr, TRUE);
  CPLXMLNode* target = CPLSearchXMLNode(root.get(), "Target_Identification");
  return target == nullptr ? "" : CPLGetXMLValue(target, "name", "");
}

// Returns the body among the words of a name, such as "GCS_Moon_2000" or "Vesta (2015) - Sphere".
const Body* body_among(const std::string& words) {
  static const std::regex word("[A-Za-z]+");
  for (std::sregex_iterator at(words.begin(), words.end(), word), end; at != end; ++at) {
    if (const Body* body = find_body(std::string_view(at->str()))) return body;
  }
  return nullptr;
}

}  // namespace

std::string body_name(GDALDataset& dataset, const std::optional<PdsLabel>& label) {
  const GdalScope scope;
  std::string target = target_of(dataset, label);
  if (const Body* body = body_among(target)) return std::string(body->name);
  if (std::ranges::any_of(target, [](unsigned char c) { return std::isalpha(c) != 0; }) &&
      target.find("${") == std::string::npos) {
    target = lower(target);
    target[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(target[0])));
    return target;
  }
  const OGRSpatialReference* crs = dataset.GetSpatialRef();
  if (crs == nullptr) return "";
  for (const char* part : {"PROJCS", "GEOGCS", "DATUM"}) {
    const char* name = crs->GetAttrValue(part);
    const Body* body = name == nullptr ? nullptr : body_among(name);
    if (body != nullptr) return std::string(body->name);
  }
  return "";
}

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
