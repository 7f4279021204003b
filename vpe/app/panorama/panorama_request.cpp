#include "vpe/app/panorama/panorama_request.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "panorama/image/metadata_error.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/places/named_places.h"
#include "vpe/base/file.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

using panorama::MapKind;

// The largest sidecar that is read.
constexpr std::uintmax_t kMostSidecarBytes = std::uintmax_t{1} << 24;

core::Backend backend_of(const PanoramaArguments& arguments) {
  return arguments.render.backend.value_or(core::Backend::kRay);  // rays for auto
}

MapKind kind_of(const PanoramaArguments& arguments) {
  const bool is_polygons = backend_of(arguments) == core::Backend::kPolygon;
  if (arguments.projection.empty()) return is_polygons ? MapKind::kFacets : MapKind::kCylinder;
  for (const MapKind kind : {MapKind::kCylinder, MapKind::kEquirectangular, MapKind::kFacets}) {
    if (arguments.projection != panorama::to_string(kind)) continue;
    if (is_polygons && kind != MapKind::kFacets) {
      throw UsageError("--projection " + arguments.projection +
                       ": triangles are drawn in planes only; use --projection facets or --backend ray");
    }
    return kind;
  }
  throw UsageError("--projection '" + arguments.projection + "': give facets, cylinder or equirectangular");
}

panorama::PlanOptions map_of(const PanoramaArguments& arguments) {
  panorama::PlanOptions map;
  map.kind = kind_of(arguments);
  if (arguments.has_facets && map.kind != MapKind::kFacets) {
    throw UsageError("--facets: an image of projection " + std::string(panorama::to_string(map.kind)) +
                     " has none; add --projection facets");
  }
  map.facets = arguments.facets;
  map.yaw_deg = arguments.yaw_deg;
  if (arguments.from_deg.has_value() != arguments.to_deg.has_value()) {
    throw UsageError("--from and --to belong together: the azimuths of the image's left and right edge");
  }
  if (arguments.from_deg) map.arc = panorama::Arc{*arguments.from_deg, *arguments.to_deg};
  if (map.arc && arguments.has_yaw && map.kind != MapKind::kFacets) {
    throw UsageError("--yaw and --from both set the image's left edge; leave one out");
  }
  if (!arguments.elevation.empty()) {
    const auto numbers = parse_numbers(arguments.elevation);
    if (!numbers || numbers->size() != 2) {
      throw UsageError("--elevation '" + arguments.elevation + "': expected MIN,MAX in degrees");
    }
    map.lowest_deg = numbers->front();
    map.highest_deg = numbers->back();
  }
  map.width_px = arguments.width_px;
  map.degrees_per_pixel = arguments.degrees_per_pixel;
  return map;
}

std::string absolute_planet(const std::string& argument) {
  return argument.empty() ? argument : fs::absolute(argument).lexically_normal().string();
}

std::vector<panorama::Plane> layers_of(const PanoramaArguments& arguments) {
  try {
    return panorama::parse_planes(arguments.aux_layers);
  } catch (const panorama::PlanError& e) {
    throw UsageError(e.what());
  }
}

// Returns the settings of the options. Round images are drawn with several samples a pixel unless the user names a
// number: the filter of `edges` needs plane images, and one sample leaves stair steps along the skyline.
core::Settings settings_of(const PanoramaArguments& arguments, MapKind kind) {
  core::Settings settings = make_settings(arguments.render);
  const bool is_named = std::ranges::any_of(arguments.render.set, [](const std::string& text) {
    return text.starts_with("samples=") || text.starts_with("rays.vertical=") || text == "edges=hard";
  });
  const bool is_discrete = settings.values().ray_mode == core::RayMode::kDiscrete;
  if (kind != MapKind::kFacets && !is_named) (void)settings.set(is_discrete ? "rays.vertical" : "samples", "4");
  if (settings.values().ray_fovea) throw UsageError("--set rays.fovea: a panorama has no middle; leave it out");
  return settings;
}

