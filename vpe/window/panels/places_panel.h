// The tab "Places": views that the user keeps, and names over the image.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "vpe/explore/drawing/bookmark_list.h"
#include "vpe/explore/files/bookmarks.h"
#include "vpe/explore/session.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

struct PlacesActions {
  std::optional<explore::SavedView> go_to;
  std::string message;
  bool message_is_error = false;
};

// Draws the bookmarks of the open project and those of a file as lists to go to, rename and delete. For the window's
// thread.
class PlacesPanel {
 public:
  // An empty path: there is no folder for bookmarks.
  explicit PlacesPanel(std::filesystem::path bookmarks) : file_(std::move(bookmarks)) {}

  // Reads the file again at the next draw().
  void reload() { is_read_ = false; }

  // Draws the panel inside its tab. `project` has the bookmarks of the project that is open; null: none is.
  PlacesActions draw(const explore::Session& session, explore::BookmarkList* project, Widgets& widgets);

 private:
  // Describes what was pressed in a row. Two at once are not possible.
  struct RowActions {
    bool goes = false;
    bool removes = false;
    std::optional<std::string> name;  // new
  };

  void read();
  void save(PlacesActions& actions);
  void draw_project(const explore::Session& session, explore::BookmarkList& project, PlacesActions& actions,
                    Widgets& widgets);
  void draw_file(const explore::Session& session, PlacesActions& actions, Widgets& widgets);
  static RowActions draw_row(const explore::Bookmark& bookmark, const std::string& id, Widgets& widgets);

  std::filesystem::path file_;
  bool is_read_ = false;
  int last_frame_ = -2;                          // ImGui's number of the frame that was drawn last
  std::optional<explore::Bookmarks> bookmarks_;  // nullopt: they cannot be read
  std::string error_;
};

}  // namespace vpe::window
