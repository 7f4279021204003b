#include "vpe/app/panorama/panorama_request.h"

#include <cstdio>

#include "panorama/image/metadata_error.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/file.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

using panorama::MapKind;

// The largest JSON that is read.
constexpr std::uintmax_t kMostSidecarBytes = std::uintmax_t{1} << 24;

MapKind kind_of(const PanoramaArguments& arguments) {
  const bool is_polygons = arguments.panorama_image.backend == "polygon";
  if (arguments.projection.empty()) return is_polygons ? MapKind::kFacets : MapKind::kCylinder;
  for (const MapKind kind : {MapKind::kCylinder, MapKind::kEquirectangular, MapKind::kFacets}) {
    if (arguments.projection != panorama::to_string(kind)) continue;
    if (is_polygons && kind != MapKind::kFacets) {
      throw UsageError("--projection " + arguments.projection +
                       ": triangles are drawn in planes only; use --projection facets or --backend voxel");
    }
    return kind;
  }
  throw UsageError("--projection '" + arguments.projection + "': give facets, cylinder or equirectangular");
}

panorama::PlanOptions plan_options(const PanoramaArguments& arguments) {
  panorama::PlanOptions plan;
  plan.kind = kind_of(arguments);
  if (arguments.has_facets && plan.kind != MapKind::kFacets) {
    throw UsageError("--facets: a picture of projection " + std::string(panorama::to_string(plan.kind)) +
                     " has none; add --projection facets");
  }
  plan.facets = arguments.facets;
  plan.yaw_deg = arguments.yaw_deg;
  if (arguments.from_deg.has_value() != arguments.to_deg.has_value()) {
    throw UsageError("--from and --to belong together: the azimuths of the picture's left and right edge");
  }
  if (arguments.from_deg) plan.arc = panorama::Arc{*arguments.from_deg, *arguments.to_deg};
  if (plan.arc && arguments.has_yaw && plan.kind != MapKind::kFacets) {
    throw UsageError("--yaw and --from both say where the picture begins; leave one out");
  }
  if (!arguments.elevation.empty()) {
    const auto numbers = parse_numbers(arguments.elevation);
    if (!numbers || numbers->size() != 2) {
      throw UsageError("--elevation '" + arguments.elevation + "': expected MIN,MAX in degrees");
    }
    plan.lowest_deg = numbers->front();
    plan.highest_deg = numbers->back();
  }
  plan.width_px = arguments.width_px;
  plan.degrees_per_pixel = arguments.degrees_per_pixel;
  return plan;
}

std::string absolute_planet(const std::string& argument) {
  return argument.empty() ? argument : fs::absolute(argument).lexically_normal().string();
}

// A configuration file may have defaults of these; who names them beside --again means something else.
void check_alone(const Common& common) {
  for (const char* name : {"--at",
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
                           "--planes",
                           "--set",
                           "--backend",
                           "--stereo",
                           "--eye-base",
                           "--tolerance",
                           "--sun",
                           "--interest",
                           "--allow-incomplete"}) {
    for (const std::string& word : common.words) {
      if (word != name && !word.starts_with(std::string(name) + "=")) continue;
      throw UsageError(std::string(name) + " and --again: the picture is made as the JSON says; leave one out");
    }
  }
}

}  // namespace

PanoramaOrder new_order(PanoramaArguments arguments, const Common& common) {
  if (arguments.panorama_image.backend == kAutoBackend) arguments.panorama_image.backend = kRayBackend;
  if (arguments.at.empty() || arguments.output.empty())
    throw UsageError("--at LON,LAT and -o PANO are needed, or --again PANO.json");
  const auto place = parse_place(arguments.at);
  if (!place) throw UsageError("--at '" + arguments.at + "': expected LON,LAT in degrees");
  if (!mars::is_valid(*place)) throw UsageError("--at '" + arguments.at + "': latitude must be within -90..90");
  if (arguments.height_m.has_value() == arguments.altitude_m.has_value()) {
    throw UsageError("give either --height (metres above the ground) or --altitude (metres above the sphere)");
  }
  PanoramaOrder order;
  PanoramaRecipe& recipe = order.recipe;
  recipe.backend = arguments.panorama_image.backend;
  recipe.plan = plan_options(arguments);
  recipe.camera.lon_deg = place->lon_deg;
  recipe.camera.lat_deg = place->lat_deg;
  recipe.camera.alt_m = arguments.altitude_m.value_or(0);
  recipe.settings = make_settings(arguments.panorama_image);
  parse_interest(arguments.panorama_image);
  recipe.interest = arguments.panorama_image.interest;
  recipe.planes = panorama::parse_planes(arguments.planes);
  recipe.planet = absolute_planet(arguments.planet);
  recipe.memory_mb = recipe.backend == "polygon" ? common.memory_mb : 0;
  recipe.allow_incomplete = arguments.panorama_image.allow_incomplete;
  order.stereo = arguments.stereo;
  order.height_m = arguments.height_m;
  order.output = arguments.output;
  return order;
}

PanoramaOrder order_again(const PanoramaArguments& arguments, const Common& common) {
  check_alone(common);
  const fs::path path = arguments.again;
  const std::vector<std::uint8_t> bytes = base::read_file(path, kMostSidecarBytes);
  PanoramaOrder order;
  try {
    const auto json = nlohmann::json::parse(bytes, nullptr, false);
    const auto made = json.is_object() ? json.find("vpe") : json.end();
    if (json.is_discarded()) throw panorama::MetadataError("not well-formed JSON");
    if (made == json.end() || !made->is_object() || !made->contains("recipe")) {
      throw panorama::MetadataError("it has no \"vpe\" with a \"recipe\"");
    }
    order.recipe = recipe_from(made->at("recipe"));
    const std::string image = json.value("image", "");
    if (arguments.output.empty() && image.empty()) throw panorama::MetadataError("it names no image");
    order.output =
        arguments.output.empty() ? path.parent_path() / fs::path(image).filename() : fs::path(arguments.output);
    const std::string by = made->value("version", "");
    if (by != version()) {
      std::fprintf(stderr, "vpe: warning: %s was made by version %s; this is %s, whose bytes may differ\n",
                   path.c_str(), by.c_str(), version());
    }
  } catch (const panorama::MetadataError& e) {
    throw base::file_error("use", path, e.what(), "give the JSON that 'vpe panorama' wrote beside a picture");
  } catch (const nlohmann::json::exception& e) {
    throw base::file_error("use", path, e.what(), "give the JSON that 'vpe panorama' wrote beside a picture");
  }
  if (!arguments.planet.empty()) order.recipe.planet = absolute_planet(arguments.planet);
  order.again = arguments.again;
  return order;
}

}  // namespace vpe::app
