#include "vpe/app/picture/image_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mars/geodesy/mars_time.h"
#include "mars/geodesy/sun.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/heap.h"
#include "vpe/base/number.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {

void add_render_options(CLI::App& command, RenderOptions& options) {
  command
      .add_option("--set", options.set, "KEY=VALUE of the settings registry (repeatable; see 'vpe settings')")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--backend", options.backend,
                  "How to draw: polygon: triangles by OpenGL; voxel: a ray a pixel against the exact surface; "
                  "auto: what is quicker within the tolerance (rays in views to the horizon from nearby when "
                  "there is no "
                  "GPU)")
      ->check(CLI::IsMember({kAutoBackend, kPolygonBackend, kRayBackend}))
      ->capture_default_str();
  command.add_option("--tolerance", options.tolerance_px, "Largest geometric error, pixels")
      ->check(number_within(0.0, 1000.0));
  command.add_option(
      "--sun", options.sun,
      "Where the light comes from: a date as 2026-11-20T12:00Z, Ls90,15:00 (solar longitude and local "
      "true solar time at the ground below the eye), or local");
  command.add_option("--wait", options.wait_s, "Longest time to wait for the tiles of a picture, seconds")
      ->check(number_within(0.0, 1e6))
      ->capture_default_str();
  command.add_flag("--allow-incomplete", options.allow_incomplete,
                   "Draw coarser ground where tiles cannot be read or do not come in time, instead of failing");
  command
      .add_option("--interest", options.interest,
                  "LON,LAT,RADIUS,LEVELS: a circle (degrees, metres) with so many levels of detail more or, "
                  "negative, fewer (repeatable; overlapping circles add up)")
      ->expected(1)
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

std::size_t memory_bytes(const Common& common) { return static_cast<std::size_t>(common.memory_mb) << 20; }

core::Settings make_settings(const RenderOptions& options) {
  core::Settings settings;
  if (options.tolerance_px >= 0) {
    const std::string trouble = settings.set("lod.tolerance", base::format_number(options.tolerance_px));
    if (!trouble.empty()) throw UsageError("--tolerance: " + trouble);
  }
  if (!options.sun.empty()) {
    const std::string trouble = settings.set("sun", options.sun);
    if (!trouble.empty()) throw UsageError("--sun: " + trouble);
  }
  for (const std::string& assignment : options.set) {
    const std::string trouble = settings.assign(assignment);
    if (!trouble.empty()) throw UsageError("--set " + assignment + ": " + trouble);
  }
  return settings;
}

std::unique_ptr<core::Renderer> make_renderer(const RenderOptions& options, const Common& common,
                                              std::shared_ptr<const paging::PlanetFile> planet) {
  // It costs a fifth of a film's time in page faults, so only who is short of memory pays.
  constexpr int kTightMemory_mb = 512;
  if (common.memory_mb < kTightMemory_mb) base::keep_heap_compact();
  if (options.backend == kAutoBackend) throw std::logic_error("make_renderer: a backend is chosen before");
  if (options.backend == kRayBackend)
    return voxel::make_ray_renderer(std::move(planet), {memory_bytes(common), common.threads});
  gl::RendererOptions renderer;
  renderer.memory_bytes = memory_bytes(common);
  renderer.threads = common.threads;
  return gl::make_polygon_renderer(gl::Context::create(), std::move(planet), renderer);
}

void require_complete(const RenderOptions& options, const core::DrawResult& result) {
  constexpr std::size_t kNamed = 3;
  if (options.allow_incomplete || result.missing.empty()) return;
  const std::size_t count = result.missing.size();
  std::string text =
      std::to_string(count) + (count == 1 ? " tile is" : " tiles are") + " missing in the picture:";
  for (std::size_t n = 0; n < std::min(count, kNamed); ++n) {
    text += "\n     " + result.missing[n].tile + ": " + result.missing[n].why;
  }
  if (count > kNamed) text += "\n     and " + std::to_string(count - kNamed) + " more";
  throw std::runtime_error(text + "\n     --wait SECONDS waits longer (now " +
                           base::format_number(options.wait_s) +
                           "); --allow-incomplete draws coarser ground there");
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
