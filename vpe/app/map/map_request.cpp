#include "vpe/app/map/map_request.h"

#include <algorithm>
#include <cmath>

#include "mars/geodesy/mars_time.h"
#include "mars/geodesy/sun.h"
#include "mars/geodesy/sun_times.h"
#include "paging/surface/query.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/base/number.h"

namespace vpe::app {
namespace {

// Steps of ten minutes.
constexpr int kSolSteps = 148;
constexpr int kYearSols = 24;
constexpr double kMarsYear_sols = 668.6;

mars::LonLat middle_of(const map::PlaceBox& box) {
  return {mars::normalize_lon_deg((box.west_deg + box.east_deg) / 2), (box.south_deg + box.north_deg) / 2};
}

// Returns azimuth and elevation, if the text is two numbers of their ranges.
std::optional<std::pair<double, double>> sky_place(const std::string& text) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 2) return std::nullopt;
  if (std::abs((*numbers)[0]) > 360 || std::abs((*numbers)[1]) > 90) return std::nullopt;
  return std::pair((*numbers)[0], (*numbers)[1]);
}

std::vector<glm::dvec3> sol_directions(double begin_s) {
  std::vector<glm::dvec3> out;
  for (int i = 0; i <= kSolSteps; ++i) {
    const mars::MarsTime time = mars::mars_time(begin_s + i * mars::kSol_s / kSolSteps);
    out.push_back(mars::direction({time.subsolar_lon_deg, time.subsolar_lat_deg}));
  }
  return out;
}

std::string percent(std::int64_t part, std::int64_t whole) {
  return base::format_significant(
      whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0, 4);
}

bool wants(const MapRequest& request, map::MapBand band) {
  return std::ranges::find(request.bands, band) != request.bands.end();
}

}  // namespace

map::MapLight light_of(const MapRequest& request, const paging::PlanetMeta& meta) {
  map::MapLight light;
  if (!request.shade.empty()) {
    const auto sky = sky_place(request.shade);
    if (!sky)
      throw UsageError("--shade '" + request.shade + "': expected AZIMUTH,ELEVATION in degrees, as 315,45");
    light.shade_azimuth_deg = sky->first;
    light.shade_elevation_deg = sky->second;
  }
  if (request.sun.empty()) {
    for (const map::MapBand band : {map::MapBand::sun, map::MapBand::sun_hours}) {
      if (wants(request, band))
        throw UsageError("band " + map::channels_of(band)[0].name + " needs --sun, as --sun 2026-11-27T12:00Z");
    }
    return light;
  }
  const mars::LonLat middle = middle_of(request.box);
  if (const auto sky = sky_place(request.sun)) {
    light.sun = mars::sun_direction(middle, sky->first, sky->second);
  } else {
    const auto spec = mars::parse_sun(request.sun);
    if (!spec || std::holds_alternative<mars::LocalSun>(*spec)) {
      throw UsageError("--sun '" + request.sun +
                       "': expected a date (2026-11-27T12:00Z), a season (Ls90,15:00), or AZIMUTH,ELEVATION");
    }
    if (meta.body != "Mars") {
      throw UsageError("--sun '" + request.sun + "': dates and seasons are known for Mars only, and this is " +
                       meta.body + "; give AZIMUTH,ELEVATION");
    }
    light.sun = mars::sun_direction(*spec, middle);
    if (const auto* date = std::get_if<mars::SunDate>(&*spec)) {
      const double begin_s = mars::local_sol(date->time_s, middle.lon_deg).begin_s;
      const int sols = request.year ? kYearSols : 1;
      for (int k = 0; k < sols; ++k)
        light.sols.push_back(sol_directions(begin_s + std::round(k * kMarsYear_sols / sols) * mars::kSol_s));
      light.sol_s = mars::kSol_s;
    }
  }
  if (wants(request, map::MapBand::sun_hours) && light.sols.empty())
    throw UsageError("band sun_hours needs a date: --sun 2026-11-27T12:00Z");
  return light;
}

mars::RasterInfo raster_info(const MapRequest& request, const mars::MapCrs& crs, const map::MapGrid& grid,
                             const paging::PlanetMeta& meta) {
  mars::RasterInfo info;
  info.columns = grid.columns;
  info.rows = grid.rows;
  info.to_map = grid.geotransform();
  info.wkt = crs.wkt();
  const bool colours_alone =
      std::ranges::all_of(request.bands, [](map::MapBand b) { return b == map::MapBand::colour; });
  info.type = colours_alone ? mars::BandType::byte : mars::BandType::float32;
  info.nodata = colours_alone ? 0 : std::nan("");
  for (const map::MapBand band : request.bands) {
    info.nearest_overviews = info.nearest_overviews || map::has_no_mean(band);
    for (const map::MapChannel& channel : map::channels_of(band))
      info.bands.push_back({channel.name, channel.unit, {{"meaning", channel.meaning}}});
  }
  auto& text = info.metadata;
  text["TIFFTAG_SOFTWARE"] = std::string("vpe ") + version();
  text["AREA_OR_POINT"] = "Area";
  text["VPE_VALUES"] = "of the reference surface at the middle of each pixel";
  text["VPE_BODY"] = meta.body;
  text["VPE_RADIUS_M"] = base::format_number(meta.radius_m);
  text["VPE_DATUM"] = paging::describe_datum(meta);
  text["VPE_CRS"] = request.crs;
  for (std::size_t i = 0; i < meta.sources.size(); ++i) {
    const mars::SourceInfo& source = meta.sources[i];
    text["VPE_SOURCE_" + std::to_string(i)] =
        source.name + (source.illustration ? " (synthetic)" : "") + ", posts " +
        base::format_significant(source.resolution_m, 6) + " m apart" +
        (source.accuracy_m ? ", accuracy " + base::format_significant(*source.accuracy_m, 4) + " m" : "");
  }
  if (meta.resampling.posts > 0)
    text["VPE_PLANET_RESAMPLING_MAX_M"] = base::format_significant(meta.resampling.max_m, 6);
  if (!request.image_layers.empty()) text["VPE_IMAGE_LAYERS"] = request.image_layers;
  if (wants(request, map::MapBand::shade)) text["VPE_SHADE"] = request.shade.empty() ? "315,45" : request.shade;
  if (wants(request, map::MapBand::sun) || wants(request, map::MapBand::sun_hours))
    text["VPE_SUN"] = request.sun;
  if (wants(request, map::MapBand::sun_hours)) text["VPE_SUN_HOURS_OF"] = request.year ? "year" : "sol";
  return info;
}

