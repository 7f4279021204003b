// A panorama's pixels for one eye or two, opened when a view first needs them.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "panorama/image/tiled_image.h"
#include "panorama/metadata/open_panorama.h"
#include "vpe/core/image/image.h"
#include "vpe/core/stereo.h"
#include "vpe/core/view.h"

namespace vpe::app {

struct EyesFiles {
  std::string panorama;                        // of both eyes, or of the left one
  std::string right;                           // empty: there is none of its own
  std::optional<panorama::PairLayout> layout;  // whatever the JSON says
};

// Of the copying that large images may need before the first view, fraction 0..1. May throw to stop it.
using CopyProgress = std::function<void(const std::string& what, double fraction)>;

// One thread at a time.
class OpenEyes {
 public:
  // Reads descriptions, no pixels. Throws as panorama::describe(). threads: 0 = all cores.
  OpenEyes(const EyesFiles& files, std::size_t budget_bytes, int threads);

  // Of the left eye's panorama.
  const panorama::PanoramaDescription& description() const { return left_.description; }
  bool is_pair() const { return right_ || left_.description.pair != panorama::PairLayout::kNone; }

  // A view whose axes are in the panorama's frame; `finish` is called for each eye's image before two are
  // combined. Without stereo the left eye's. Throws as panorama::open_tiled_image() and panorama::look().
  core::RgbImage draw(const core::View& view, const std::optional<core::StereoLayout>& stereo,
                      const CopyProgress& progress = {},
                      const std::function<void(core::RgbImage&)>& finish = {});

 private:
  struct Panorama {
    panorama::PanoramaDescription description;
    std::unique_ptr<panorama::TiledImage> tiled_image;  // null until it is needed
  };

  core::RgbImage look(Panorama& panorama, bool is_second, const core::View& view, const CopyProgress& progress);

  Panorama left_;
  std::optional<Panorama> right_;  // nothing: in the left one's file
  std::size_t budget_bytes_;       // of each image
  int threads_;
};

}  // namespace vpe::app
