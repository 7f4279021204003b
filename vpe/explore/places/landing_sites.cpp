#include "vpe/explore/places/landing_sites.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "mars/vector/feature_reader.h"
#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

constexpr std::array<std::string_view, 4> kKinds{"landing", "impact", "predicted", "target"};
constexpr std::size_t kMostSiteBytes = std::size_t{16} << 20;

std::string cell_text(const mars::FieldValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&value)) return base::format_number(*number);
  return {};
}

// Reads the cells of a layer by the names of its columns.
class SiteRows {
 public:
  SiteRows(const mars::FeatureLayer& layer, std::string file) : layer_(layer), file_(std::move(file)) {}

  std::string cell(const mars::Feature& feature, const char* column) const {
    const auto found = std::ranges::find(layer_.fields, column);
    if (found == layer_.fields.end())
      throw std::runtime_error(file_ + ": expected the column " + column + " of landing sites, found none");
    return cell_text(feature.values[static_cast<std::size_t>(found - layer_.fields.begin())]);
  }
  [[noreturn]] void fail(const mars::Feature& feature, const std::string& expected) const {
    throw std::runtime_error(file_ + ", feature " + std::to_string(feature.number) + ": expected " + expected);
  }

 private:
  const mars::FeatureLayer& layer_;
  std::string file_;
};

LandingSite site_of(const SiteRows& rows, const mars::Feature& feature) {
  LandingSite site;
  site.name = rows.cell(feature, "name");
  if (site.name.empty()) rows.fail(feature, "a name, found none");
  const glm::dvec2 at = feature.shapes.front().rings.front().front();
  site.place = {mars::normalize_lon_deg(at.x), at.y};
  site.mission = rows.cell(feature, "mission");
  site.landed = rows.cell(feature, "landed");
  site.kind = rows.cell(feature, "kind");
  if (std::ranges::find(kKinds, site.kind) == kKinds.end())
    rows.fail(feature, "a kind landing, impact, predicted or target, found '" + site.kind + "'");
  const std::string accuracy = rows.cell(feature, "accuracy_m");
  if (accuracy != "unknown") {
    site.accuracy_m = base::parse_number(accuracy);
    if (!site.accuracy_m || *site.accuracy_m < 0)
      rows.fail(feature, "an accuracy in metres or 'unknown', found '" + accuracy + "'");
  }
  site.source = rows.cell(feature, "source");
  return site;
}

}  // namespace

std::vector<LandingSite> read_landing_sites(const std::string& file) {
  mars::FeatureReadOptions options;
  options.most_bytes = kMostSiteBytes;
  std::vector<LandingSite> sites;
  for (const mars::FeatureLayer& layer : mars::read_features(file, options, mars::kMarsRadius_m)) {
    const SiteRows rows(layer, file);
    for (const mars::Feature& feature : layer.features) {
      if (!feature.shapes.empty()) sites.push_back(site_of(rows, feature));
    }
  }
  return sites;
}

core::Place to_place(const LandingSite& site) { return {site.name, site.place.lon_deg, site.place.lat_deg, 0}; }

std::string describe(const LandingSite& site) {
  const std::string kind = site.kind == "predicted" ? "predicted landing" : site.kind;
  return kind + " of " + site.mission + ", " + site.landed + ", accuracy " +
         (site.accuracy_m ? base::format_number(*site.accuracy_m) + " m" : "unknown");
}

}  // namespace vpe::explore