nlohmann::json to_json(const map::MapGround& ground) {
  return {{"pixels", ground.pixels},
          {"off_planet", ground.off_planet},
          {"nodata", ground.nodata},
          {"synthetic", ground.synthetic},
          {"finest_spacing_m", ground.pixels > 0 ? nlohmann::json(ground.finest_spacing_m) : nlohmann::json()},
          {"coarsest_spacing_m", ground.coarsest_spacing_m},
          {"error_max_m", ground.error_max_m},
          {"sources", ground.sources}};
}

map::MapGround ground_from_json(const nlohmann::json& json) {
  map::MapGround ground;
  json.at("pixels").get_to(ground.pixels);
  json.at("off_planet").get_to(ground.off_planet);
  json.at("nodata").get_to(ground.nodata);
  json.at("synthetic").get_to(ground.synthetic);
  if (!json.at("finest_spacing_m").is_null()) json.at("finest_spacing_m").get_to(ground.finest_spacing_m);
  json.at("coarsest_spacing_m").get_to(ground.coarsest_spacing_m);
  json.at("error_max_m").get_to(ground.error_max_m);
  json.at("sources").get_to(ground.sources);
  return ground;
}

void describe_ground(const map::MapGround& ground, const paging::PlanetMeta& meta, mars::RasterInfo& info) {
  auto& text = info.metadata;
  text["VPE_NODATA_PERCENT"] = percent(ground.nodata, ground.pixels);
  text["VPE_SYNTHETIC_PERCENT"] = percent(ground.synthetic, ground.pixels);
  text["VPE_OFF_PLANET_PERCENT"] = percent(ground.off_planet, ground.pixels + ground.off_planet);
  if (ground.pixels > 0) {
    text["VPE_POST_SPACING_M"] = base::format_significant(ground.finest_spacing_m, 6) + " to " +
                                 base::format_significant(ground.coarsest_spacing_m, 6);
  }
  text["VPE_ERROR_MAX_M"] =
      ground.error_max_m >= 0 ? base::format_significant(ground.error_max_m, 6) : "unknown";
  std::string sources;
  for (const int source : ground.sources)
    sources += (sources.empty() ? "" : "; ") + meta.sources.at(static_cast<std::size_t>(source)).name;
  text["VPE_SOURCES"] = sources;
}

nlohmann::json map_json(const MapRequest& request, const mars::MapCrs& crs, const map::MapGrid& grid,
                        const map::MapGround& ground, const paging::PlanetMeta& meta) {
  using nlohmann::json;
  json bands = json::array();
  for (const map::MapBand band : request.bands) {
    for (const map::MapChannel& channel : map::channels_of(band))
      bands.push_back({{"name", channel.name}, {"unit", channel.unit}, {"meaning", channel.meaning}});
  }
  json sources = json::array();
  for (const int source : ground.sources)
    sources.push_back(meta.sources.at(static_cast<std::size_t>(source)).name);
  const auto share = [&](std::int64_t part) {
    return ground.pixels > 0 ? json(static_cast<double>(part) / static_cast<double>(ground.pixels)) : json();
  };
  return {{"columns", grid.columns},
          {"rows", grid.rows},
          {"spacing_m", grid.spacing * crs.unit_m()},
          {"crs", request.crs},
          {"geotransform", grid.geotransform()},
          {"bands", std::move(bands)},
          {"datum", to_string(meta.datum)},
          {"radius_m", meta.radius_m},
          {"post_spacing_m", ground.pixels > 0 ? json(ground.finest_spacing_m) : json()},
          {"coarsest_post_spacing_m", ground.pixels > 0 ? json(ground.coarsest_spacing_m) : json()},
          {"resampling_max_m", ground.error_max_m >= 0 ? json(ground.error_max_m) : json()},
          {"planet_resampling_max_m", meta.resampling.max_m},
          {"sources", std::move(sources)},
          {"nodata_share", share(ground.nodata)},
          {"synthetic_share", share(ground.synthetic)},
          {"off_planet_pixels", ground.off_planet},
          {"illustration", meta.illustration}};
}

}  // namespace vpe::app
