#include "vpe/app/surface/surface_maps.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lod/tree/posts.h"
#include "mars/geodesy/sphere.h"
#include "mars/raster/elevation/plain_heights.h"
#include "mars/sources/source.h"
#include "paging/surface/surface.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr std::size_t kSurfaceBytes = std::size_t{64} << 20;

// Heights around a body, as its file gives them.
struct BodyHeights {
  double resolution_m = 0;
  bool is_planet = false;
  double radius_m = 0;  // of a planet file: what its heights are above
  std::function<void(std::span<const glm::dvec3>, double spacing_m, std::span<double>)> sample;  // NaN: nodata
};

double finest_posts_m(const paging::PlanetFile& planet) {
  int level = 0;
  for (const lod::TileInfo& tile : planet.tree().tiles()) level = std::max(level, int{tile.key.level});
  return lod::post_spacing_m(level, planet.meta().tile.intervals(), planet.radius_m());
}

BodyHeights open_body(const std::string& path) {
  if (is_sqlite(path)) {
    const auto planet = paging::PlanetFile::open(path);
    const auto surface = std::make_shared<const paging::Surface>(planet, kSurfaceBytes);
    return {finest_posts_m(*planet), true, planet->radius_m(),
            [surface](std::span<const glm::dvec3> directions, double, std::span<double> heights_m) {
              for (std::size_t n = 0; n < directions.size(); ++n) {
                const paging::SurfacePoint at = surface->at(directions[n]);
                heights_m[n] = at.nodata ? std::numeric_limits<double>::quiet_NaN() : at.height_m;
              }
            }};
  }
  const auto source = mars::open_elevation(path);
  return {source->infos().front().resolution_m, false, 0,
          [source](std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m) {
            source->sample(directions, spacing_m, heights_m);
          }};
}

[[noreturn]] void fail_nodata(const std::string& path, const std::string& where) {
  throw std::runtime_error(path + ": has no data " + where +
                           "; give fill_m in [[map]], or fill it (gdal_fillnodata.py)");
}

int side_posts(const relief::MapEntry& entry, const relief::SurfaceFile& surface, double resolution_m) {
  if (entry.posts) return *entry.posts;
  const double side_m = 0.5 * mars::kPi * surface.radius_m;
  const double wanted = resolution_m > 0 ? side_m / resolution_m : kUsualMostFacePosts;
  return static_cast<int>(
      std::clamp(std::ceil(wanted) + 1, double{kUsualLeastFacePosts}, double{kUsualMostFacePosts}));
}

}  // namespace

double base_radius_m(const relief::Base& base, const glm::dvec3& direction) {
  if (base.kind() == relief::Base::Kind::kSphere) return -base.height_m(base.centre_m());
  return 1 / std::sqrt(base.second().value(base.centre_m() + direction));
}

std::vector<glm::dvec3> FaceGrid::row(mars::Face face, int j) const {
  std::vector<glm::dvec3> directions;
  directions.reserve(static_cast<std::size_t>(side()));
  for (int i = 0; i < side(); ++i)
    directions.push_back(mars::chart_direction(face, coordinate(i), coordinate(j)));
  return directions;
}

FaceMaps face_maps(const relief::MapEntry& entry, const relief::SurfaceFile& surface, bool is_mask) {
  const std::string path = (is_mask ? entry.mask : entry.file).string();
  const BodyHeights body = open_body(path);
  const FaceGrid grid(surface.radius_m, side_posts(entry, surface, body.resolution_m));
  const bool is_radius = !is_mask && entry.heights == relief::MapHeights::kRadius;
  const double scale = is_mask ? 1 : entry.scale;
  FaceMaps maps;
  std::vector<double> row(static_cast<std::size_t>(grid.side()));
  for (int face = 0; face < mars::kFaces; ++face) {
    std::vector<float> heights_m;
    heights_m.reserve(row.size() * row.size());
    for (int j = 0; j < grid.side(); ++j) {
      const std::vector<glm::dvec3> directions = grid.row(static_cast<mars::Face>(face), j);
      body.sample(directions, grid.spacing_m(), row);
      for (std::size_t n = 0; n < row.size(); ++n) {
        double height_m = row[n];
        if (std::isnan(height_m)) {
          if (is_mask) {
            height_m = 0;
          } else if (entry.fill_m) {
            heights_m.push_back(static_cast<float>(*entry.fill_m));
            continue;
          } else {
            const mars::LonLat at = mars::lon_lat(directions[n]);
            fail_nodata(path, "at longitude " + base::format_rounded(at.lon_deg, 4) + ", latitude " +
                                  base::format_rounded(at.lat_deg, 4));
          }
        }
        if (is_radius) {
          const double radius_m = scale * (height_m + (body.is_planet ? body.radius_m : 0));
          height_m = radius_m - base_radius_m(surface.base, directions[n]);
        } else {
          height_m *= scale;
        }
        heights_m.push_back(static_cast<float>(height_m));
      }
    }
    maps[static_cast<std::size_t>(face)] =
        std::make_shared<relief::HeightMap>(grid.layout(), std::move(heights_m), entry.interpolation);
  }
  return maps;
}

std::shared_ptr<const relief::HeightMap> plane_map(const relief::MapEntry& entry,
                                                   const relief::SurfaceFile& surface, bool is_mask) {
  const std::string path = (is_mask ? entry.mask : entry.file).string();
  const mars::PlainHeights plain = mars::read_plain_heights(path);
  if (plain.columns < 2 || plain.rows < 2)
    throw std::runtime_error(path + ": has " + std::to_string(plain.columns) + " x " +
                             std::to_string(plain.rows) + " pixels; a map needs two on each side");
  const relief::Rect& area = surface.area_m;
  const relief::MapLayout layout{plain.columns,
                                 plain.rows,
                                 area.x0_m,
                                 area.y0_m,
                                 (area.x1_m - area.x0_m) / (plain.columns - 1),
                                 (area.y1_m - area.y0_m) / (plain.rows - 1)};
  std::vector<float> heights_m;
  heights_m.reserve(plain.heights_m.size());
  for (int j = plain.rows - 1; j >= 0; --j) {
    for (int i = 0; i < plain.columns; ++i) {
      const float stored =
          plain.heights_m[static_cast<std::size_t>(j) * static_cast<std::size_t>(plain.columns) +
                          static_cast<std::size_t>(i)];
      if (!std::isnan(stored)) {
        heights_m.push_back(is_mask ? stored : static_cast<float>(entry.scale * static_cast<double>(stored)));
      } else if (is_mask || entry.fill_m) {
        heights_m.push_back(is_mask ? 0 : static_cast<float>(*entry.fill_m));
      } else {
        fail_nodata(path, "in row " + std::to_string(j) + ", column " + std::to_string(i));
      }
    }
  }
  return std::make_shared<relief::HeightMap>(layout, std::move(heights_m), entry.interpolation);
}

}  // namespace vpe::app