PanoramaRequest request_from_options(const PanoramaArguments& arguments, const Common& common) {
  if (arguments.at.empty() || arguments.output.empty())
    throw UsageError("--at LON,LAT and -o PANO are required, or --from-sidecar PANO.json");
  const GivenPlace given = given_place("--at", arguments.at);
  if (arguments.height_m.has_value() == arguments.altitude_m.has_value()) {
    throw UsageError("give either --height (metres above the ground) or --altitude (metres above the sphere)");
  }
  PanoramaRequest request;
  request.map = map_of(arguments);
  request.camera.lon_deg = given.place.lon_deg;
  request.camera.lat_deg = given.place.lat_deg;
  request.camera.alt_m = arguments.altitude_m.value_or(0);
  request.latitude = arguments.latitude;
  request.place_name = given.name;
  request.backend = backend_of(arguments);
  request.settings = settings_of(arguments, request.map.kind);
  parse_interest(arguments.render);
  request.interest = arguments.render.interest;
  request.layers = layers_of(arguments);
  check_stereo(arguments.stereo);
  if (const auto layout = core::parse_stereo(arguments.stereo.layout)) {
    request.stereo.emplace();
    request.stereo->layout = *layout;
    request.stereo->base_m = arguments.stereo.eye_base_m;
    if (arguments.stereo.method.carries()) request.stereo->carried_gap_px = arguments.stereo.method.gap_px;
  }
  request.planet = absolute_planet(arguments.planet);
  request.memory_mb = request.backend == core::Backend::kPolygon ? common.memory_mb : 0;
  request.allow_incomplete = arguments.render.allow_incomplete;
  request.height_m = arguments.height_m;
  request.output = arguments.output;
  return request;
}

// Options that a sidecar's recipe sets. A configuration file may have defaults of these; naming one beside
// --from-sidecar contradicts it.
constexpr std::array<std::string_view, 23> kRecipeOptions{"--at",
                                                          "--height",
                                                          "--altitude",
                                                          "--projection",
                                                          "--facets",
                                                          "--yaw",
                                                          "--from",
                                                          "--to",
                                                          "--elevation",
                                                          "--width",
                                                          "--degrees-per-pixel",
                                                          "--aux-layers",
                                                          "--set",
                                                          "--backend",
                                                          "--stereo",
                                                          "--eye-base",
                                                          "--stereo-method",
                                                          "--stereo-gap",
                                                          "--tolerance",
                                                          "--sun",
                                                          "--interest",
                                                          "--allow-incomplete",
                                                          "--latitude"};

void check_options_beside_sidecar(const Common& common) {
  for (const std::string& word : common.words) {
    const std::string_view option = std::string_view(word).substr(0, word.find('='));
    if (std::find(kRecipeOptions.begin(), kRecipeOptions.end(), option) == kRecipeOptions.end()) continue;
    throw UsageError(std::string(option) +
                     " and --from-sidecar: the image is made as the sidecar says; leave one out");
  }
}

PanoramaRequest request_from_sidecar(const PanoramaArguments& arguments, const Common& common) {
  check_options_beside_sidecar(common);
  const fs::path path = arguments.from_sidecar;
  const std::vector<std::uint8_t> bytes = base::read_file(path, kMostSidecarBytes);
  const auto refused = [&path](const std::exception& e) {
    return base::file_error("use", path, e.what(), "give the JSON that 'vpe panorama' wrote beside an image");
  };
  PanoramaRequest request;
  try {
    const auto object = nlohmann::json::parse(bytes, nullptr, false);
    const auto made = object.is_object() ? object.find("vpe") : object.end();
    if (object.is_discarded()) throw panorama::MetadataError("not well-formed JSON");
    if (made == object.end() || !made->is_object() || !made->contains("recipe")) {
      throw panorama::MetadataError("it has no \"vpe\" with a \"recipe\"");
    }
    request = request_from_recipe(made->at("recipe"));
    const std::string image = object.value("image", "");
    if (arguments.output.empty() && image.empty()) throw panorama::MetadataError("it names no image");
    request.output =
        arguments.output.empty() ? path.parent_path() / fs::path(image).filename() : fs::path(arguments.output);
    const std::string by = made->value("version", "");
    if (by != version()) {
      std::fprintf(stderr, "vpe: warning: %s was made by version %s; this is %s, whose bytes may differ\n",
                   path.c_str(), by.c_str(), version());
    }
  } catch (const panorama::MetadataError& e) {
    throw refused(e);
  } catch (const nlohmann::json::exception& e) {
    throw refused(e);
  }
  if (!arguments.planet.empty()) request.planet = absolute_planet(arguments.planet);
  request.latitude = "planetocentric";
  request.from_sidecar = arguments.from_sidecar;
  return request;
}

}  // namespace

PanoramaRequest parse_panorama(const PanoramaArguments& arguments, const Common& common) {
  PanoramaRequest request = arguments.from_sidecar.empty() ? request_from_options(arguments, common)
                                                           : request_from_sidecar(arguments, common);
  request.wait_s = arguments.render.wait_s;
  return request;
}

RenderOptions render_options(const PanoramaRequest& request) {
  RenderOptions options;
  options.backend = request.backend;
  options.interest = request.interest;
  options.wait_s = request.wait_s;
  options.allow_incomplete = request.allow_incomplete;
  return options;
}

}  // namespace vpe::app
