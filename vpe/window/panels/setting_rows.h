// Rows of settings: a field for each key of the registry.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vpe/core/appearance/settings.h"
#include "vpe/explore/session.h"
#include "vpe/window/ui/widgets.h"
#include "vpe/window/workers/painter.h"

namespace vpe::window {

// Draws rows of settings in the present ImGui window and applies changes. Settings that differ from their defaults
// are marked, and have a button that resets them. For one frame.
class SettingRows {
 public:
  // `drawn` is the image shown, or null.
  SettingRows(explore::Session& session, const DrawnImage* drawn, Widgets& widgets)
      : session_(session), drawn_(drawn), widgets_(widgets) {}

  // Draws the settings whose keys begin with `prefix` and with none of `without`.
  void group(std::string_view prefix, const std::vector<std::string_view>& without = {});
  // Draws the settings whose keys or meanings contain a text, in any case.
  void matching(std::string_view text);

  // Returns what is wrong with the last setting that could not be changed, or "".
  const std::string& error() const { return error_; }

 private:
  void row(const core::SettingInfo& info);
  double number_shown(const core::SettingInfo& info, const std::string& text) const;

  explore::Session& session_;
  const DrawnImage* drawn_;
  Widgets& widgets_;
  std::string error_;
};

}  // namespace vpe::window
