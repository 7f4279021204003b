// The tab "Places": views that the user keeps, and names over the image.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "vpe/explore/files/bookmarks.h"
#include "vpe/explore/session.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

struct PlacesActions {
  std::optional<explore::SavedView> go_to;
  std::string message;
  bool message_is_error = false;
};

// Draws the bookmarks of a file as a list to go to, rename and delete. For the window's thread.
class PlacesPanel {
 public:
  // An empty path: there is no folder for bookmarks.
  explicit PlacesPanel(std::filesystem::path bookmarks) : file_(std::move(bookmarks)) {}

  // Reads the file again at the next draw().
  void reload() { is_read_ = false; }

  // Draws the panel inside its tab.
  PlacesActions draw(const explore::Session& session, Widgets& widgets);

 private:
  void read();
  void save(PlacesActions& actions);
  void draw_row(std::size_t index, PlacesActions& actions, Widgets& widgets);

  std::filesystem::path file_;
  bool is_read_ = false;
  int last_frame_ = -2;                          // ImGui's number of the frame that was drawn last
  std::optional<explore::Bookmarks> bookmarks_;  // nullopt: they cannot be read
  std::string error_;
  std::optional<std::size_t> removed_;  // in this frame
};

}  // namespace vpe::window
