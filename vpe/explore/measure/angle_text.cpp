#include "vpe/explore/measure/angle_text.h"

#include <cmath>

#include "vpe/base/number.h"

namespace vpe::explore {

std::string angle_text(double angle_deg, int decimals) { return base::format_display(angle_deg, decimals); }

std::string heading_text(double heading_deg, int decimals) {
  double within_deg = std::fmod(heading_deg, 360.0);
  if (within_deg < 0) within_deg += 360.0;
  const std::string text = base::format_display(within_deg, decimals);
  return text == base::format_display(360.0, decimals) ? base::format_display(0.0, decimals) : text;
}

}  // namespace vpe::explore
