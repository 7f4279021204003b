#include "vpe/map/map_sampler.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "lod/tree/posts.h"
#include "mars/geodesy/sphere.h"
#include "mars/geodesy/sun.h"
#include "paging/surface/place_cursor.h"
#include "paging/surface/query.h"

namespace vpe::map {
namespace {

constexpr float kMapNodata = std::numeric_limits<float>::quiet_NaN();
// So that a ray does not meet the facet that it begins on.
constexpr double kLift_m = 0.001;
// Halvings of a step of the sol: 10 minutes to 20 seconds.
constexpr int kSolHalvings = 5;
constexpr double kSecondsPerHour = 3600;

bool has_band(const std::vector<MapBand>& bands, MapBand band) {
  return std::ranges::find(bands, band) != bands.end();
}

float colour_value(double value) { return static_cast<float>(std::clamp(std::round(value), 1.0, 255.0)); }

}  // namespace

void MapGround::add(const MapGround& other) {
  pixels += other.pixels;
  off_planet += other.off_planet;
  nodata += other.nodata;
  synthetic += other.synthetic;
  finest_spacing_m = std::min(finest_spacing_m, other.finest_spacing_m);
  coarsest_spacing_m = std::max(coarsest_spacing_m, other.coarsest_spacing_m);
  error_max_m = std::max(error_max_m, other.error_max_m);
  sources.insert(other.sources.begin(), other.sources.end());
}

// Holds what is known of one pixel.
struct MapSampler::Pixel {
  mars::LonLat place;
  glm::dvec3 direction;
  paging::SurfacePoint point;
  double spacing_m;
  std::optional<int> source;  // nullopt: not known
  double resampling_m;        // NaN: not known
  paging::TerrainShader::Cursor& colours;
};

MapSampler::MapSampler(const paging::Surface& surface, const paging::TerrainShader* shader,
                       const mars::MapCrs& crs, MapGrid grid, std::vector<MapBand> bands, MapLight light)
    : surface_(surface),
      shader_(shader),
      crs_(crs),
      grid_(grid),
      bands_(std::move(bands)),
      light_(std::move(light)),
      footprint_m_(grid.spacing * crs.unit_m()) {
  if (has_band(bands_, MapBand::sun) && !light_.sun)
    throw std::invalid_argument("band sun needs a sun: a date, a season, or azimuth and elevation");
  if (has_band(bands_, MapBand::sun_hours) && light_.sols.empty())
    throw std::invalid_argument("band sun_hours needs a date");
  if (has_band(bands_, MapBand::colour) && shader_ == nullptr)
    throw std::invalid_argument("band colour needs imagery, which the planet does not have");
  for (const MapBand band : bands_) channels_ += channels_of(band).size();
  image_.colour_source = paging::ColourSource::kImage;
  image_.lit = false;
}

MapRows MapSampler::rows(int first_row, int count, MapGround& ground) const {
  const std::vector<glm::dvec2> places = places_of_rows(crs_, grid_, first_row, count);
  MapRows out(channels_, std::vector<float>(places.size(), kMapNodata));
  paging::PlaceCursor cursor(surface_);
  paging::TerrainShader::Cursor colours;
  const paging::PlanetMeta& meta = surface_.planet().meta();
  std::vector<float> values(channels_);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!std::isfinite(places[i].x)) {
      ++ground.off_planet;
      continue;
    }
    const mars::LonLat place{places[i].x, places[i].y};
    const glm::dvec3 direction = mars::direction(place);
    const paging::SurfacePoint& point = cursor.move_to(direction);
    Pixel pixel{place,           direction,
                point,           lod::post_spacing_m(point.tile.level, meta.tile.intervals(), meta.radius_m),
                cursor.source(), std::numeric_limits<double>::quiet_NaN(),
                colours};
    ++ground.pixels;
    ground.nodata += point.nodata ? 1 : 0;
    if (pixel.source) {
      const auto resampling = cursor.resampling(*pixel.source);
      if (resampling.error.posts > 0) pixel.resampling_m = resampling.error.max_m;
      ground.error_max_m = std::fmax(ground.error_max_m, pixel.resampling_m);
      ground.sources.insert(*pixel.source);
      ground.synthetic += meta.sources.at(static_cast<std::size_t>(*pixel.source)).illustration ? 1 : 0;
    }
    ground.finest_spacing_m = std::min(ground.finest_spacing_m, pixel.spacing_m);
    ground.coarsest_spacing_m = std::max(ground.coarsest_spacing_m, pixel.spacing_m);
    fill(pixel, values);
    for (std::size_t c = 0; c < channels_; ++c) out[c][i] = values[c];
  }
  return out;
}

