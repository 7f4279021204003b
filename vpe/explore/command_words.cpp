#include "vpe/explore/command_words.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

using base::format_number;

constexpr std::string_view kOverlays = "overlay.";
constexpr std::array<std::string_view, 6> kOfPanoramas{"overlay.names",         "overlay.distances",
                                                       "overlay.compass",       "overlay.layers",
                                                       "overlay.layers.hidden", "overlay.layers.legend"};

template <class Keeps>
void add_settings(const Session& session, const Keeps& keeps, std::vector<std::string>& words) {
  const core::Settings defaults;
  for (const core::SettingInfo& info : core::Settings::list()) {
    const std::string value = session.settings().get(info.key).value_or("");
    // The time of an image is a matter of windows.
    if (value == defaults.get(info.key).value_or("") || info.key == "lod.frame_ms" || !keeps(info.key))
      continue;
    words.emplace_back("--set");
    words.push_back(std::string(info.key) + "=" + value);
  }
}

void add_settings(const Session& session, bool has_overlays, std::vector<std::string>& words) {
  add_settings(
      session, [&](std::string_view key) { return has_overlays || !key.starts_with(kOverlays); }, words);
}

void add_output(const MakeOptions& options, std::vector<std::string>& words) {
  words.emplace_back("-o");
  words.push_back(options.output);
}

std::vector<std::string> command(const char* name, const MakeOptions& options) {
  std::vector<std::string> words{name};
  if (!options.planet.empty()) words.push_back(options.planet);
  return words;
}

std::string lon_lat_word(mars::LonLat place) {
  return format_number(place.lon_deg) + "," + format_number(place.lat_deg);
}

// `height` is the word of the camera's height or altitude.
std::vector<std::string> panorama_command(const Session& session, mars::LonLat place, const std::string& height,
                                          const MakeOptions& options) {
  std::vector<std::string> words = command("panorama", options);
  words.push_back("--at=" + lon_lat_word(place));
  words.push_back(height);
  if (options.width_px > 0) {
    words.emplace_back("--width");
    words.push_back(std::to_string(options.width_px));
  }
  add_settings(
      session,
      [&](std::string_view key) {
        return !key.starts_with(kOverlays) ||
               (options.has_overlays && std::ranges::count(kOfPanoramas, key) > 0);
      },
      words);
  add_output(options, words);
  return words;
}

}  // namespace

std::vector<std::string> image_words(const Session& session, const MakeOptions& options) {
  std::vector<std::string> words = command("render", options);
  const mars::HeadAngles& look = session.look();
  const bool looks_aside = look.yaw_deg != 0 || look.pitch_deg != 0 || look.roll_deg != 0;
  const mars::Pose p =
      looks_aside ? mars::to_pose(session.view().camera, session.ground().radius_m) : session.pose();
  std::string pose;
  for (const double value : {p.lon_deg, p.lat_deg, p.alt_m, p.yaw_deg, p.pitch_deg, p.roll_deg})
    pose += (pose.empty() ? "" : ",") + format_number(value);
  // As one word: negative longitudes are no options.
  words.push_back("--pose=" + pose);
  words.emplace_back("--fov");
  words.push_back(format_number(session.screen().fov_deg));
  const bool has_size = options.width_px > 0 && options.height_px > 0;
  words.emplace_back("--size");
  words.push_back(std::to_string(has_size ? options.width_px : session.screen().width) + "x" +
                  std::to_string(has_size ? options.height_px : session.screen().height));
  if (options.backend) {
    words.emplace_back("--backend");
    words.emplace_back(core::to_string(*options.backend));
  }
  if (options.stereo) {
    words.emplace_back("--stereo");
    words.emplace_back(core::to_string(*options.stereo));
    if (options.eye_base_m > 0) {
      words.emplace_back("--eye-base");
      words.push_back(format_number(options.eye_base_m));
    }
    if (options.convergence_m > 0) {
      words.emplace_back("--convergence");
      words.push_back(format_number(options.convergence_m));
    }
  }
  add_settings(session, options.has_overlays, words);
  add_output(options, words);
  return words;
}

std::vector<std::string> film_words(const Session& session, const std::string& flight,
                                    const MakeOptions& options) {
  std::vector<std::string> words{"fly", flight};
  if (!options.planet.empty()) words.push_back(options.planet);
  if (options.width_px > 0 && options.height_px > 0) {
    words.emplace_back("--size");
    words.push_back(std::to_string(options.width_px) + "x" + std::to_string(options.height_px));
  }
  if (options.backend) {
    words.emplace_back("--backend");
    words.emplace_back(core::to_string(*options.backend));
  }
  add_settings(session, options.has_overlays, words);
  add_output(options, words);
  return words;
}

std::vector<std::string> panorama_words(const Session& session, const MakeOptions& options) {
  return panorama_command(session, {session.pose().lon_deg, session.pose().lat_deg},
                          "--altitude=" + format_number(session.pose().alt_m), options);
}

std::vector<std::string> panorama_words_at(const Session& session, mars::LonLat place, double height_m,
                                           const MakeOptions& options) {
  return panorama_command(session, place, "--height=" + format_number(height_m), options);
}

double usual_reach_m(double post_spacing_m, double planet_radius_m) {
  constexpr double kPosts = 1000;
  constexpr double kLeast_m = 1000;
  constexpr double kMost_m = 150'000;
  const double quarter_m = planet_radius_m * mars::kPi / 2;
  return std::min(std::clamp(kPosts * post_spacing_m, kLeast_m, kMost_m), 0.99 * quarter_m);
}

std::vector<std::string> viewshed_words(mars::LonLat place, double height_m, double reach_m,
                                        const MakeOptions& options) {
  std::vector<std::string> words = command("viewshed", options);
  words.push_back("--at=" + lon_lat_word(place));
  words.emplace_back("--from-height");
  words.push_back(format_number(height_m));
  words.emplace_back("--radius");
  words.push_back(format_number(reach_m));
  add_output(options, words);
  return words;
}

}  // namespace vpe::explore
