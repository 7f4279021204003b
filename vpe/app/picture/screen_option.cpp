#include "vpe/app/picture/screen_option.h"

#include <algorithm>

#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/explore/screens/lens_table.h"
#include "vpe/explore/screens/screen_view.h"
#include "vpe/explore/screens/screens_file.h"

namespace vpe::app {
namespace {

explore::HeadPlace parse_head(const std::string& text) {
  if (text.empty()) return {};
  const auto numbers = parse_numbers(text);
  if (!numbers || (numbers->size() != 3 && numbers->size() != 6)) {
    throw UsageError("--head '" + text +
                     "': expected X,Y,Z in metres from where it rests, as 0.1,0,-0.2, or X,Y,Z,YAW,PITCH,ROLL");
  }
  explore::HeadPlace head;
  for (int i = 0; i < 3; ++i) {
    head.position_m[i] = (*numbers)[static_cast<std::size_t>(i)];
    if (!(std::abs(head.position_m[i]) <= explore::ScreenLimits::kMostCoordinate_m))
      throw UsageError("--head '" + text + "': a head stays within 1000 m of the room's origin");
  }
  if (numbers->size() == 6) head.look = {(*numbers)[3], (*numbers)[4], (*numbers)[5]};
  return head;
}

// Returns the screen of that name; without a name the only one.
explore::ScreenSet::Entry entry_of(const explore::ScreenSet& set, const ScreenArguments& arguments) {
  std::string names;
  for (const auto& entry : set.screens) {
    if (entry.screen.name == arguments.name) return entry;
    names += (names.empty() ? "" : ", ") + ("'" + entry.screen.name + "'");
  }
  if (!arguments.name.empty())
    throw UsageError("--screen '" + arguments.name + "': " + arguments.file + " has " + names);
  if (set.screens.size() > 1)
    throw UsageError(arguments.file + " has several screens; choose one with --screen: " + names);
  return set.screens.front();
}

int side_for(const std::string& eye, const explore::PlacedScreen& screen) {
  if (eye.empty()) return explore::side_of(screen.eye);
  return eye == "left" ? -1 : eye == "right" ? 1 : 0;
}

}  // namespace

void add_screen_options(CLI::App& command, ScreenArguments& arguments) {
  command.add_option(
      "--screens", arguments.file,
      "File of screens, *.screens.toml: draw what one of them shows; in place of --size and --fov. The "
      "camera is where the head rests");
  command.add_option("--screen", arguments.name, "Name of the screen, if the file has several");
  command.add_option(
      "--head", arguments.head,
      "X,Y,Z of the head in the room from where it rests, metres (right, up, backwards); then YAW,PITCH,ROLL");
  command
      .add_option("--screen-eye", arguments.eye, "Eye that the screen is drawn for (default: as the file says)")
      ->check(CLI::IsMember({"left", "middle", "right"}));
}

std::optional<ChosenScreen> choose_screen(const ScreenArguments& arguments) {
  if (arguments.file.empty()) {
    if (!arguments.name.empty() || !arguments.head.empty() || !arguments.eye.empty())
      throw UsageError("--screen, --head and --screen-eye are for --screens FILE");
    return std::nullopt;
  }
  ChosenScreen chosen;
  chosen.set = explore::read_screens_file(arguments.file);
  chosen.set.screens = {entry_of(chosen.set, arguments)};
  chosen.head = parse_head(arguments.head);
  chosen.side = side_for(arguments.eye, chosen.screen());
  return chosen;
}

core::View screen_view_of(const ChosenScreen& chosen, const mars::Pose& pose, double radius_m) {
  const mars::CameraPose platform = explore::screen_platform(pose, chosen.set.is_level, radius_m);
  const auto view =
      explore::screen_view(chosen.screen(), chosen.head, platform, explore::room_of(chosen.set), chosen.side);
  if (!view) {
    throw UsageError(
        "screen '" + chosen.screen().name +
        "' shows nothing for a head there: it is behind the screen, in its plane, or too far beside it");
  }
  return *view;
}

core::RgbImage image_of_screen(const ChosenScreen& chosen, core::RgbImage drawn) {
  const explore::ScreenLens* lens = chosen.lens();
  if (lens == nullptr) return drawn;
  return explore::through_lens(
      drawn, explore::LensTable(*lens, chosen.screen().width_px, chosen.screen().height_px, chosen.side));
}

}  // namespace vpe::app
