// vpe compare.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>

#include "cull/frustum.h"
#include "paging/build/builder.h"
#include "paging/surface/change.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/commands.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/pose_option.h"
#include "vpe/app/planet/build_request.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

struct CompareArguments {
  std::string earlier;
  std::string later;
  std::string region;
  std::string pose;
  std::optional<double> height_m;
  std::string size = "1280x720";
  double fov_deg = 50;
  std::optional<double> threshold_m;
};

paging::ChangeRegion within(const paging::Region& box) {
  return {[box](const lod::TileKey& key) { return paging::touches(box, lod::bounding_cap(key)); },
          [box](const glm::dvec3& direction) {
            return paging::touches(box, {direction, 0});
          }};
}

// Ground of `later` counts that the view shows: it projects into the image, and no other ground hides it.
paging::ChangeRegion shown_in(const core::View& view, const paging::Surface& later) {
  // Of a distance: the facet at a place must not hide the place itself.
  constexpr double kNearer = 1e-6;
  const cull::Frustum frustum = cull::make_frustum(view);
  const auto may_hold = [frustum, &later](const lod::TileKey& key) {
    const lod::TileTree& tree = later.planet().tree();
    const lod::TileInfo& tile = tree.deepest(key);
    cull::BoundingRegion region =
        tree.region(static_cast<lod::TileTree::Index>(&tile - tree.tiles().data()), 1, 0);
    region.rect = lod::chart_rect(key);
    return cull::planes_crossed(frustum, cull::bounding_hexahedron(region), cull::all_planes(frustum))
        .has_value();
  };
  const auto holds = [view, &later](const glm::dvec3& direction) {
    const glm::dvec3 place_m = direction * later.at(direction).radius_m;
    const core::Projected at = core::project(view, place_m);
    if (at.behind || at.xy.x < 0 || at.xy.y < 0 || at.xy.x > view.width || at.xy.y > view.height) return false;
    const glm::dvec3 way_m = place_m - view.camera.position_m;
    const double distance_m = glm::length(way_m);
    const double end_m = distance_m * (1 - kNearer);
    return later.cast(view.camera.position_m, way_m / distance_m, 1, {0, end_m}) >= end_m;
  };
  return {may_hold, holds};
}

core::View parse_compared_view(const CompareArguments& arguments,
                               const std::shared_ptr<const paging::PlanetFile>& planet) {
  core::View view;
  const Size size = parse_size(arguments.size);
  const mars::Pose pose = resolve(parse_pose("--pose", arguments.pose, arguments.height_m), planet, 1);
  view.camera = mars::to_camera(pose, planet->radius_m());
  view.width = size.width;
  view.height = size.height;
  view.fov_deg = arguments.fov_deg;
  if (const std::string error = core::check(view); !error.empty()) throw UsageError(error);
  return view;
}

nlohmann::json to_json(const std::optional<paging::ChangeExtreme>& extreme) {
  if (!extreme) return {};
  return {{"difference_m", extreme->difference_m},
          {"lon_deg", extreme->place.lon_deg},
          {"lat_deg", extreme->place.lat_deg}};
}

nlohmann::json to_json(const paging::ChangeStatistics& change) {
  const auto value = [](const std::optional<double>& x) { return x ? nlohmann::json(*x) : nlohmann::json(); };
  return {{"area_m2", change.area_m2},
          {"nodata_area_m2", change.nodata_area_m2},
          {"changed_area_m2", change.changed_area_m2},
          {"mean_m", value(change.mean_m)},
          {"median_m", value(change.median_m)},
          {"rms_m", value(change.rms_m)},
          {"least", to_json(change.least)},
          {"most", to_json(change.most)},
          {"gained_m3", change.gained_m3},
          {"lost_m3", change.lost_m3},
          {"triangles", change.triangles}};
}

void print_change(const paging::ChangeStatistics& change, double threshold_m) {
  const auto number = [](double x) { return base::format_significant(x, 6); };
  const auto metres = [&](const std::optional<double>& x) {
    return x ? number(*x) + " m" : std::string("none");
  };
  const auto extreme = [&](const std::optional<paging::ChangeExtreme>& e) {
    if (!e) return std::string("none");
    return number(e->difference_m) + " m at " + base::format_fixed(e->place.lon_deg, 6) + "," +
           base::format_fixed(e->place.lat_deg, 6);
  };
  const std::string changed = "changed by more than " + base::format_number(threshold_m) + " m";
  std::printf("area %s m2, of it %s: %s m2; nodata: %s m2\n", number(change.area_m2).c_str(), changed.c_str(),
              number(change.changed_area_m2).c_str(), number(change.nodata_area_m2).c_str());
  std::printf("difference: mean %s, median %s, RMS %s\n", metres(change.mean_m).c_str(),
              metres(change.median_m).c_str(), metres(change.rms_m).c_str());
  std::printf("  from %s\n  to %s\n", extreme(change.least).c_str(), extreme(change.most).c_str());
  std::printf("volume: gained %s m3, lost %s m3\n", number(change.gained_m3).c_str(),
              number(change.lost_m3).c_str());
}

