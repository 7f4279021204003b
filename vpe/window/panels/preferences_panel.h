// The window "Preferences": choices of the user that outlive sessions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "vpe/explore/files/preferences.h"
#include "vpe/window/ui/imgui_helpers.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

struct PreferencesActions {
  std::optional<explore::Preferences> changed;
  std::string error;  // why a text is not taken
  bool closes = false;
};

// Draws a row for each key that begins with `prefix`, in the present ImGui window: a field and its meaning. Reports a
// change or an error in `actions`.
void draw_preference_rows(std::string_view prefix, const explore::Preferences& preferences,
                          PreferencesActions& actions, Widgets& widgets);

// Draws a row for each key of the preferences over the view: a field and its meaning. For the window's thread.
PreferencesActions draw_preferences(const ViewArea& area, double scale, const explore::Preferences& preferences,
                                    Widgets& widgets);

}  // namespace vpe::window
