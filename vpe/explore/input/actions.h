// What a pressed key or button asks for, once: one vocabulary for all devices, the help panel and scripts.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vpe::explore {

enum class ActionKind {
  kNorthUp,
  kLookDown,
  kLevel,
  kReset,
  kWholePlanet,
  kViewBack,
  kViewForward,
  kGoToBookmark,
  kSetBookmark,
  kZoomIn,
  kZoomOut,
  kZoomReset,
  kPlayPause,
  kRecord,
  kPlaceWaypoint,
  kMeasure,
  kEnterOverlook,
  kLeave,
  kRecentreHead,
  kMap,
  kHidePanels,
  kFullScreen,
  kScreenshot,
  kHelp,
};

struct Action {
  static constexpr int kMaxBookmark = 9;

  ActionKind kind = ActionKind::kNorthUp;
  int number = 0;  // of the bookmark, 1..kMaxBookmark; 0 for all other kinds

  bool operator==(const Action&) const = default;
};

struct ActionInfo {
  ActionKind kind;
  std::string_view name;     // in scripts; "set-bookmark 3" for a kind that is numbered
  std::string_view meaning;  // in the help panel
  bool is_numbered = false;
  bool repeats = false;  // as long as its key is held
};

// Every kind once, in the order in which people should read them.
std::span<const ActionInfo> actions();
const ActionInfo& info(ActionKind kind);

std::string name(const Action& action);
// Inverse of name(); nothing for anything else.
std::optional<Action> parse_action(std::string_view name);

}  // namespace vpe::explore
