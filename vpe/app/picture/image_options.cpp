#include "vpe/app/picture/image_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "lod/options.h"
#include "mars/geodesy/mars_time.h"
#include "mars/geodesy/sun.h"
#include "objects/files/scene_file.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/scene/object_renderer.h"
#include "vpe/base/heap.h"
#include "vpe/base/number.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {

namespace {

constexpr std::string_view kAuto = "auto";
// What a ray image may take whatever --memory is: 2560x1440 pixels need 247 MB.
constexpr std::size_t kLeastImageBytes = std::size_t{256} << 20;

// Returns "1 tile is", or "3 more tiles are" with the words between.
std::string tiles_are(std::size_t count, const std::string& words = "") {
  return std::to_string(count) + " " + words + (count == 1 ? "tile is" : "tiles are");
}

}  // namespace

void add_render_options(CLI::App& command, RenderOptions& options) {
  command
      .add_option("--set", options.set, "KEY=VALUE: change a setting ('vpe settings' lists them; repeatable)")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  const std::string polygon(core::to_string(core::Backend::kPolygon));
  const std::string ray(core::to_string(core::Backend::kRay));
  command
      .add_option_function<std::string>(
          "--backend", [&options](const std::string& text) { options.backend = core::parse_backend(text); },
          "polygon: triangles, by OpenGL; ray: ray casting on the CPU, by default against the exact surface; "
          "auto: the faster one within the tolerance (rays without a GPU, for nearby views that reach the "
          "horizon)")
      ->check(CLI::IsMember({std::string(kAuto), polygon, ray}))
      ->default_str(std::string(options.backend ? core::to_string(*options.backend) : kAuto));
  command.add_option("--tolerance", options.tolerance_px, "Largest geometric error in the image, pixels")
      ->check(number_within(0.0, 1000.0));
  command.add_option("--sun", options.sun,
                     "Position of the sun: a date such as 2026-11-20T12:00Z; a season and hour such as "
                     "Ls90,15:00 (solar longitude, and local true solar time at the ground below the camera); "
                     "or local, for the azimuth and elevation of the settings");
  command.add_option("--scene", options.scene,
                     "Objects on the ground: a scene file, *.scene.toml, or GeoJSON points with models");
  command.add_option("--wait", options.wait_s, "Longest time to wait for the tiles of an image, seconds")
      ->check(number_within(0.0, 1e6))
      ->capture_default_str();
  command.add_flag(
      "--allow-incomplete", options.allow_incomplete,
      "Draw coarser terrain where tiles cannot be read or do not arrive in time, instead of failing");
  command
      .add_option(
          "--interest", options.interest,
          "LON,LAT,RADIUS,LEVELS: draw a circle (degrees, metres) with LEVELS more levels of detail, or "
          "fewer where LEVELS is negative (repeatable; overlapping circles add up)")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

std::vector<core::InterestRegion> parse_interest(const RenderOptions& options) {
  using Limits = core::InterestLimits;
  std::vector<core::InterestRegion> regions;
  for (const std::string& text : options.interest) {
    const auto n = parse_numbers(text);
    const bool good = n && n->size() == 4 && std::abs((*n)[0]) <= 360.0 && std::abs((*n)[1]) <= 90.0 &&
                      (*n)[2] >= 0.0 && (*n)[2] <= Limits::kMaxRadius_m &&
                      std::abs((*n)[3]) <= Limits::kMaxLevels && (*n)[3] == std::trunc((*n)[3]);
    if (!good) {
      const std::string most = std::to_string(Limits::kMaxLevels);
      throw UsageError(
          "--interest '" + text +
          "': expected LON,LAT,RADIUS,LEVELS: degrees (longitude -360..360, latitude -90..90), metres (0.." +
          base::format_number(Limits::kMaxRadius_m) + "), a whole number (-" + most + ".." + most + ")");
    }
    regions.push_back({(*n)[0], (*n)[1], (*n)[2], static_cast<int>((*n)[3])});
  }
  return regions;
}

void make_interest_planetocentric(std::vector<std::string>& interest, const std::string& latitude,
                                  const paging::PlanetMeta& meta) {
  const auto spheroid = spheroid_of_places(latitude, meta);
  if (!spheroid) return;
  for (std::string& text : interest) {
    auto numbers = parse_numbers(text);
    if (!numbers || numbers->size() != 4) throw std::logic_error("--interest " + text + ": was not checked");
    (*numbers)[1] = mars::planetocentric_lat_deg((*numbers)[1], *spheroid);
    text.clear();
    for (const double number : *numbers) text += (text.empty() ? "" : ",") + base::format_number(number);
  }
}

std::size_t memory_bytes(const Common& common) { return static_cast<std::size_t>(common.memory_mb) << 20; }

core::Settings make_settings(const RenderOptions& options) {
  core::Settings settings;
  if (options.tolerance_px >= 0) {
    const std::string error = settings.set("lod.tolerance", base::format_number(options.tolerance_px));
    if (!error.empty()) throw UsageError("--tolerance: " + error);
  }
  if (!options.sun.empty()) {
    const std::string error = settings.set("sun", options.sun);
    if (!error.empty()) throw UsageError("--sun: " + error);
  }
  if (!options.scene.empty()) {
    const std::string error = settings.set("scene", options.scene);
    if (!error.empty()) throw UsageError("--scene: " + error);
  }
  for (const std::string& assignment : options.set) {
    const std::string error = settings.assign(assignment);
    if (!error.empty()) throw UsageError("--set " + assignment + ": " + error);
  }
  // What is wrong in it is told before any work.
  if (!settings.values().scene.empty()) (void)objects::read_scene_file(settings.values().scene);
  return settings;
}

std::unique_ptr<core::Renderer> make_renderer(const RenderOptions& options, const Common& common,
                                              std::shared_ptr<const paging::PlanetFile> planet,
                                              std::vector<lod::TileExplanation>* explained) {
  // A compact heap costs a fifth of a film's time in page faults, so it is used only where memory is short.
  constexpr int kTightMemory_mb = 512;
  if (common.memory_mb < kTightMemory_mb) base::keep_heap_compact();
  if (!options.backend) throw std::logic_error("make_renderer: no backend was chosen");
  const ObjectRendererOptions objects{.threads = common.threads,
                                      .note = [quiet = common.quiet](const std::string& note) {
                                        if (!quiet) std::fprintf(stderr, "vpe: note: %s\n", note.c_str());
                                      }};
  if (*options.backend == core::Backend::kRay)
    return with_objects(
        voxel::make_ray_renderer(planet, {.memory_bytes = memory_bytes(common),
                                          .threads = common.threads,
                                          .max_image_bytes = std::max(memory_bytes(common), kLeastImageBytes),
                                          .explained = explained}),
        planet, objects);
  gl::RendererOptions renderer;
  renderer.memory_bytes = memory_bytes(common);
  renderer.threads = common.threads;
  return with_objects(gl::make_polygon_renderer(gl::Context::create(), planet, renderer), planet, objects);
}

void require_budget(const core::SettingsValues& settings, core::Backend backend) {
  if (lod::is_even(lod::degrade_weights(settings))) return;
  if (backend == core::Backend::kPolygon && settings.lod_triangles > 0) return;
  throw UsageError(
      "degrade.* weighs what a budget takes, and this image has none: add --set lod.triangles=N with --backend "
      "polygon, or leave it out (lod.frame_ms is the budget of windows)");
}

void require_complete(const RenderOptions& options, const core::DrawResult& result) {
  constexpr std::size_t kNamed = 3;
  if (options.allow_incomplete || result.missing.empty()) return;
  std::vector<core::MissingTile> missing = result.missing;
  const auto late = std::stable_partition(missing.begin(), missing.end(),
                                          [](const core::MissingTile& m) { return m.is_unreadable; });
  const auto unreadable = static_cast<std::size_t>(late - missing.begin());
  const std::size_t not_loaded = missing.size() - unreadable;
  const std::size_t named = std::min(unreadable > 0 ? unreadable : not_loaded, kNamed);
  std::string text = tiles_are(missing.size()) + " missing in the image:";
  for (std::size_t n = 0; n < named; ++n) text += "\n     " + missing[n].tile + ": " + missing[n].why;
  if (unreadable > named) text += "\n     " + tiles_are(unreadable - named, "more ") + " unreadable";
  if (unreadable > 0 && not_loaded > 0) text += "\n     " + tiles_are(not_loaded, "other ") + " not loaded yet";
  if (unreadable == 0 && not_loaded > named)
    text += "\n     and " + std::to_string(not_loaded - named) + " more";
  text += unreadable > 0
              ? "\n     'vpe verify' names all damage of the planet file; "
              : "\n     --wait SECONDS waits longer (now " + base::format_number(options.wait_s) + "); ";
  throw std::runtime_error(text + "--allow-incomplete draws coarser terrain there");
}

void note_limited_by_memory(const RenderOptions& options, const Common& common,
                            const core::DrawRequest& request, const core::DrawResult& result) {
  const core::Certificate& c = result.certificate;
  if (*options.backend != core::Backend::kPolygon || !voxel::refused_control(request).empty() ||
      !voxel::multires_control(request).empty() || request.coarsening > 1 || c.tiles_missing > 0 ||
      c.tiles_substituted > 0)
    return;
  // Finest tiles have meshes without error, so nothing else keeps tiles from the tolerance.
  if (!(c.screen_space_error_px > c.tolerance_px)) return;
  const std::int64_t most = gl::most_triangles(memory_bytes(common));
  std::fprintf(
      stderr,
      "vpe: note: coarser than --tolerance %s: --memory %lld is enough for %lld triangles; tiles are off "
      "by up to %.3g m (%.2g px). Give more --memory, or use --backend ray\n",
      base::format_number(c.tolerance_px).c_str(), static_cast<long long>(common.memory_mb),
      static_cast<long long>(most), c.geometric_error_m, c.screen_space_error_px);
}

void print_failures(std::span<const std::string> failures) {
  for (const std::string& failure : failures) std::fprintf(stderr, "vpe: warning: %s\n", failure.c_str());
}

glm::dvec3 sun_for(const core::SettingsValues& settings, const mars::Pose& pose) {
  const mars::LonLat below{pose.lon_deg, pose.lat_deg};
  const auto sun = mars::sun_direction(mars::parse_sun(settings.sun).value_or(mars::LocalSun{}), below);
  return sun ? *sun : mars::sun_direction(below, settings.sun_azimuth_deg, settings.sun_elevation_deg);
}

Size parse_size(const std::string& text) {
  const std::size_t x = text.find('x');
  std::optional<std::int64_t> width;
  std::optional<std::int64_t> height;
  if (x != std::string::npos) {
    width = base::parse_integer(std::string_view(text).substr(0, x));
    height = base::parse_integer(std::string_view(text).substr(x + 1));
  }
  const auto fits = [](const std::optional<std::int64_t>& n) {
    return n && *n >= 1 && *n <= core::ViewLimits::kMaxSide_px;
  };
  if (!fits(width) || !fits(height)) {
    throw UsageError("--size '" + text + "': expected WIDTHxHEIGHT, each within 1.." +
                     std::to_string(core::ViewLimits::kMaxSide_px));
  }
  return {static_cast<int>(*width), static_cast<int>(*height)};
}

}  // namespace vpe::app
