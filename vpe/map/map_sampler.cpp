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
#include "vpe/map/near_ground.h"

namespace vpe::map {
namespace {

constexpr float kMapNodata = std::numeric_limits<float>::quiet_NaN();
// So that a ray does not meet the facet that it begins on.
constexpr double kLift_m = 0.001;
// Halvings of a step of the sol: 10 minutes to 20 seconds.
constexpr int kSolHalvings = 5;
constexpr double kSecondsPerHour = 3600;
constexpr int kRowsWithoutBlocks = 4;
constexpr int kColumnsWithoutBlocks = 256;

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
  const mars::LonLat* place;  // null: the direction is known within kPlaceBlockError_rad
  const glm::dvec3& direction;
  const paging::SurfacePoint& point;
  double spacing_m;
  std::optional<int> source;  // nullopt: not known
  double resampling_m;        // NaN: not known
  paging::TerrainShader::Cursor& colours;
};

// Holds what one call of rows() works with.
struct MapSampler::Pass {
  int first_row;
  MapRows& out;
  MapGround& ground;
  paging::PlaceCursor cursor;
  std::vector<float> values;  // of one pixel
  paging::TerrainShader::Cursor colours{};
  int level = -1;
  double spacing_m = 0;  // of the posts of the level
  int last_source = -1;  // is in the ground
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
  if (!has_band(bands_, MapBand::sun) && !has_band(bands_, MapBand::sun_hours) &&
      !has_band(bands_, MapBand::colour))
    block_side_ = place_block_side(crs_, grid_, surface_.planet_radius_m());
}

int MapSampler::rows_at_once() const { return block_side_ > 0 ? block_side_ : kRowsWithoutBlocks; }

MapRows MapSampler::rows(int first_row, int count, MapGround& ground) const {
  const auto columns = static_cast<std::size_t>(grid_.columns);
  MapRows out(channels_, std::vector<float>(columns * static_cast<std::size_t>(count), kMapNodata));
  Pass pass{first_row, out, ground, paging::PlaceCursor(surface_), std::vector<float>(channels_)};
  // Blocks lie in the grid of the whole map.
  const int block_rows = rows_at_once();
  const int block_columns = block_side_ > 0 ? block_side_ : kColumnsWithoutBlocks;
  for (int row = first_row; row < first_row + count;) {
    const int top = row / block_rows * block_rows;
    const int end = std::min(top + block_rows, first_row + count);
    for (int column = 0; column < grid_.columns; column += block_columns) {
      const PixelRect block{column, top, std::min(block_columns, grid_.columns - column),
                            std::min(block_rows, grid_.rows - top)};
      fill_block(block, row, end, pass);
    }
    row = end;
  }
  return out;
}

void MapSampler::fill_block(const PixelRect& block, int first_row, int end_row, Pass& pass) const {
  std::optional<PlaceBlock> places;
  if (block_side_ > 0) places = PlaceBlock::fit(crs_, grid_, block);
  std::vector<std::size_t> open;
  DirectionLine line;
  for (int row = first_row; row < end_row; ++row) {
    const std::size_t first =
        static_cast<std::size_t>(row - pass.first_row) * static_cast<std::size_t>(grid_.columns) +
        static_cast<std::size_t>(block.column);
    if (places) places->directions(row - block.row, line);
    for (int n = 0; n < block.columns; ++n) {
      const std::size_t index = first + static_cast<std::size_t>(n);
      if (!places || !fill_near(line.at(n), index, pass)) open.push_back(index);
    }
  }
  fill_exact(open, pass);
}

bool MapSampler::fill_near(const glm::dvec3& direction, std::size_t index, Pass& pass) const {
  const paging::SurfacePoint* point = pass.cursor.move_near(direction, kPlaceBlockError_rad);
  if (point == nullptr) return false;
  const Pixel pixel = look(nullptr, direction, *point, pass);
  if (!fill(pixel, pass.values)) return false;
  keep(pixel, index, pass);
  return true;
}

void MapSampler::fill_exact(const std::vector<std::size_t>& pixels, Pass& pass) const {
  const auto columns = static_cast<std::size_t>(grid_.columns);
  std::vector<glm::dvec2> places;
  places.reserve(pixels.size());
  for (const std::size_t index : pixels) {
    places.push_back(
        grid_.middle(static_cast<int>(index % columns), pass.first_row + static_cast<int>(index / columns)));
  }
  crs_.to_place(places);
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    if (!std::isfinite(places[n].x)) {
      ++pass.ground.off_planet;
      continue;
    }
    const mars::LonLat place{places[n].x, places[n].y};
    const glm::dvec3 direction = mars::direction(place);
    const Pixel pixel = look(&place, direction, pass.cursor.move_to(direction), pass);
    fill(pixel, pass.values);
    keep(pixel, pixels[n], pass);
  }
}