void MapSampler::fill(const Pixel& pixel, std::span<float> values) const {
  const paging::PlanetMeta& meta = surface_.planet().meta();
  const bool nodata = pixel.point.nodata;
  const auto of_ground = [&](double value) { return nodata ? kMapNodata : static_cast<float>(value); };
  const mars::SourceInfo* source =
      pixel.source ? &meta.sources.at(static_cast<std::size_t>(*pixel.source)) : nullptr;
  const glm::dvec3& normal = pixel.point.normal;
  std::size_t c = 0;
  for (const MapBand band : bands_) {
    float& out = values[c];
    ++c;
    switch (band) {
      case MapBand::elevation: out = of_ground(pixel.point.height_m); break;
      case MapBand::slope: out = of_ground(paging::slope_and_aspect(normal, pixel.place).slope_deg); break;
      case MapBand::aspect: out = of_ground(paging::slope_and_aspect(normal, pixel.place).aspect_deg); break;
      case MapBand::shade: {
        const glm::dvec3 light =
            mars::sun_direction(pixel.place, light_.shade_azimuth_deg, light_.shade_elevation_deg);
        out = of_ground(std::max(0.0, glm::dot(normal, light)));
        break;
      }
      case MapBand::sun: {
        const double incidence = glm::dot(normal, *light_.sun);
        const bool seen = incidence > 0 && sees(pixel.direction * pixel.point.radius_m, *light_.sun);
        out = of_ground(seen ? incidence : 0.0);
        break;
      }
      case MapBand::sun_hours:
        out = nodata ? kMapNodata : sun_hours(pixel.direction * pixel.point.radius_m, normal);
        break;
      case MapBand::colour: {
        auto colour = shader_->colour_at(pixel.direction, footprint_m_, image_, pixel.colours);
        if (!colour) colour = shader_->nodata_image_at(pixel.direction, footprint_m_, image_, pixel.colours);
        for (int k = 0; k < 3; ++k)
          values[c - 1 + static_cast<std::size_t>(k)] = colour ? colour_value((*colour)[k]) : kMapNodata;
        c += 2;
        break;
      }
      case MapBand::source: out = source ? static_cast<float>(*pixel.source) : kMapNodata; break;
      case MapBand::source_spacing: out = source ? static_cast<float>(source->resolution_m) : kMapNodata; break;
      case MapBand::post_spacing: out = of_ground(pixel.spacing_m); break;
      case MapBand::synthetic: out = source ? (source->illustration ? 1.0F : 0.0F) : kMapNodata; break;
      case MapBand::error: out = static_cast<float>(pixel.resampling_m); break;
    }
  }
}

bool MapSampler::sees(const glm::dvec3& place_m, const glm::dvec3& sun) const {
  return std::isinf(surface_.cast(place_m + glm::normalize(place_m) * kLift_m, sun));
}

float MapSampler::sun_hours(const glm::dvec3& place_m, const glm::dvec3& normal) const {
  double seen = 0;
  for (const std::vector<glm::dvec3>& sol : light_.sols) seen += seen_share(sol, place_m, normal);
  return static_cast<float>(seen / static_cast<double>(light_.sols.size()) * light_.sol_s / kSecondsPerHour);
}

double MapSampler::seen_share(const std::vector<glm::dvec3>& sol, const glm::dvec3& place_m,
                              const glm::dvec3& normal) const {
  const auto lit = [&](const glm::dvec3& sun) { return glm::dot(normal, sun) > 0 && sees(place_m, sun); };
  double steps = 0;
  bool before = lit(sol[0]);
  for (std::size_t i = 1; i < sol.size(); ++i) {
    const bool after = lit(sol[i]);
    if (before == after) {
      steps += before ? 1 : 0;
    } else {
      double low = 0;
      double high = 1;
      for (int k = 0; k < kSolHalvings; ++k) {
        const double middle = (low + high) / 2;
        (lit(mars::slerp(sol[i - 1], sol[i], middle)) == before ? low : high) = middle;
      }
      const double change = (low + high) / 2;
      steps += before ? change : 1 - change;
    }
    before = after;
  }
  return steps / static_cast<double>(sol.size() - 1);
}

}  // namespace vpe::map
