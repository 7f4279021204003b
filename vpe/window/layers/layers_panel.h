// The panel "Layers": vector files and image layers of the planet, and attributes of features that are clicked.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vpe/explore/layers/feature_pick.h"
#include "vpe/explore/layers/layer_rows.h"
#include "vpe/explore/measure/map_layers.h"
#include "vpe/explore/session.h"
#include "vpe/window/layers/layer_loader.h"
#include "vpe/window/marks/ground_view.h"
#include "vpe/window/menu/still_click.h"
#include "vpe/window/ui/display.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// Holds what the window has to do after the panel was drawn or a file was added.
struct LayersActions {
  std::string message;  // empty: nothing new
  bool message_is_error = false;
};

struct LayersPanelLimits {
  static constexpr double kReach_px = 6;  // around the cursor, at scale 1
};

// Holds a feature that was picked, with what keeps it.
struct ShownFeature {
  std::string file;
  std::shared_ptr<const overlay::GroundFeatures> layer;
  std::uint32_t feature = 0;  // index in its layer
};

// Edits the settings overlay.layers and image.layers, and shows features. For the window's thread.
//
// Typical usage, in each iteration:
//   panel.handle(event, xy, session, view);                    // for each event
//   panel.update(session);
//   request.layers = panel.files();                            // with the setting panel.readable_setting()
//   panel.draw(session, names_of_image_layers, widgets);       // inside its tab
class LayersPanel {
 public:
  // Calls `notify` on a reading thread when a file was read.
  LayersPanel(double radius_m, std::function<void()> notify);

  // Follows the session's settings, and takes files that were read. Returns true if images or panels have changed.
  bool update(const explore::Session& session);
  // Returns true if no file is being read.
  bool is_at_rest() const { return loader_.is_idle(); }

  // Draws the panel inside its tab. `image_layers` are the names of those of the planet file, the lowest first.
  void draw(explore::Session& session, std::span<const std::string> image_layers, Widgets& widgets);
  // Returns true if the last frame showed the panel.
  bool is_shown() const;
  // Adds a vector file above the others.
  void add(const std::string& path, explore::Session& session);

  // Takes part in an event of the view: while the panel is shown, a click picks the features there. `xy` is the cursor in the
  // image of `view`, nullopt beside it. The event stays that of the session.
  void handle(const Event& event, std::optional<glm::dvec2> xy, const explore::Session& session,
              const core::View& view);
  // Picks the features at a position of an image.
  void pick(glm::dvec2 xy, const explore::Session& session, const core::View& view);
  // Picks the features at a place of a map, while the panel is shown. Returns false if there is none.
  bool pick_on_map(const explore::MapView& map, mars::LonLat place);
  // Marks the place that was picked over the image of an eye, while the panel is shown.
  void draw_marks(ImDrawList& list, const explore::Session& session, const EyeImage& eye) const;

  // Returns the vector files that were read, for images; the same pointer until they change.
  std::shared_ptr<const overlay::LayersByFile> files() const { return loader_.files(); }
  // Returns the value of overlay.layers without files that are not read yet, or cannot be.
  std::string readable_setting() const;
  // Returns what maps show of them.
  std::vector<explore::MapLayer> map_layers() const;
  // Counts changes of files() and readable_setting().
  std::uint64_t revision() const { return revision_; }

  const explore::FileRows& files_shown() const { return files_; }
  const explore::ImageRows& images_shown() const { return images_; }
  const LayerLoader& loader() const { return loader_; }
  // Returns the features that were picked, the topmost first, and which of them is shown.
  const std::vector<ShownFeature>& picked() const { return picked_; }
  std::size_t picked_index() const { return index_; }
  // Returns what is to be done since the last call.
  LayersActions take_actions() { return std::exchange(actions_, {}); }

 private:
  enum class RowAct { kNone, kUp, kDown, kRemove, kReload, kChanged };

  void report(const std::string& problem);
  void set(explore::Session& session, const char* key, const std::string& text);
  void keep_picked(std::vector<explore::PickedFeature> found, std::span<const ShownFeature> searched,
                   mars::LonLat place);
  std::vector<ShownFeature> searched_layers() const;
  // layers_panel.cpp:
  void draw_files(explore::Session& session, Widgets& widgets);
  RowAct draw_file(explore::Switched<core::LayerFile>& row, bool is_top, bool is_bottom, Widgets& widgets);
  void draw_switches(explore::Session& session, Widgets& widgets);
  // image_layers_part.cpp:
  void draw_images(explore::Session& session, std::span<const std::string> names, Widgets& widgets);
  RowAct draw_image(explore::Switched<core::ImageLayerLook>& row, bool is_top, bool is_bottom,
                    Widgets& widgets);
  // picked_feature.cpp:
  void draw_picked(explore::Session& session, Widgets& widgets);

  LayerLoader loader_;
  explore::FileRows files_;
  explore::ImageRows images_;
  std::string readable_;
  std::uint64_t loaded_ = 0;  // revision of the loader
  std::uint64_t revision_ = 0;
  std::string file_;  // in its field
  StillClick click_;
  std::vector<ShownFeature> picked_;
  std::size_t index_ = 0;
  std::optional<mars::LonLat> picked_place_;
  int shown_frame_ = -2;  // ImGui's number of the frame in which the panel was drawn last
  LayersActions actions_;
};

}  // namespace vpe::window
