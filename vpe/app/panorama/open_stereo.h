// The pixels of a panorama for one eye or two, opened when a view first needs them.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "panorama/image/tiled_image.h"
#include "panorama/metadata/open_panorama.h"
#include "vpe/app/panorama/second_look.h"
#include "vpe/core/image/image.h"
#include "vpe/core/stereo.h"
#include "vpe/core/view.h"
#include "vpe/overlook/overlook_renderer.h"

namespace vpe::app {

struct PanoramaFiles {
  std::string panorama;                        // of both eyes, or of the left one
  std::string right;                           // empty: the right eye has no file of its own
  std::optional<panorama::PairLayout> layout;  // nullopt: that of the sidecar
  // Makes the right eye's views of the left one's and its ranges; nullopt: the right eye has an image.
  std::optional<SecondLookOptions> second = std::nullopt;
};

// Reports the progress of the copy that a large image may need before the first view: a description, and a
// fraction 0..1. May throw to stop it.
using CopyProgress = std::function<void(const std::string& what, double fraction)>;

// Draws views of a panorama, or of a pair of panoramas. Use it from one thread at a time.
//
// Typical usage:
//   StereoPanorama panorama({"rim.png", "", {}}, budget_bytes, 0);
//   const core::RgbImage image = panorama.draw(viewer.view(), std::nullopt);
class StereoPanorama {
 public:
  // Reads descriptions, no pixels. Images take at most budget_bytes of memory together. Smaller: tiles are read
  // again more often. threads: 0 = all cores. Throws as panorama::describe() and SecondLook.
  StereoPanorama(const PanoramaFiles& files, std::size_t budget_bytes, int threads);

  // Draws views by OpenGL from now on, in the context's thread; null: on the CPU.
  void set_context(std::shared_ptr<gl::Context> context);
  // Lets a view by OpenGL read at most so many tiles of texture that it does not have yet.
  void limit_reads(int most_new) { most_new_ = most_new; }
  // Returns false if coarser tiles stood in for some in the last view.
  bool is_complete() const { return is_complete_; }

  // Returns the description of the left eye's panorama.
  const panorama::PanoramaDescription& description() const { return left_.description; }
  bool is_pair() const { return right_ || second_ || left_.description.pair != panorama::PairLayout::kNone; }
  // Returns what makes the right eye's views; null if it has an image.
  const SecondLook* second() const { return second_.get(); }
  // Returns how far from the panorama's place the last view was.
  double moved_m() const { return moved_m_; }
  // Returns EyePair::filled_share of the last view with two eyes, or MovedView::filled_share of one from beside the place.
  double filled_share() const { return filled_share_; }

  // Draws a view whose axes are in the panorama's frame: both eyes in the layout, or without stereo the left
  // one. A camera whose position is not 0 is beside the panorama's place (SecondLook::draw_moved()): without stereo, where the
  // panorama has ranges; else its position changes nothing. Calls `finish` for each eye's image before the two are combined. Throws as
  // panorama::open_tiled_image() and panorama::render_view().
  core::RgbImage draw(const core::View& view, const std::optional<core::StereoLayout>& stereo,
                      const CopyProgress& progress = {},
                      const std::function<void(core::RgbImage&)>& finish = {});

 private:
  struct Panorama {
    panorama::PanoramaDescription description;
    std::unique_ptr<panorama::TiledImage> tiled_image;                     // null until it is needed
    std::array<std::unique_ptr<overlook::OverlookRenderer>, 2> renderers;  // of both eyes, once needed
  };

  core::RgbImage draw_eye(Panorama& panorama, bool is_second, const core::View& view,
                          const CopyProgress& progress);
  void open(Panorama& panorama, const CopyProgress& progress) const;
  SecondLook* head();

  Panorama left_;
  std::unique_ptr<SecondLook> second_;
  std::unique_ptr<SecondLook> head_;  // once a view is from beside the place
  bool has_no_ranges_ = false;        // so that there is no head_
  double moved_m_ = 0;
  double filled_share_ = 0;
  std::optional<Panorama> right_;  // nullopt: the right eye is in the left one's file, or missing
  std::size_t budget_bytes_;       // of each image
  int threads_;
  std::shared_ptr<gl::Context> context_;
  int most_new_ = std::numeric_limits<int>::max();
  bool is_complete_ = true;
};

}  // namespace vpe::app
