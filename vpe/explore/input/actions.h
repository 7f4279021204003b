// Actions that a key or button triggers once: one vocabulary for all devices, the help panel and scripts.
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
  kOrthographic,
  kNextMode,
  kPreviousMode,
  kCatchCursor,
  kSwipe,
  kSwipeLeft,
  kSwipeRight,
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
  kLettersLarger,
  kLettersSmaller,
  kLettersUsual,
  kScreenshot,
  kSearch,
  kFiles,
  kCopy,
  kHelp,
  kPanelKeys,
};

struct Action {
  static constexpr int kMaxBookmark = 9;

  ActionKind kind = ActionKind::kNorthUp;
  int number = 0;  // of the bookmark, 1..kMaxBookmark; 0 for all other kinds

  bool operator==(const Action&) const = default;
};

struct ActionInfo {
  ActionKind kind;
  std::string_view name;     // in scripts; numbered kinds add their number: "set-bookmark 3"
  std::string_view meaning;  // in the help panel
  bool is_numbered = false;
  bool repeats = false;  // while its key is held
};

// Returns every kind once, in the order of the help panel.
std::span<const ActionInfo> actions();
const ActionInfo& info(ActionKind kind);

// Returns the action's name in scripts.
std::string name(const Action& action);
// Parses a name; returns nullopt for other text.
std::optional<Action> parse_action(std::string_view name);

}  // namespace vpe::explore
