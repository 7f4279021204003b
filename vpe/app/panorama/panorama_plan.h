// The parts of a panorama's image and the size of its file, from a request.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "panorama/panorama_plan.h"
#include "panorama/projection.h"
#include "panorama/stereo_pieces.h"
#include "vpe/app/panorama/panorama_request.h"

namespace vpe::app {

enum class PanoramaFormat : std::uint8_t { kTiff, kPng, kJpeg };

// Computed from a request alone: equal requests have equal plans.
struct PanoramaPlan {
  panorama::PanoramaMap map;         // of one eye
  std::vector<std::string> rounded;  // notes on sizes that differ from the requested ones
  PanoramaFormat format = PanoramaFormat::kTiff;
  panorama::ImageSize size;  // of the file: both eyes side by side or above each other
  bool is_red_cyan = false;  // two eyes in one image
  bool has_gpano = false;    // GPano can describe the map
  std::vector<panorama::Strip> strips;
};

// Plans a panorama. Throws UsageError for a map that cannot be, and std::runtime_error for an output whose
// extension names no known format.
PanoramaPlan plan_panorama(const PanoramaRequest& request);

// The order of the blocks in a strip's file: the report of its pieces; the image, as tiles row by row (TIFF) or
// as bands of rows; the tiles of each auxiliary layer.
struct StripLayout {
  static constexpr std::int64_t kBandRows = 64;

  bool in_tiles = false;  // of the image
  std::int64_t tiles_across = 0;
  std::int64_t tiles_down = 0;
  std::int64_t bands = 0;
  std::size_t layers = 0;

  std::size_t tiles() const { return static_cast<std::size_t>(tiles_across * tiles_down); }
  std::size_t image_blocks() const { return in_tiles ? tiles() : static_cast<std::size_t>(bands); }
  std::size_t blocks() const { return 1 + image_blocks() + layers * tiles(); }
};

// Returns the layout of one strip of the plan, with this many auxiliary layers.
StripLayout layout_of(const PanoramaPlan& plan, const panorama::Strip& strip, std::size_t layers);

// Returns the digest of everything that the strips depend on: equal digests mean equal strips. `draw_request`
// has settings, sun and interest. Throws base::FileError for a file that the settings name.
std::string fingerprint_of(const PanoramaRequest& request, const PanoramaPlan& plan,
                           const core::DrawRequest& draw_request, double radius_m);

}  // namespace vpe::app
