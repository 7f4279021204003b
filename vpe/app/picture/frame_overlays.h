// Overlays of images and films, with the inputs that vpe/overlay needs from a planet and from files.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "paging/surface/surface.h"
#include "vpe/core/frame.h"
#include "vpe/overlay/layer_files.h"
#include "vpe/overlay/overlay.h"

namespace vpe::app {

// The ranges of a frame, and those that its contours are taken from where they are others.
struct FrameGround {
  std::span<const float> range_m;
  core::Certificate certificate;
  std::optional<core::DrawResult> contours;  // of contour_request()
};

// Draws the overlays of one planet's images. Keeps gazetteers and the heights of their places from image to
// image. One thread at a time.
//
// Typical usage:
//   FrameOverlays overlays(planet);
//   overlays.load(request.settings);  // reports a bad gazetteer before any work
//   core::DrawResult result = renderer->draw(request);
//   FrameGround ground{result.frame.range_m, result.certificate};
//   if (const auto finer = contour_request(request, result)) ... ground.contours = renderer->draw(*finer)
//   overlay::composite(overlays.layer(request, ground, time_s), result.frame.colour);
class FrameOverlays {
 public:
  explicit FrameOverlays(std::shared_ptr<const paging::PlanetFile> planet);

  // Goes over to another version of the planet: heights of places are looked up again.
  void change_planet(std::shared_ptr<const paging::PlanetFile> planet);

  // Reads the gazetteer and the vector files that the settings name, each once. Throws what core::read_gazetteer() and
  // mars::read_features() throw.
  void load(const core::Overlays& overlays);

  // Draws these vector files from now on as they were read elsewhere, and forgets all others.
  void use_layers(overlay::LayersByFile files) { layers_ = std::move(files); }

  // Draws the overlay layer of a frame that was drawn for the request, with its range image when
  // overlay::needs_range(). Returns an empty layer when no overlay is set. Throws what overlay::draw() and
  // paging::Surface throw.
  overlay::Layer layer(const core::DrawRequest& request, const FrameGround& ground, double time_s);

 private:
  void add_layers(const core::Overlays& overlays, overlay::Scene& scene) const;

  struct Names {
    std::vector<core::Place> places;
    std::vector<double> height_m;  // NaN: not looked up yet
  };

  std::shared_ptr<const paging::PlanetFile> planet_;
  paging::Surface surface_;
  bool has_imagery_;
  std::map<std::string, Names> names_;  // by file
  overlay::LayersByFile layers_;
};

}  // namespace vpe::app
