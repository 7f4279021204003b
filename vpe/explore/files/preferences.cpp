#include "vpe/explore/files/preferences.h"

#include <algorithm>
#include <cmath>

namespace vpe::explore {

namespace fs = std::filesystem;

namespace {

constexpr const char* kName = "explore.toml";
constexpr int kMaxWindow_px = 16384;

constexpr std::string_view kPreferencesHead =
    "# Preferences of vpe explore. Lines that begin with # are defaults: take the first # away to change one.\n\n";
constexpr std::string_view kSessionHead =
    "# The last session of vpe explore, written by it. May be deleted.\n\n";

std::string any_text(const std::string&) { return ""; }

template <class T>
T read(const fs::path& file) {
  T values;
  if (file.empty()) return values;
  if (const auto text = read_user_file(file)) read_keys(*text, file.string(), keys_of(values));
  return values;
}

// So that what is written can be read again.
void keep_to_limits(std::span<const KeyEntry> keys, std::span<const KeyEntry> defaults) {
  for (std::size_t n = 0; n < keys.size(); ++n) {
    if (const auto* key = std::get_if<NumberKey>(&keys[n].member)) {
      if (!std::isfinite(*key->value)) *key->value = *std::get<NumberKey>(defaults[n].member).value;
      *key->value = std::clamp(*key->value, key->min, key->max);
    } else if (const auto* whole = std::get_if<IntegerKey>(&keys[n].member)) {
      *whole->value = std::clamp(*whole->value, whole->min, whole->max);
    } else if (const auto* text = std::get_if<TextKey>(&keys[n].member)) {
      if (!text->problem(*text->value).empty()) *text->value = *std::get<TextKey>(defaults[n].member).value;
    } else if (const auto* pose = std::get_if<PoseKey>(&keys[n].member)) {
      if (*pose->value && !is_pose(**pose->value)) pose->value->reset();
    }
  }
}

template <class T>
std::string text_of(T values, KeysShown shown) {
  T usual;
  const std::vector<KeyEntry> keys = keys_of(values);
  const std::vector<KeyEntry> defaults = keys_of(usual);
  keep_to_limits(keys, defaults);
  return write_keys(keys, defaults, shown);
}

std::string kept(const fs::path& file, const std::string& text) {
  if (file.empty()) return "nothing is kept, for there is no folder for it; set HOME to an absolute path";
  try {
    write_user_file(file, text);
    return "";
  } catch (const std::exception& e) {
    return e.what();
  }
}

}  // namespace

std::vector<KeyEntry> keys_of(Preferences& p) {
  using Pad = PadOptions;
  using Mouse = SpaceMouseOptions;
  using Head = HeadTrackerOptions;
  return {
      {"mouse.speed", NumberKey{&p.mouse_speed, 0.1, 10}, "factor on what a drag turns and tilts"},
      {"mouse.invert_wheel", SwitchKey{&p.invert_wheel}, "rolling the wheel away goes away"},
      {"move.speed", NumberKey{&p.fly_speed, 0.01, 100}, "factor on moving, by any device"},
      {"move.turn_speed", NumberKey{&p.turn_speed, 0.1, 10},
       "factor on turning, by keys, gamepad and space mouse"},
      {"draw.budget_ms", NumberKey{&p.draw_budget_ms, 0, 1000},
       "milliseconds that a picture may take while the eye moves, held by drawing coarser; 0 = none"},
      {"ui.scale", NumberKey{&p.ui_scale, 0, 8}, "of letters and panels; 0 = as the display says"},
      {"ui.longitude", choice_key(p.longitude, {"180", "360"}),
       "longitudes of the status line from -180 to 180 or from 0 to 360, east positive"},
      {"gamepad.enabled", SwitchKey{&p.use_gamepad}, "use a gamepad when one is plugged in"},
      {"gamepad.dead_zone", NumberKey{&p.gamepad.dead_zone, 0, Pad::kMaxDeadZone},
       "share of a stick's way that counts as rest"},
      {"gamepad.trigger_dead_zone", NumberKey{&p.gamepad.trigger_dead_zone, 0, Pad::kMaxDeadZone},
       "share of a trigger's way that counts as rest"},
      {"gamepad.curve", NumberKey{&p.gamepad.curve, Pad::kMinCurve, Pad::kMaxCurve},
       "power of the response; more is finer near rest"},
      {"gamepad.invert_pitch", SwitchKey{&p.gamepad.invert_pitch}, "right stick up looks down"},
      {"space_mouse.enabled", SwitchKey{&p.use_space_mouse}, "use a space mouse when spacenavd runs"},
      {"space_mouse.dead_zone", NumberKey{&p.space_mouse.dead_zone, 0, Mouse::kMaxDeadZone},
       "share of the cap's way that counts as rest"},
      {"space_mouse.curve", NumberKey{&p.space_mouse.curve, Mouse::kMinCurve, Mouse::kMaxCurve},
       "power of the response; more is finer near rest"},
      {"space_mouse.holds_ground", SwitchKey{&p.space_mouse.holds_ground},
       "the cap is the ground instead of the eye"},
      {"space_mouse.roll", SwitchKey{&p.space_mouse.roll}, "the cap may roll the view"},
      {"head_tracker.enabled", SwitchKey{&p.use_head_tracker},
       "listen for a head tracker (opentrack, UDP over network)"},
      {"head_tracker.address",
       TextKey{&p.head_from.address, "a numeric address such as 127.0.0.1", address_problem},
       "address of this machine at which to listen; 0.0.0.0 = all, so that other machines can send"},
      {"head_tracker.port", IntegerKey{&p.head_from.port, 1, 65535}, "port at which to listen"},
      {"head_tracker.invert_yaw", SwitchKey{&p.head.invert_yaw}, "left for right"},
      {"head_tracker.invert_pitch", SwitchKey{&p.head.invert_pitch}, "down for up"},
      {"head_tracker.invert_roll", SwitchKey{&p.head.invert_roll}, "roll left for right"},
      {"head_tracker.scale", NumberKey{&p.head.scale, Head::kMinScale, Head::kMaxScale},
       "factor on all angles"},
      {"head_tracker.smoothing_s", NumberKey{&p.head.smoothing_s, 0, Head::kMaxSmoothing_s},
       "seconds in which 63 % of a step is followed"},
  };
}

std::vector<KeyEntry> keys_of(LastSession& s) {
  return {
      {"window.width", IntegerKey{&s.window_width_px, 1, kMaxWindow_px}, "pixels"},
      {"window.height", IntegerKey{&s.window_height_px, 1, kMaxWindow_px}, "pixels"},
      {"window.panels", SwitchKey{&s.panels}, "map, panels and figures are shown"},
      {"last.planet", TextKey{&s.planet, "the name of a planet file, or nothing", any_text}, "shown last"},
      {"last.pose", PoseKey{&s.pose}, "of the eye"},
      {"last.backend", choice_key(s.backend, {"polygon", "voxel"}), "that drew last"},
  };
}

ExploreFiles explore_files(const base::Environment& environment) {
  const auto in = [&environment](base::UserFolder kind, const char* name) {
    const fs::path folder = base::user_folder(kind, environment);
    return folder.empty() ? fs::path() : folder / name;
  };
  return {in(base::UserFolder::kConfig, kName), in(base::UserFolder::kState, kName),
          in(base::UserFolder::kData, "bookmarks")};
}

Preferences read_preferences(const fs::path& file) { return read<Preferences>(file); }
LastSession read_session(const fs::path& file) { return read<LastSession>(file); }

std::string save(const Preferences& preferences, const fs::path& file) {
  return kept(file, std::string(kPreferencesHead) + text_of(preferences, KeysShown::kChanged));
}

std::string save(const LastSession& session, const fs::path& file) {
  return kept(file, std::string(kSessionHead) + text_of(session, KeysShown::kAll));
}

std::string to_text(const Preferences& preferences) { return text_of(preferences, KeysShown::kAll); }

}  // namespace vpe::explore
