// Overlays of images and films: what vpe/overlay needs of a planet and of files.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "paging/surface/surface.h"
#include "vpe/core/frame.h"
#include "vpe/overlay/overlay.h"

namespace vpe::app {

// One thread at a time.
class FrameOverlays {
 public:
  explicit FrameOverlays(std::shared_ptr<const paging::PlanetFile> planet);

  // Reads the names that the settings ask for, once. Throws what core::read_gazetteer() throws.
  void load(const core::Overlays& overlays);

  // Of a frame that was drawn for the request, with its range image when overlay::needs_range(). Throws what
  // overlay::draw() and paging::Surface throw.
  overlay::Layer layer(const core::DrawRequest& request, const core::Frame& frame,
                       const core::Certificate& certificate, double time_s);

 private:
  struct Names {
    std::vector<core::Place> places;
    std::vector<double> height_m;  // NaN: not looked up yet
  };

  std::shared_ptr<const paging::PlanetFile> planet_;
  paging::Surface surface_;
  bool has_imagery_;
  std::map<std::string, Names> names_;  // by file
};

}  // namespace vpe::app
