#include "mars/sources/source_checks.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "vpe/base/number.h"
#include "vpe/base/quantile.h"

namespace mars {
namespace {

constexpr std::size_t kRangePosts = 400;
constexpr std::size_t kDatumPosts = 20'000;
constexpr std::size_t kFewestPlaces = 12;  // fewer places decide nothing

std::string in_metres(double value, int decimals = 1) {
  return vpe::base::format_fixed(value, decimals) + " m";
}

// Returns how --datum names a raster.
std::string option_name(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  return name.empty() ? path : name;
}

// Throws for one pair of sources if their difference exceeds what one datum allows. Reorders `off_m`.
void check_difference(const std::string& layer, const std::string& base, bool layer_is_silent,
                      const VerticalDatum& datum, std::vector<double>& off_m) {
  if (off_m.size() < kFewestPlaces) return;
  const double median_m = vpe::base::median_upper(off_m);
  std::vector<double> away_m(off_m.size());
  std::ranges::transform(off_m, away_m.begin(), [median_m](double off) { return std::abs(off - median_m); });
  const double spread_m = 1.4826 * vpe::base::median_upper(away_m);
  if (std::abs(median_m) <= std::min(kDatumStep_m, kDatumSpreads * std::max(spread_m, kLeastSpread_m))) return;
  const std::string silent = layer_is_silent ? layer : base;
  const std::string other = layer_is_silent ? base : layer;
  const std::string option = "--datum " + option_name(silent) + "=";
  throw SourceError(silent + " does not state its vertical datum, and where both have data " + layer +
                    " lies " + in_metres(std::abs(median_m)) + (median_m < 0 ? " below " : " above ") + base +
                    " (median of " + std::to_string(off_m.size()) + " places, robust spread " +
                    in_metres(spread_m) + "); name its datum (" + option + "areoid or " + option +
                    "sphere:RADIUS_M; --to-datum converts it), or state that it is that of " + other + " (" +
                    option + (datum.is_known() ? to_string(datum) : "same") + ") and the difference is real");
}

}  // namespace

void check_body(const SourceInfo& info, double radius_m) {
  if (info.body_radius_m <= 0 || std::abs(info.body_radius_m / radius_m - 1) <= kBodyMismatch) return;
  throw SourceError(info.name + ": its body has a radius of " + in_metres(info.body_radius_m, 0) +
                    ", but the planet has one of " + in_metres(radius_m, 0) +
                    "; name the body (--body or --radius), or leave this raster out");
}

void check_range(const ElevationSource& source, const SourceInfo& info, double radius_m,
                 std::vector<std::string>& notes) {
  double low_m = std::numeric_limits<double>::infinity();
  double high_m = -low_m;
  source.visit_posts(kRangePosts, [&](std::span<const glm::dvec3>, std::span<const double> heights_m) {
    for (const double h : heights_m) {
      if (!std::isfinite(h)) continue;
      low_m = std::min(low_m, h);
      high_m = std::max(high_m, h);
    }
  });
  if (!(low_m <= high_m)) return;
  const std::string range =
      info.name + ": its values lie between " + in_metres(low_m, 0) + " and " + in_metres(high_m, 0);
  const std::string planet = "the planet's radius of " + in_metres(radius_m, 0);
  const bool are_radii = low_m > 0.5 * radius_m && high_m < 1.5 * radius_m;
  const bool is_radius = info.datum.kind == DatumKind::kRadius;
  if (are_radii && !is_radius) {
    throw SourceError(range + ", about " + planet +
                      ": they are distances from its centre, not heights; state that (" + "--datum " +
                      option_name(info.name) + "=radius)");
  }
  if (is_radius && high_m < 0.5 * radius_m) {
    throw SourceError(range + ", far below " + planet +
                      ": they are no distances from its centre; name another datum (" + "--datum " +
                      option_name(info.name) + "=DATUM)");
  }
  if (high_m - low_m > radius_m) {
    notes.push_back(range + ", over more than " + planet +
                    "; check its nodata value and its unit (gdalinfo -stats), and the body (--body, --radius)");
  }
}

void check_silent_datums(const ElevationSource& layer, const ElevationSource& base,
                         const std::set<std::string>& silent, const std::set<std::string>& same) {
  const std::vector<SourceInfo> below = base.infos();
  const SourceInfo own = layer.infos().front();
  const bool layer_is_silent = silent.contains(own.name);
  const auto is_checked = [&](const std::string& name) {
    return !same.contains(own.name) && !same.contains(name) && (layer_is_silent || silent.contains(name));
  };
  if (std::ranges::none_of(below, [&](const SourceInfo& info) { return is_checked(info.name); })) return;
  std::map<int, std::vector<double>> off_m;  // by the base's source
  std::vector<double> base_m;
  std::vector<int> origin;
  layer.visit_posts(kDatumPosts,
                    [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
                      base_m.resize(directions.size());
                      origin.resize(directions.size());
                      base.sample(directions, 0, base_m);
                      base.origin(directions, origin);
                      for (std::size_t i = 0; i < base_m.size(); ++i) {
                        if (origin[i] >= 0 && std::isfinite(heights_m[i] - base_m[i]))
                          off_m[origin[i]].push_back(heights_m[i] - base_m[i]);
                      }
                    });
  for (auto& [source, off] : off_m) {
    const std::string& name = below.at(static_cast<std::size_t>(source)).name;
    if (is_checked(name)) check_difference(own.name, name, layer_is_silent, own.datum, off);
  }
}

}  // namespace mars
