// The window "File": what is opened, and what is made of the session: images, films, panoramas.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vpe/explore/session.h"
#include "vpe/window/ui/imgui_helpers.h"
#include "vpe/window/ui/widgets.h"
#include "vpe/window/workers/job.h"

namespace vpe::window {

// A size of images in pixels; 0 x 0 is that of the view, or of the flight.
struct MadeSize {
  int width_px = 0;
  int height_px = 0;
  const char* name = "";
};
inline constexpr std::array<MadeSize, 4> kImageSizes{{{0, 0, "as the view"},
                                                      {1920, 1080, "1920 x 1080"},
                                                      {3840, 2160, "3840 x 2160"},
                                                      {7680, 4320, "7680 x 4320"}}};
inline constexpr std::array<MadeSize, 3> kFilmSizes{
    {{1280, 720, "1280 x 720"}, {1920, 1080, "1920 x 1080"}, {3840, 2160, "3840 x 2160"}}};
inline constexpr std::array<MadeSize, 3> kPanoramaSizes{
    {{4096, 0, "4096 columns"}, {8192, 0, "8192 columns"}, {16384, 0, "16384 columns"}}};

// Describes what is to be made, with a size of the lists above.
enum class MadeKind { kImage, kFilm, kPanorama };
struct MakeRequest {
  MadeKind kind = MadeKind::kImage;
  MadeSize size;
  bool has_overlays = true;
};

struct FileActions {
  std::optional<std::string> open;              // file of any kind
  std::optional<std::filesystem::path> planet;  // of the list; an empty path is the embedded Mars
  std::optional<MakeRequest> make;
  std::optional<std::filesystem::path> look_around;  // panorama to open in a window of its own
  bool stops_planet = false;                         // the planet that is being built
  bool opens_preferences = false;
  bool closes = false;
};

// Names what is being made.
struct FileWork {
  JobList& jobs;
  std::optional<double> planet;  // share that is done of the planet that replaces the one shown
};

// Draws the window over the view. For the window's thread.
class FilePanel {
 public:
  // `recent`: the files opened last, the newest first. `folder`: where planet files are looked for, beside the folders of
  // those in `recent`; may be empty.
  FilePanel(std::vector<std::string> recent, std::filesystem::path folder)
      : recent_(std::move(recent)), folder_(std::move(folder)) {}

  static constexpr std::size_t kMostRecent = 8;

  // Puts a file at the head of the list.
  void add_recent(const std::string& file);
  const std::vector<std::string>& recent() const { return recent_; }
  // Gives the field of names the keyboard in the next frame, and looks for planet files.
  void focus();
  // Keeps a name that could not be opened in its field.
  void refuse(const std::string& name) { refused_ = name; }

  FileActions draw(const ViewArea& area, double scale, const explore::Session& session, FileWork work,
                   Widgets& widgets);

 private:
  void draw_open(FileActions& actions, Widgets& widgets);
  void draw_planets(FileActions& actions, Widgets& widgets);
  void draw_make(const explore::Session& session, bool can_make, FileActions& actions, Widgets& widgets);
  static void draw_work(FileWork work, FileActions& actions, Widgets& widgets);

  std::vector<std::string> recent_;
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> planets_;  // found by focus()
  std::string name_;
  std::optional<std::string> refused_;
  bool takes_focus_ = false;
  int image_size_ = 0;
  int film_size_ = 0;
  int panorama_size_ = 0;
  bool has_overlays_ = true;
};

}  // namespace vpe::window