MapSampler::Pixel MapSampler::look(const mars::LonLat* place, const glm::dvec3& direction,
                                   const paging::SurfacePoint& point, Pass& pass) const {
  if (point.tile.level != pass.level) {
    const paging::PlanetMeta& meta = surface_.planet().meta();
    pass.level = point.tile.level;
    pass.spacing_m = lod::post_spacing_m(pass.level, meta.tile.intervals(), meta.radius_m);
  }
  Pixel pixel{place,
              direction,
              point,
              pass.spacing_m,
              pass.cursor.source(),
              std::numeric_limits<double>::quiet_NaN(),
              pass.colours};
  if (pixel.source) {
    const auto resampling = pass.cursor.resampling(*pixel.source);
    if (resampling.error.posts > 0) pixel.resampling_m = resampling.error.max_m;
  }
  return pixel;
}

void MapSampler::keep(const Pixel& pixel, std::size_t index, Pass& pass) const {
  MapGround& ground = pass.ground;
  ++ground.pixels;
  ground.nodata += pixel.point.nodata ? 1 : 0;
  if (pixel.source) {
    const int source = *pixel.source;
    if (pixel.resampling_m > ground.error_max_m) ground.error_max_m = pixel.resampling_m;
    if (source != pass.last_source) ground.sources.insert(source);
    pass.last_source = source;
    const mars::SourceInfo& info = surface_.planet().meta().sources.at(static_cast<std::size_t>(source));
    ground.synthetic += info.illustration ? 1 : 0;
  }
  ground.finest_spacing_m = std::min(ground.finest_spacing_m, pixel.spacing_m);
  ground.coarsest_spacing_m = std::max(ground.coarsest_spacing_m, pixel.spacing_m);
  for (std::size_t c = 0; c < channels_; ++c) pass.out[c][index] = pass.values[c];
}

bool MapSampler::fill(const Pixel& pixel, std::span<float> values) const {
  const paging::PlanetMeta& meta = surface_.planet().meta();
  const mars::LonLat* const place = pixel.place;
  const bool nodata = pixel.point.nodata;
  const auto of_ground = [&](double value) { return nodata ? kMapNodata : static_cast<float>(value); };
  const mars::SourceInfo* source =
      pixel.source ? &meta.sources.at(static_cast<std::size_t>(*pixel.source)) : nullptr;
  const glm::dvec3& normal = pixel.point.normal;
  const NearGround near(pixel.point, pixel.direction, kPlaceBlockError_rad);
  bool is_known = true;
  const auto of_near = [&](const std::optional<float>& value) {
    is_known = is_known && (nodata || value);
    return nodata ? kMapNodata : value.value_or(kMapNodata);
  };
  std::size_t c = 0;
  for (const MapBand band : bands_) {
    float& out = values[c];
    ++c;
    switch (band) {
      case MapBand::elevation:
        out = place == nullptr ? of_near(near.elevation()) : of_ground(pixel.point.height_m);
        break;
      case MapBand::slope:
        out = place == nullptr ? of_near(near.slope())
                               : of_ground(paging::slope_and_aspect(normal, *place).slope_deg);
        break;
      case MapBand::aspect:
        out = place == nullptr ? of_near(near.aspect())
                               : of_ground(paging::slope_and_aspect(normal, *place).aspect_deg);
        break;
      case MapBand::shade: {
        if (place == nullptr) {
          out = of_near(near.shade(light_.shade_azimuth_deg, light_.shade_elevation_deg));
          break;
        }
        const glm::dvec3 light =
            mars::sun_direction(*place, light_.shade_azimuth_deg, light_.shade_elevation_deg);
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
  return is_known;
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
