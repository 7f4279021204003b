#include "vpe/explore/input/actions.h"

#include <algorithm>
#include <array>

#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

using K = ActionKind;

constexpr std::array kActions{
    ActionInfo{K::kNorthUp, "north-up", "turn to the north"},
    ActionInfo{K::kLookDown, "look-down", "look straight down at the middle of the view"},
    ActionInfo{K::kLevel, "level", "level the horizon: no roll"},
    ActionInfo{K::kReset, "reset", "north up and straight down"},
    ActionInfo{K::kWholePlanet, "whole-planet", "the whole planet"},
    ActionInfo{K::kViewBack, "view-back", "previous view"},
    ActionInfo{K::kViewForward, "view-forward", "next view"},
    ActionInfo{K::kGoToBookmark, "go-to-bookmark", "go to a bookmark", true},
    ActionInfo{K::kSetBookmark, "set-bookmark", "set a bookmark here", true},
    ActionInfo{K::kZoomIn, "zoom-in", "narrower field of view", false, true},
    ActionInfo{K::kZoomOut, "zoom-out", "wider field of view", false, true},
    ActionInfo{K::kZoomReset, "zoom-reset", "reset the field of view"},
    ActionInfo{K::kOrthographic, "orthographic", "orthographic camera, or perspective"},
    ActionInfo{K::kNextMode, "next-mode", "next mode of motion: orbit, fly, walk"},
    ActionInfo{K::kPreviousMode, "previous-mode", "previous mode of motion"},
    ActionInfo{K::kCatchCursor, "catch-cursor", "fly, walk, drive: look around by moving the mouse"},
    ActionInfo{K::kSwipe, "swipe", "line between the earlier planet and this one (--compare), or none"},
    ActionInfo{K::kSwipeLeft, "swipe-left", "move that line to the left", false, true},
    ActionInfo{K::kSwipeRight, "swipe-right", "move that line to the right", false, true},
    ActionInfo{K::kPlayPause, "play-pause", "play the flight, or pause"},
    ActionInfo{K::kRecord, "record", "start or stop recording a flight"},
    ActionInfo{K::kPlaceWaypoint, "place-waypoint", "place a waypoint here"},
    ActionInfo{K::kMeasure, "measure", "place a point of a measurement under the cursor"},
    ActionInfo{K::kEnterOverlook, "enter-overlook", "enter the panorama of a hotspot within reach"},
    ActionInfo{K::kLeave, "leave", "leave the panorama, or cancel the present action"},
    ActionInfo{K::kRecentreHead, "recentre-head", "head tracker: this is straight ahead"},
    ActionInfo{K::kMap, "map", "show or hide the map"},
    ActionInfo{K::kHidePanels, "hide-panels", "hide or show all panels"},
    ActionInfo{K::kFullScreen, "full-screen", "full screen, or window"},
    ActionInfo{K::kLettersLarger, "letters-larger", "larger letters and panels", false, true},
    ActionInfo{K::kLettersSmaller, "letters-smaller", "smaller letters and panels", false, true},
    ActionInfo{K::kLettersUsual, "letters-usual", "letters and panels of the usual size"},
    ActionInfo{K::kScreenshot, "screenshot", "save an image of the view"},
    ActionInfo{K::kSearch, "search", "search a place by name or coordinates"},
    ActionInfo{K::kFiles, "files", "open a file; make images, films and panoramas"},
    ActionInfo{K::kCopy, "copy", "copy the place under the cursor, and a command"},
    ActionInfo{K::kHelp, "help", "show or hide this help"},
    ActionInfo{K::kPanelKeys, "panel-keys",
               "keys act in the panels (arrows, Space, Enter), then the next; Esc: back"},
};

}  // namespace

std::span<const ActionInfo> actions() { return kActions; }

const ActionInfo& info(ActionKind kind) {
  return *std::find_if(kActions.begin(), kActions.end(),
                       [kind](const ActionInfo& a) { return a.kind == kind; });
}

std::string name(const Action& action) {
  std::string text(info(action.kind).name);
  if (info(action.kind).is_numbered) text += " " + std::to_string(action.number);
  return text;
}

std::optional<Action> parse_action(std::string_view name) {
  for (const ActionInfo& known : kActions) {
    if (!name.starts_with(known.name)) continue;
    const std::string_view rest = name.substr(known.name.size());
    if (!known.is_numbered) {
      if (rest.empty()) return Action{known.kind};
      continue;
    }
    if (!rest.starts_with(' ')) continue;
    const auto number = base::parse_integer(rest.substr(1));
    if (number && *number >= 1 && *number <= Action::kMaxBookmark)
      return Action{known.kind, static_cast<int>(*number)};
  }
  return std::nullopt;
}

}  // namespace vpe::explore
