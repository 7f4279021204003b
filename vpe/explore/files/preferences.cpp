#include "vpe/explore/files/preferences.h"

#include <exception>

#include "vpe/explore/files/key_file.h"
#include "vpe/explore/files/user_files.h"

namespace vpe::explore {

namespace fs = std::filesystem;

namespace {

constexpr const char* kName = "explore.toml";
constexpr int kMaxWindow_px = 16384;

const std::string kPreferencesHead =
    "# Preferences of vpe explore. Lines that begin with # are defaults: take the first # away to change "
    "one.\n\n";
const std::string kSessionHead = "# The last session of vpe explore, written by it. May be deleted.\n\n";

std::string no_problem(const std::string&) { return {}; }

template <class T>
T read(const fs::path& file, const core::KeyRegistry<T>& registry) {
  T values;
  if (file.empty()) return values;
  if (const auto text = read_user_file(file)) read_keys(*text, file.string(), registry, values);
  return values;
}

// Returns what went wrong, or "".
std::string write_file(const fs::path& file, const std::string& text) {
  if (file.empty()) return "nothing is kept, for there is no folder for it; set HOME to an absolute path";
  try {
    write_user_file(file, text);
    return "";
  } catch (const std::exception& e) {
    return e.what();
  }
}

}  // namespace

MouseChoices mouse_choices(const Preferences& preferences) {
  return {preferences.mouse_speed, preferences.invert_wheel, preferences.throws, preferences.tilt_on_arrival};
}

const core::KeyRegistry<Preferences>& preference_keys() {
  using P = Preferences;
  using Pad = PadOptions;
  using Mouse = SpaceMouseOptions;
  using Head = HeadTrackerOptions;
  using Declare = core::KeyMembers<Preferences>;
  static const core::KeyRegistry<Preferences> keys({
      {"mouse.speed", Declare::number<&P::mouse_speed>(0.1, 10), "", "factor on the angles of a drag"},
      {"mouse.invert_wheel", Declare::toggle<&P::invert_wheel>(), "",
       "rolling the wheel forward moves away from the ground"},
      {"mouse.throw", Declare::toggle<&P::throws>(), "",
       "the ground goes on for half a second after a drag that ends in motion"},
      {"mouse.tilt_on_arrival", Declare::toggle<&P::tilt_on_arrival>(), "",
       "the wheel tilts the view when it comes near the ground from straight above"},
      {"move.speed", Declare::number<&P::fly_speed>(0.01, 100), "",
       "factor on the speed of motion, for all devices"},
      {"move.turn_speed", Declare::number<&P::turn_speed>(0.1, 10), "",
       "factor on the speed of turning, for keys, gamepad and space mouse"},
      {"draw.budget_ms", Declare::number<&P::draw_budget_ms>(0, 1000), "",
       "milliseconds that an image may take while the camera moves, held by drawing coarser; 0 = no limit"},
      {"draw.warp",
       Declare::choice<&P::warp>({core::word("grid", Warp::kGrid), core::word("carry", Warp::kCarry),
                                  core::word("polynomial", Warp::kPolynomial), core::word("off", Warp::kOff)}),
       "",
       "while an image is drawn the last one follows the camera: as a grid with the distances of the ground; pixel by pixel; "
       "by one pair of polynomials; or not at all"},
      {"draw.context",
       Declare::choice<&P::context>({core::word("auto", DrawContextChoice::kAuto),
                                     core::word("shared", DrawContextChoice::kShared),
                                     core::word("own", DrawContextChoice::kOwn)}),
       "",
       "images of triangles stay in textures of the window where there is a GPU; always; or never. Takes effect with the next "
       "window"},
      {"ui.scale", Declare::number<&P::ui_scale>(0, 8), "",
       "size of letters and panels; 0 = the scale of the display"},
      {"ui.longitude",
       Declare::choice<&P::longitude>(
           {core::word("180", LongitudeRange::kSigned), core::word("360", LongitudeRange::kPositive)}),
       "", "longitudes of the status line from -180 to 180 or from 0 to 360, east positive"},
      {"gamepad.enabled", Declare::toggle<&P::use_gamepad>(), "", "use a gamepad when one is plugged in"},
      {"gamepad.dead_zone", Declare::number<&P::gamepad, &Pad::dead_zone>(0, Pad::kMaxDeadZone), "",
       "share of a stick's travel that counts as rest"},
      {"gamepad.trigger_dead_zone", Declare::number<&P::gamepad, &Pad::trigger_dead_zone>(0, Pad::kMaxDeadZone),
       "", "share of a trigger's travel that counts as rest"},
      {"gamepad.curve", Declare::number<&P::gamepad, &Pad::curve>(Pad::kMinCurve, Pad::kMaxCurve), "",
       "exponent of the response; larger: finer near rest"},
      {"gamepad.invert_pitch", Declare::toggle<&P::gamepad, &Pad::invert_pitch>(), "",
       "right stick up looks down"},
      {"space_mouse.enabled", Declare::toggle<&P::use_space_mouse>(), "",
       "use a space mouse when spacenavd runs"},
      {"space_mouse.dead_zone", Declare::number<&P::space_mouse, &Mouse::dead_zone>(0, Mouse::kMaxDeadZone), "",
       "share of the cap's travel that counts as rest"},
      {"space_mouse.curve", Declare::number<&P::space_mouse, &Mouse::curve>(Mouse::kMinCurve, Mouse::kMaxCurve),
       "", "exponent of the response; larger: finer near rest"},
      {"space_mouse.holds_ground", Declare::toggle<&P::space_mouse, &Mouse::holds_ground>(), "",
       "the cap moves the ground instead of the camera"},
      {"space_mouse.roll", Declare::toggle<&P::space_mouse, &Mouse::roll>(), "", "the cap may roll the view"},
      {"head_tracker.enabled", Declare::toggle<&P::use_head_tracker>(), "",
       "listen for a head tracker (opentrack, UDP over network)"},
      {"head_tracker.address",
       Declare::text<&P::head_from, &UdpOptions::address>("a numeric address such as 127.0.0.1",
                                                          address_problem),
       "", "address of this machine at which to listen; 0.0.0.0 = all, so that other machines can send"},
      {"head_tracker.port", Declare::integer<&P::head_from, &UdpOptions::port>(1, 65535), "",
       "port at which to listen"},
      {"head_tracker.invert_yaw", Declare::toggle<&P::head, &Head::invert_yaw>(), "", "swaps left and right"},
      {"head_tracker.invert_pitch", Declare::toggle<&P::head, &Head::invert_pitch>(), "", "swaps up and down"},
      {"head_tracker.invert_roll", Declare::toggle<&P::head, &Head::invert_roll>(), "",
       "swaps roll to the left and to the right"},
      {"head_tracker.scale", Declare::number<&P::head, &Head::scale>(Head::kMinScale, Head::kMaxScale), "",
       "factor on all angles"},
      {"head_tracker.smoothing_s", Declare::number<&P::head, &Head::smoothing_s>(0, Head::kMaxSmoothing_s), "",
       "time constant of the smoothing, seconds: 63 % of a step is followed in this time"},
  });
  return keys;
}

const core::KeyRegistry<LastSession>& session_keys() {
  using S = LastSession;
  using Declare = core::KeyMembers<LastSession>;
  static const core::KeyRegistry<LastSession> keys({
      {"window.width", Declare::integer<&S::window_width_px>(1, kMaxWindow_px), "", "pixels"},
      {"window.height", Declare::integer<&S::window_height_px>(1, kMaxWindow_px), "", "pixels"},
      {"window.panels", Declare::toggle<&S::panels>(), "", "map, panels and figures are shown"},
      {"window.side", Declare::number<&S::side_px>(0, kMaxWindow_px), "",
       "width of the side panel; 0 = the usual one"},
      {"window.letters", Declare::number<&S::letters>(0, 8), "",
       "scale of letters and panels chosen in the window; 0 = that of the preferences or the display"},
      {"last.overlays", Declare::text<&S::overlays>("settings, one a line", no_problem), "",
       "what was drawn over images, one setting a line"},
      {"last.recent", Declare::text<&S::recent>("names of files, one a line", no_problem), "",
       "files opened last, one a line"},
      {"last.planet", Declare::text<&S::planet>("the name of a planet file, or nothing", no_problem), "",
       "last planet shown"},
      {"last.pose", Declare::pose<&S::pose>(), "", "last pose of the camera"},
      {"last.backend",
       Declare::choice<&S::drawn_by>(
           {core::word(core::to_string(core::DrawnBy::kAuto), core::DrawnBy::kAuto),
            core::word(core::to_string(core::DrawnBy::kPolygon), core::DrawnBy::kPolygon),
            core::word(core::to_string(core::DrawnBy::kRay), core::DrawnBy::kRay)}),
       "", "what drew last, or auto"},
  });
  return keys;
}

ExploreFiles explore_files(const base::Environment& environment) {
  const auto in = [&environment](base::UserFolder kind, const char* name) {
    const fs::path folder = base::user_folder(kind, environment);
    return folder.empty() ? fs::path() : folder / name;
  };
  return {in(base::UserFolder::kConfig, kName), in(base::UserFolder::kState, kName),
          in(base::UserFolder::kData, "bookmarks")};
}

Preferences read_preferences(const fs::path& file) { return read(file, preference_keys()); }
LastSession read_session(const fs::path& file) { return read(file, session_keys()); }

std::string save(const Preferences& preferences, const fs::path& file) {
  return write_file(file, kPreferencesHead + write_keys(preference_keys(), preferences, KeysShown::kChanged));
}

std::string save(const LastSession& session, const fs::path& file) {
  return write_file(file, kSessionHead + write_keys(session_keys(), session, KeysShown::kAll));
}

std::string to_text(const Preferences& preferences) {
  return write_keys(preference_keys(), preferences, KeysShown::kAll);
}

}  // namespace vpe::explore
