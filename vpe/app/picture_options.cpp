#include "vpe/app/picture_options.h"

#include <algorithm>
#include <stdexcept>

#include "mars/sun.h"
#include "vpe/core/number.h"
#include "vpe/gl/polygon_renderer.h"

namespace vpe::app {

void add_picture_options(CLI::App& command, PictureOptions& options) {
  command
      .add_option("--set", options.set, "KEY=VALUE of the settings registry (repeatable; see 'vpe settings')")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--backend", options.backend, "How to draw")
      ->check(CLI::IsMember({"polygon"}))
      ->capture_default_str();
  command.add_option("--tolerance", options.tolerance_px, "Largest geometric error, pixels")
      ->check(number_within(0.0, 1000.0));
  command.add_option("--wait", options.wait_s, "Longest time to wait for the tiles of a picture, seconds")
      ->check(number_within(0.0, 1e6))
      ->capture_default_str();
  command.add_flag("--allow-incomplete", options.allow_incomplete,
                   "Draw coarser ground where tiles cannot be read or do not come in time, instead of failing");
}

core::Settings make_settings(const PictureOptions& options) {
  core::Settings settings;
  if (options.tolerance_px >= 0) {
    const std::string trouble = settings.set("lod.tolerance", core::format_number(options.tolerance_px));
    if (!trouble.empty()) throw UsageError("--tolerance: " + trouble);
  }
  for (const std::string& assignment : options.set) {
    const std::string trouble = settings.assign(assignment);
    if (!trouble.empty()) throw UsageError("--set " + assignment + ": " + trouble);
  }
  return settings;
}

std::unique_ptr<core::Renderer> make_renderer(const PictureOptions& options, const Common& common,
                                              std::shared_ptr<const paging::PlanetFile> planet) {
  (void)options;
  gl::RendererOptions renderer;
  renderer.memory_bytes = static_cast<std::size_t>(common.memory_mb) << 20;
  renderer.threads = common.threads;
  return gl::make_polygon_renderer(gl::Context::create(), std::move(planet), renderer);
}

void require_complete(const PictureOptions& options, const core::DrawResult& result) {
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
                           core::format_number(options.wait_s) +
                           "); --allow-incomplete draws coarser ground there");
}

glm::dvec3 sun_for(const core::SettingsValues& settings, const mars::Pose& pose) {
  return mars::sun_direction({pose.lon_deg, pose.lat_deg}, settings.sun_azimuth_deg,
                             settings.sun_elevation_deg);
}

Size parse_size(const std::string& text) {
  const std::size_t x = text.find('x');
  std::optional<std::int64_t> width;
  std::optional<std::int64_t> height;
  if (x != std::string::npos) {
    width = core::parse_integer(std::string_view(text).substr(0, x));
    height = core::parse_integer(std::string_view(text).substr(x + 1));
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
