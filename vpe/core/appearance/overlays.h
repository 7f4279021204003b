// What is drawn over an image of ground to read it by (vpe/overlay).
#pragma once

#include <string>
#include <string_view>

namespace vpe::core {

// Why this program draws no overlay, and every key overlay.* keeps its default; empty when it does.
constexpr std::string_view overlays_refused() {
#ifdef VPE_WITHOUT_CAIRO
  return "this program was built without Cairo, which draws overlays; install libcairo2-dev and build it again";
#else
  return {};
#endif
}

// Where azimuths are marked.
enum class CompassStrip {
  kOff,
  kBottom,   // along the lower edge
  kTop,      // along the upper edge
  kHorizon,  // along elevation 0; along the lower edge where the image does not show it
};

struct Overlays {
  bool legend = false;
  bool graticule = false;
  double graticule_deg = 0;  // between lines; 0 = as suits the image
  bool contours = false;
  double contour_m = 0;  // between lines; 0 = as suits the image
  bool scale_bar = false;
  bool north_arrow = false;
  bool time_code = false;
  CompassStrip compass = CompassStrip::kOff;
  std::string title;
  std::string names;       // gazetteer, a CSV file (vpe/core/appearance/gazetteer.h)
  bool distances = false;  // from the camera, beside names

  bool operator==(const Overlays&) const = default;
};

}  // namespace vpe::core
