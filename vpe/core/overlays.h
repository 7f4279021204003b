// What is drawn over a picture of ground to read it by (vpe/overlay).
#pragma once

#include <string>

namespace vpe::core {

struct Overlays {
  bool legend = false;
  bool graticule = false;
  double graticule_deg = 0;  // between lines; 0 = as suits the picture
  bool contours = false;
  double contour_m = 0;  // between lines; 0 = as suits the picture
  bool scale_bar = false;
  bool north_arrow = false;
  bool time_code = false;
  std::string title;
  std::string names;  // gazetteer, a CSV file

  bool operator==(const Overlays&) const = default;
};

}  // namespace vpe::core
