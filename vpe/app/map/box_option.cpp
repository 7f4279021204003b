#include "vpe/app/map/box_option.h"

#include <cmath>

#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

map::PlaceBox parse_box(const std::string& text) {
  if (text.empty()) return {};
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 4)
    throw UsageError("--box '" + text + "': expected WEST,SOUTH,EAST,NORTH in degrees, as 137,-6,138.5,-4");
  map::PlaceBox box{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
  if (std::abs(box.west_deg) > 360 || std::abs(box.east_deg) > 360)
    throw UsageError("--box '" + text + "': longitudes must lie within -360 to 360");
  if (!(box.south_deg >= -90 && box.south_deg < box.north_deg && box.north_deg <= 90))
    throw UsageError("--box '" + text + "': latitudes must ascend and lie within -90 to 90");
  while (box.east_deg <= box.west_deg) box.east_deg += 360;
  if (box.east_deg - box.west_deg > 360)
    throw UsageError("--box '" + text + "': is more than 360 degrees wide");
  return box;
}

}  // namespace vpe::app
