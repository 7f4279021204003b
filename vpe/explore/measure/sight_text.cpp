#include "vpe/explore/measure/sight_text.h"

#include <cmath>
#include <utility>

#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

std::string needed_text(const LineOfSight& sight, const SightEnds& ends) {
  if (!std::isfinite(sight.needed_height_m))
    return "no height of " + ends.last + ": it is too far behind the horizon";
  const bool hides_alone = !sight.obstruction->object.empty() && sight.needed_height_m <= ends.last_height_m;
  return ends.last +
         (hides_alone ? " where it is"
                      : " at " + measured_length_text(sight.needed_height_m) + " above ground") +
         (ends.has_objects ? ", without objects" : "");
}

}  // namespace

std::vector<ReadOutLine> sight_lines(const LineOfSight& sight, const SightEnds& ends) {
  std::vector<ReadOutLine> lines;
  const auto add = [&](const char* label, std::string text) { lines.push_back({label, std::move(text)}); };
  add("Straight", measured_length_text(sight.distance_m));
  add("Clearance", measured_length_text(sight.clearance_m) + ", " +
                       measured_length_text(sight.clearance_distance_m) + " from " + ends.first);
  if (!sight.obstruction) return lines;
  const Obstruction& met = *sight.obstruction;
  if (!met.object.empty()) add("Obstructed by", met.object);
  add("Obstructed at", coordinates_text(met.place) + "; " + measured_length_text(met.distance_m) + " from " +
                           ends.first + ", " + base::format_display(met.elevation_m, 1) + " m elevation");
  add("Visible for", needed_text(sight, ends));
  return lines;
}

}  // namespace vpe::explore
