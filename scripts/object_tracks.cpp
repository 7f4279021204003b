#include "scripts/object_tracks.h"

#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "mars/geodesy/sphere.h"
#include "vpe/base/number.h"

namespace scripts {

using vpe::core::ObjectTrack;

std::shared_ptr<const std::vector<ObjectTrack>> object_tracks(std::span<const ObjectCommand> lines) {
  constexpr double kOpposite_rad = 1e-6;
  if (lines.empty()) return nullptr;
  std::map<std::string, ObjectTrack> by_name;
  for (const ObjectCommand& line : lines) {
    ObjectTrack& track = by_name[line.name];
    track.name = line.name;
    if (line.is_shown) track.showings.push_back({line.time_s, *line.is_shown});
    if (!line.place) continue;
    if (!track.points.empty()) {
      const vpe::core::ObjectPlace& before = track.points.back().place;
      if (mars::distance_rad({before.lon_deg, before.lat_deg}, {line.place->lon_deg, line.place->lat_deg}) >
          mars::kPi - kOpposite_rad)
        throw std::runtime_error(
            "the object \"" + line.name + "\" is at " + vpe::base::format_number(line.time_s) +
            " s opposite to its place before, so the way between them is not defined: add a "
            "line between the two");
    }
    track.points.push_back({line.time_s, *line.place});
  }
  std::vector<ObjectTrack> tracks;
  tracks.reserve(by_name.size());
  for (auto& [name, track] : by_name) tracks.push_back(std::move(track));
  return std::make_shared<const std::vector<ObjectTrack>>(std::move(tracks));
}

}  // namespace scripts
