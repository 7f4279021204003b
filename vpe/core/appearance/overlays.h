// Overlays: lines, scales and texts over an image of ground that make it readable (drawn by vpe/overlay).
#pragma once

#include <string>
#include <string_view>

namespace vpe::core {

// Returns "" if this program draws overlays, else the reason why not; then every key overlay.* keeps its
// default.
constexpr std::string_view overlays_refused() {
#ifdef VPE_WITHOUT_CAIRO
  return "this program was built without Cairo, which draws overlays; install libcairo2-dev and build it again";
#else
  return {};
#endif
}

// The place of the marks of azimuth.
enum class CompassStrip {
  kOff,
  kBottom,   // along the lower edge
  kTop,      // along the upper edge
  kHorizon,  // along elevation 0; along the lower edge if the image does not show it
};

// Selects the time that is written into an image.
enum class TimeCode {
  kOff,
  kFlight,  // of the frame in its flight
  kSolar,   // local true solar time and solar longitude at the ground below the camera
};

// Selects how parts of lines are drawn that ground hides.
enum class HiddenLines { kLeftOut, kDashed };

// Selects what an image shows about how it is made.
enum class Inspect {
  kNone,
  kBorders,    // lines along the borders of tiles
  kLevels,     // tiles tinted by their level (vpe/core/appearance/inspect.h)
  kSynthetic,  // synthetic ground tinted; an overlay, while the others are drawn with the tiles
};

// Holds all settings of overlays. The keys are in settings.cpp.
struct Overlays {
  bool legend = false;
  bool graticule = false;
  double graticule_deg = 0;  // between lines; 0: a step that suits the image
  bool contours = false;
  double contour_m = 0;  // between lines; 0: a step that suits the image
  // Largest error of the ground that contours are taken from. Smaller: truer lines, slower; 0: the reference
  // surface itself. An image that is coarser gets ranges of its own for its contours.
  double contour_tolerance_px = 0.1;
  bool scale_bar = false;
  bool north_arrow = false;
  TimeCode time_code = TimeCode::kOff;
  CompassStrip compass = CompassStrip::kOff;
  std::string title;
  std::string names;       // path of a gazetteer, a CSV file (vpe/core/appearance/gazetteer.h)
  bool distances = false;  // from the camera, beside names
  // Paths of vector files with ';' between them, the lowest first; after each path may follow '@' and an opacity.
  std::string layers;
  HiddenLines hidden_lines = HiddenLines::kLeftOut;  // of layers
  bool layers_legend = false;                        // what colours and patterns of layers stand for
  Inspect inspect = Inspect::kNone;

  bool operator==(const Overlays&) const = default;
};

}  // namespace vpe::core
