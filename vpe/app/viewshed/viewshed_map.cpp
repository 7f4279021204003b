#include "vpe/app/viewshed/viewshed_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mars/raster/output/raster_writer.h"
#include "paging/surface/query.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/map/map_request.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

// Posts of the squares around observers that a map must hold, along each side.
constexpr int kReachPoints = 65;
constexpr float kViewshedNodata = 255;

std::string observer_text(const Observer& observer) {
  return base::format_number(observer.place.lon_deg) + "," + base::format_number(observer.place.lat_deg) + "," +
         base::format_number(observer.height_m);
}

mars::RasterInfo viewshed_info(const ViewshedMap& viewshed, const ViewshedRequest& request,
                               const paging::PlanetMeta& meta) {
  mars::RasterInfo info;
  info.columns = viewshed.grid.columns;
  info.rows = viewshed.grid.rows;
  info.to_map = viewshed.grid.geotransform();
  info.wkt = mars::MapCrs(viewshed.crs, meta.radius_m).wkt();
  info.nearest_overviews = true;
  if (request.needed) {
    info.type = mars::BandType::float32;
    info.nodata = std::nan("");
    info.bands.push_back({"needed_height",
                          "m",
                          {{"meaning",
                            "height above the ground from which a target is seen by an observer; 0: the "
                            "ground is seen, infinite: no height is enough"}}});
  } else {
    info.type = mars::BandType::byte;
    info.nodata = double{kViewshedNodata};
    info.bands.push_back({"observers", "", {{"meaning", "number of observers that see the target"}}});
  }
  auto& text = info.metadata;
  text["TIFFTAG_SOFTWARE"] = std::string("vpe ") + version();
  text["AREA_OR_POINT"] = "Area";
  text["VPE_BODY"] = meta.body;
  text["VPE_RADIUS_M"] = base::format_number(meta.radius_m);
  text["VPE_DATUM"] = paging::describe_datum(meta);
  text["VPE_CRS"] = viewshed.crs;
  for (std::size_t n = 0; n < request.observers.size(); ++n)
    text["VPE_OBSERVER_" + std::to_string(n)] = observer_text(request.observers[n]);
  if (!request.needed) text["VPE_TARGET_HEIGHT_M"] = base::format_number(request.target_height_m);
  text["VPE_REACH_M"] = base::format_number(request.reach_m);
  text["VPE_VIEWSHED_SPACING_M"] = base::format_number(request.spacing_m);
  describe_ground(viewshed.ground, meta, info);
  return info;
}

}  // namespace

std::string equidistant_crs(mars::LonLat centre, double radius_m) {
  return "+proj=aeqd +lat_0=" + base::format_number(centre.lat_deg) +
         " +lon_0=" + base::format_number(centre.lon_deg) + " +R=" + base::format_number(radius_m) +
         " +units=m +no_defs";
}

map::MapGrid grid_of_frame(const map::GridFrame& frame) {
  return {frame.first_m.x - frame.spacing_m / 2, frame.first_m.y + frame.spacing_m / 2, frame.spacing_m,
          frame.columns, frame.rows};
}

map::MapGrid grid_of_observers(const mars::MapCrs& crs, const ViewshedRequest& request, double radius_m) {
  const double spacing = request.spacing_m / crs.unit_m();
  glm::dvec2 least(std::numeric_limits<double>::infinity());
  glm::dvec2 most = -least;
  for (const Observer& observer : request.observers) {
    const map::LocalMap local(observer.place, radius_m);
    std::vector<glm::dvec2> points;
    for (int n = 0; n < kReachPoints; ++n) {
      for (int k = 0; k < kReachPoints; ++k) {
        const glm::dvec2 unit = glm::dvec2(n, k) * (2.0 / (kReachPoints - 1)) - 1.0;
        // A square onto a disc.
        const double longest = std::max(std::abs(unit.x), std::abs(unit.y));
        const double shrink = longest > 0 ? longest / std::hypot(unit.x, unit.y) : 1;
        const mars::LonLat place = local.to_place(unit * (shrink * request.reach_m));
        points.emplace_back(place.lon_deg, place.lat_deg);
      }
    }
    crs.to_map(points);
    for (const glm::dvec2& point : points) {
      if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
      least = {std::min(least.x, point.x), std::min(least.y, point.y)};
      most = {std::max(most.x, point.x), std::max(most.y, point.y)};
    }
  }
  if (!(least.x <= most.x)) throw std::invalid_argument("--crs has no place near an observer");
  const double left = std::floor(least.x / spacing);
  const double top = std::ceil(most.y / spacing);
  const double columns = std::max(1.0, std::ceil(most.x / spacing) - left);
  const double rows = std::max(1.0, top - std::floor(least.y / spacing));
  if (columns * rows > static_cast<double>(map::kMostGridPosts)) {
    throw std::invalid_argument(
        "a map of all observers has " + base::format_significant(columns * rows / 1e6, 3) +
        " million pixels; at most " + std::to_string(map::kMostGridPosts / 1'000'000) +
        " million are possible: choose a larger --spacing, or a --crs whose edge is farther away");
  }
  return {left * spacing, top * spacing, spacing, static_cast<int>(columns), static_cast<int>(rows)};
}

