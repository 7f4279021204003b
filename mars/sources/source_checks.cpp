#include "mars/sources/source_checks.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <map>

#include "mars/geodesy/sphere.h"
#include "vpe/base/number.h"
#include "vpe/base/quantile.h"

namespace mars {
namespace {

constexpr std::size_t kRangePosts = 400;
constexpr std::size_t kDatumPosts = 20'000;
constexpr std::size_t kReliefPlaces = 200;
constexpr std::size_t kFewestPlaces = 12;  // fewer places decide nothing

std::string in_metres(double value, int decimals = 1) {
  return vpe::base::format_fixed(value, decimals) + " m";
}

// Returns how --datum names a raster.
std::string option_name(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  return name.empty() ? path : name;
}

// Holds the differences of a layer from one source of its base.
struct Differences {
  std::vector<double> off_m;  // layer minus base
  std::vector<glm::dvec3> places;
};

// Returns the area of places of about even density, as that of a rectangle with their second moments, in square
// radians.
double area_of(std::span<const glm::dvec3> places) {
  glm::dvec3 sum(0);
  for (const glm::dvec3& place : places) sum += place;
  const LocalFrame frame = local_frame(lon_lat(glm::normalize(sum)));
  glm::dvec2 mean(0);
  glm::dmat2 squares(0);
  for (const glm::dvec3& place : places) {
    const glm::dvec2 p(glm::dot(place, frame.east), glm::dot(place, frame.north));
    mean += p;
    squares += glm::outerProduct(p, p);
  }
  const auto count = static_cast<double>(places.size());
  mean /= count;
  const double determinant = glm::determinant(squares / count - glm::outerProduct(mean, mean));
  return 12 * std::sqrt(std::max(determinant, 0.0));
}

// Returns the difference that the base's relief between its posts explains, see kReliefShare.
double explained_m(const ElevationSource& base, double radius_m, std::span<const glm::dvec3> places) {
  const std::size_t step = std::max<std::size_t>(1, places.size() / kReliefPlaces);
  std::vector<glm::dvec3> around;  // five for each place
  std::vector<double> spacings_m;
  for (std::size_t n = 0; n < places.size(); n += step) {
    const double spacing_m = base.spacing_in({places[n], 0});
    if (!std::isfinite(spacing_m)) continue;
    spacings_m.push_back(spacing_m);
    const glm::dvec3 u = any_perpendicular(places[n]);
    const glm::dvec3 v = glm::cross(places[n], u);
    const double half_rad = 0.5 * spacing_m / radius_m;
    for (const glm::dvec3& way : {glm::dvec3(0), u, -u, v, -v})
      around.push_back(glm::normalize(places[n] + half_rad * way));
  }
  if (spacings_m.empty()) return 0;
  std::vector<double> heights_m(around.size());
  base.sample(around, 0, heights_m);
  std::vector<double> ranges_m;
  for (std::size_t n = 0; n + 5 <= heights_m.size(); n += 5) {
    const auto [low, high] = std::minmax_element(heights_m.begin() + static_cast<std::ptrdiff_t>(n),
                                                 heights_m.begin() + static_cast<std::ptrdiff_t>(n + 5));
    if (std::isfinite(*high - *low)) ranges_m.push_back(*high - *low);
  }
  if (ranges_m.empty()) return 0;
  const double spacing_rad = vpe::base::median_upper(spacings_m) / radius_m;
  const double posts = std::max(1.0, area_of(places) / (spacing_rad * spacing_rad));
  return kReliefShare * vpe::base::median_upper(ranges_m) / std::sqrt(posts);
}

// Throws for one pair of sources if their difference exceeds what one datum allows. `explained` returns what the
// base's relief explains. Reorders `off_m`.
void check_difference(const std::string& layer, const std::string& base, bool layer_is_silent,
                      const VerticalDatum& datum, const std::function<double()>& explained,
                      std::vector<double>& off_m) {
  if (off_m.size() < kFewestPlaces) return;
  const double median_m = vpe::base::median_upper(off_m);
  std::vector<double> away_m(off_m.size());
  std::ranges::transform(off_m, away_m.begin(), [median_m](double off) { return std::abs(off - median_m); });
  const double spread_m = 1.4826 * vpe::base::median_upper(away_m);
  if (std::abs(median_m) <= std::min(kDatumStep_m, kDatumSpreads * std::max(spread_m, kLeastSpread_m))) return;
  const double between_posts_m = explained();
  if (std::abs(median_m) <= between_posts_m) return;
  const std::string silent = layer_is_silent ? layer : base;
  const std::string other = layer_is_silent ? base : layer;
  const std::string option = "--datum " + option_name(silent) + "=";
  throw SourceError(silent + " does not state its vertical datum, and where both have data " + layer +
                    " lies " + in_metres(std::abs(median_m)) + (median_m < 0 ? " below " : " above ") + base +
                    " (median of " + std::to_string(off_m.size()) + " places, robust spread " +
                    in_metres(spread_m) + "; relief between the coarser posts explains " +
                    in_metres(between_posts_m) + "); name its datum (" + option + "areoid or " + option +
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
  source.visit_means(kRangePosts, [&](std::span<const glm::dvec3>, std::span<const double> heights_m) {
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

void check_silent_datums(const ElevationSource& layer, const ElevationSource& base, double radius_m,
                         const std::set<std::string>& silent, const std::set<std::string>& same) {
  const std::vector<SourceInfo> below = base.infos();
  const SourceInfo own = layer.infos().front();
  const bool layer_is_silent = silent.contains(own.name);
  const auto is_checked = [&](const std::string& name) {
    return !same.contains(own.name) && !same.contains(name) && (layer_is_silent || silent.contains(name));
  };
  if (std::ranges::none_of(below, [&](const SourceInfo& info) { return is_checked(info.name); })) return;
  std::map<int, Differences> found;  // by the base's source
  std::vector<double> base_m;
  std::vector<int> origin;
  layer.visit_means(kDatumPosts,
                    [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
                      base_m.resize(directions.size());
                      origin.resize(directions.size());
                      base.sample(directions, 0, base_m);
                      base.origin(directions, origin);
                      for (std::size_t i = 0; i < base_m.size(); ++i) {
                        if (origin[i] < 0 || !std::isfinite(heights_m[i] - base_m[i])) continue;
                        Differences& differences = found[origin[i]];
                        differences.off_m.push_back(heights_m[i] - base_m[i]);
                        differences.places.push_back(directions[i]);
                      }
                    });
  for (auto& [source, differences] : found) {
    const std::string& name = below.at(static_cast<std::size_t>(source)).name;
    if (!is_checked(name)) continue;
    const std::vector<glm::dvec3>& places = differences.places;
    const auto explained = [&] { return explained_m(base, radius_m, places); };
    check_difference(own.name, name, layer_is_silent, own.datum, explained, differences.off_m);
  }
}

}  // namespace mars