void run_compare(const CompareArguments& arguments, const Common& common) {
  if (!arguments.region.empty() && !arguments.pose.empty())
    throw UsageError("--region and --pose: give one of both, or none for the whole planet");
  if (arguments.height_m && arguments.pose.empty()) throw UsageError("--height needs --pose");
  const std::optional<paging::Region> box =
      arguments.region.empty() ? std::nullopt : std::optional(parse_region(arguments.region));
  const auto earlier_planet = open_planet(arguments.earlier, common);
  const auto later_planet = open_planet(arguments.later, common);
  const std::size_t budget = memory_bytes(common) / 2;
  const paging::Surface earlier(earlier_planet, budget);
  const paging::Surface later(later_planet, budget);
  paging::ChangeRegion region;
  if (box) region = within(*box);
  if (!arguments.pose.empty()) region = shown_in(parse_compared_view(arguments, later_planet), later);
  const double threshold_m = arguments.threshold_m.value_or(
      std::max(earlier_planet->meta().quantum_m, later_planet->meta().quantum_m));
  const InterruptGuard guard;
  ProgressLine line(common.quiet);
  base::ThreadPool pool(common.threads);
  const paging::ChangeStatistics change = paging::measure_change(earlier, later, region,
                                                                 {.threshold_m = threshold_m,
                                                                  .tell =
                                                                      [&](double share) {
                                                                        InterruptGuard::check();
                                                                        line.show("compare", share);
                                                                      }},
                                                                 pool);
  if (!common.json) {
    print_change(change, threshold_m);
    return;
  }
  nlohmann::json out = to_json(change);
  out["earlier"] = {{"path", earlier_planet->path()}, {"identity", earlier_planet->meta().identity}};
  out["later"] = {{"path", later_planet->path()}, {"identity", later_planet->meta().identity}};
  out["radius_m"] = later_planet->radius_m();
  out["threshold_m"] = threshold_m;
  out["region"] =
      box ? nlohmann::json({box->west_deg, box->south_deg, box->east_deg, box->north_deg}) : nlohmann::json();
  out["pose"] = arguments.pose.empty() ? nlohmann::json() : nlohmann::json(arguments.pose);
  print_json(out);
}

}  // namespace

void add_compare(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = add_command(
      program, "compare",
      "Print how the ground of a planet differs from that of an earlier one: areas, heights, volumes", common,
      true);
  command->add_option("EARLIER", arguments->earlier, "Planet file or DEM")->required();
  command->add_option("LATER", arguments->later, "Planet file or DEM of the same body, radius and datum")
      ->required();
  command->add_option("--region", arguments->region,
                      "WEST,SOUTH,EAST,NORTH in degrees: only there (default: the whole planet)");
  command->add_option("--pose", arguments->pose,
                      "LON,LAT,ALT,YAW,PITCH,ROLL of a camera: only the ground of LATER that it sees");
  command
      ->add_option("--height", arguments->height_m,
                   "Height of the camera above the terrain, metres; replaces ALT")
      ->check(number_within(-1e7, 1e10));
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT of the camera's image, pixels")
      ->capture_default_str();
  command->add_option("--fov", arguments->fov_deg, "Vertical field of view, degrees")
      ->check(number_within(core::ViewLimits::kMinFov_deg, core::ViewLimits::kMaxFov_deg))
      ->capture_default_str();
  command
      ->add_option(
          "--threshold", arguments->threshold_m,
          "Ground has changed where it differs by more than this, metres (default: the larger step of both "
          "planets' heights)")
      ->check(number_within(0, 1e7));
  add_examples(*command, {{"what a patch has moved", "vpe compare before.vpe after.vpe"},
                          {"inside a box, for programs",
                           "vpe compare before.vpe after.vpe --region 137.2,-4.8,137.6,-4.4 --json"},
                          {"what a camera sees of it",
                           "vpe compare before.vpe after.vpe --pose 137.4,-4.6,0,90,-20,0 --height 500"}});
  command->callback([arguments, &common] { run_compare(*arguments, common); });
}

}  // namespace vpe::app