double ViewshedMap::known_share() const {
  const auto known = std::ranges::count_if(value, [](float v) { return !std::isnan(v); });
  return value.empty() ? 0 : static_cast<double>(known) / static_cast<double>(value.size());
}

double ViewshedMap::seen_share(bool needed) const {
  const auto known = std::ranges::count_if(value, [](float v) { return !std::isnan(v); });
  const auto seen = std::ranges::count_if(value, [&](float v) { return needed ? v == 0 : v > 0; });
  return known == 0 ? 0 : static_cast<double>(seen) / static_cast<double>(known);
}

void write_viewshed(const std::filesystem::path& path, const ViewshedMap& viewshed,
                    const ViewshedRequest& request, const paging::PlanetMeta& meta) {
  mars::RasterWriter writer(path, viewshed_info(viewshed, request, meta));
  const auto columns = static_cast<std::size_t>(viewshed.grid.columns);
  std::vector<float> row(columns);
  for (int n = 0; n < viewshed.grid.rows; ++n) {
    const float* const values = viewshed.value.data() + static_cast<std::size_t>(n) * columns;
    std::transform(values, values + columns, row.begin(),
                   [&](float v) { return std::isnan(v) && !request.needed ? kViewshedNodata : v; });
    writer.write(0, n, row);
  }
  writer.finish();
}

nlohmann::json viewshed_json(const ViewshedMap& viewshed, const ViewshedRequest& request,
                             const paging::PlanetMeta& meta) {
  using nlohmann::json;
  json observers = json::array();
  for (std::size_t n = 0; n < request.observers.size(); ++n) {
    const Observer& observer = request.observers[n];
    observers.push_back({{"lon_deg", observer.place.lon_deg},
                         {"lat_deg", observer.place.lat_deg},
                         {"height_m", observer.height_m},
                         {"elevation_m", viewshed.elevations_m.at(n)}});
  }
  const map::MapGround& ground = viewshed.ground;
  json sources = json::array();
  for (const int source : ground.sources)
    sources.push_back(meta.sources.at(static_cast<std::size_t>(source)).name);
  const double pixels = static_cast<double>(ground.pixels);
  return {{"observers", std::move(observers)},
          {"target_height_m", request.needed ? json() : json(request.target_height_m)},
          {"needed", request.needed},
          {"radius_of_view_m", request.reach_m},
          {"seen_share", viewshed.seen_share(request.needed)},
          {"known_share", viewshed.known_share()},
          {"columns", viewshed.grid.columns},
          {"rows", viewshed.grid.rows},
          {"spacing_m", viewshed.grid.spacing * viewshed.unit_m},
          {"crs", viewshed.crs},
          {"geotransform", viewshed.grid.geotransform()},
          {"datum", to_string(meta.datum)},
          {"radius_m", meta.radius_m},
          {"post_spacing_m", ground.finest_spacing_m},
          {"coarsest_post_spacing_m", ground.coarsest_spacing_m},
          {"resampling_max_m", ground.error_max_m >= 0 ? json(ground.error_max_m) : json()},
          {"planet_resampling_max_m", meta.resampling.max_m},
          {"sources", std::move(sources)},
          {"nodata_share", static_cast<double>(ground.nodata) / pixels},
          {"synthetic_share", static_cast<double>(ground.synthetic) / pixels},
          {"illustration", meta.illustration}};
}

}  // namespace vpe::app
