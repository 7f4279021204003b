#include "paging/build/build_inputs.h"

#include <algorithm>
#include <cmath>

#include "mars/sources/layered_image.h"
#include "paging/build/source_content.h"
#include "paging/build/source_heights.h"
#include "vpe/base/number.h"

namespace paging {

namespace {

double mean_height(const mars::ElevationSource& source, const PlanetMeta& meta) {
  double sum = 0;
  std::int64_t count = 0;
  source.visit_means(20000, [&](std::span<const glm::dvec3> directions, std::span<const double> heights) {
    // One wild height would become the fill of all nodata.
    check_heights(directions, heights, meta, source);
    for (const double h : heights) {
      if (!std::isfinite(h)) continue;
      sum += h;
      ++count;
    }
  });
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

bool is_wanted_fine(const BuildOptions& options, const mars::Cap& cap) {
  return options.regions.empty() || std::any_of(options.regions.begin(), options.regions.end(),
                                                [&](const Region& r) { return touches(r, cap); });
}

}  // namespace

// Heights between posts are interpolated: a coarse step would show as terraces in slopes and shading.
double choose_quantum(const std::vector<mars::SourceInfo>& sources, double finest_spacing_m) {
  double step = 1.0;
  for (const mars::SourceInfo& s : sources) {
    step =
        std::min(step, s.quantum_m > 0 ? s.quantum_m / 16 : std::max(s.resolution_m, finest_spacing_m) / 512);
  }
  return std::clamp(std::exp2(std::floor(std::log2(step))), 1.0 / 4096.0, 1.0);
}

bool touches(const Region& region, const mars::Cap& cap) {
  const mars::LonLat centre = mars::lon_lat(cap.centre);
  const double reach_deg = cap.radius_rad / mars::kRadiansPerDegree;
  if (centre.lat_deg + reach_deg < region.south_deg || centre.lat_deg - reach_deg > region.north_deg)
    return false;
  // Width of a cap in longitude grows with latitude; a cap that holds a pole has all longitudes.
  const double lat = std::abs(centre.lat_deg) * mars::kRadiansPerDegree;
  if (lat + cap.radius_rad >= mars::kPi / 2) return true;
  const double half_width_deg = std::asin(std::sin(cap.radius_rad) / std::cos(lat)) / mars::kRadiansPerDegree;
  double width = region.east_deg - region.west_deg;
  if (width < 0) width += 360.0;
  if (width + 2 * half_width_deg >= 360.0) return true;
  double from_west = std::fmod(centre.lon_deg + half_width_deg - region.west_deg, 360.0);
  if (from_west < 0) from_west += 360.0;
  return from_west <= width + 2 * half_width_deg;
}

WantedSpacing wanted_elevation(const BuildOptions& options, const mars::ElevationSource& source) {
  return [&options, &source](const lod::TileKey&, const mars::Cap& cap) {
    if (!is_wanted_fine(options, cap)) return options.base_spacing_m;
    return std::min(options.base_spacing_m, std::max(source.spacing_in(cap), options.finest_spacing_m));
  };
}

std::vector<lod::TileKey> plan_images(const BuildOptions& options, const mars::ImageSource& image) {
  std::vector<lod::TileKey> tiles;
  for (int f = 0; f < mars::kFaces; ++f) tiles.push_back({static_cast<mars::Face>(f), 0, 0, 0});
  for (std::size_t at = 0; at < tiles.size(); ++at) {
    const lod::TileKey key = tiles[at];
    const double spacing = lod::post_spacing_m(key.level, kImageIntervals, options.radius_m);
    const mars::Cap cap = lod::bounding_cap(key);
    const double wanted =
        std::max(image.spacing_in(cap), is_wanted_fine(options, cap)
                                            ? options.finest_image_m
                                            : std::max(options.finest_image_m, options.base_spacing_m));
    // A texel up to a fifth coarser than requested does not justify four times the tiles.
    if (!(spacing > 1.2 * wanted) || key.level >= 20) continue;
    for (int c = 0; c < 4; ++c) tiles.push_back(lod::child(key, c));
  }
  return tiles;
}

std::vector<std::vector<lod::TileKey>> plan_layers(const BuildOptions& options,
                                                   const mars::ImageSource* image) {
  std::vector<std::vector<lod::TileKey>> tiles;
  const auto* layers = mars::layers_of(image);
  if (layers == nullptr) return tiles;
  for (const mars::ImageLayerSource& layer : *layers) tiles.push_back(plan_images(options, *layer.source));
  return tiles;
}

BuildPlan plan_tiles(const BuildOptions& options, const mars::ElevationSource& elevation) {
  return {lod::TileShape{options.tile_k}, options.radius_m, wanted_elevation(options, elevation)};
}

PlanetMeta describe_planet(const BuildOptions& options, const mars::ElevationSource& elevation,
                           const mars::ImageSource* image, std::optional<double> fill_m) {
  PlanetMeta meta;
  if (!(options.radius_m >= kMinRadius_m && options.radius_m < kMaxRadius_m)) {
    throw PlanetError("a planet's radius of " + vpe::base::format_number(options.radius_m) + " m: must be " +
                      vpe::base::format_number(kMinRadius_m) + " m or more and less than " +
                      vpe::base::format_number(kMaxRadius_m) + " m");
  }
  meta.body = options.body;
  meta.radius_m = options.radius_m;
  meta.tile.k = options.tile_k;
  meta.sources = elevation.infos();
  if (meta.sources.empty()) throw PlanetError("no elevation source: give at least one DEM");
  meta.datum = meta.sources.front().datum;
  if (options.true_radii) meta.shape = "radius";
  meta.quantum_m =
      options.quantum_m > 0 ? options.quantum_m : choose_quantum(meta.sources, options.finest_spacing_m);
  meta.fill_m = fill_m ? *fill_m : std::round(mean_height(elevation, meta) / meta.quantum_m) * meta.quantum_m;
  for (const mars::SourceInfo& s : meta.sources) meta.illustration = meta.illustration || s.illustration;
  meta.build_settings = build_settings(options);
  meta.arguments = options.arguments;
  if (image != nullptr) meta.image_sources = image->infos();
  if (const auto* layers = mars::layers_of(image)) {
    for (const mars::ImageLayerSource& layer : *layers) {
      ImageLayer described;
      described.name = layer.name;
      described.source = layer.info;
      meta.image_layers.push_back(std::move(described));
    }
  }
  for (auto* sources : {&meta.sources, &meta.image_sources})
    for (mars::SourceInfo& s : *sources) s.content = content_of(s);
  return meta;
}

}  // namespace paging
