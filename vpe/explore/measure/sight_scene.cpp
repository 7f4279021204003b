#include "vpe/explore/measure/sight_scene.h"

namespace vpe::explore {

bool is_same_sight(const SightScene& measured, bool moves, const SightScene& shown) {
  if (measured.file.empty() && shown.file.empty()) return true;
  if (measured.file != shown.file || measured.revision != shown.revision) return false;
  const bool has_tracks = measured.tracks != nullptr;
  if (has_tracks != (shown.tracks != nullptr)) return false;
  if (has_tracks && measured.tracks != shown.tracks && *measured.tracks != *shown.tracks) return false;
  return !moves || measured.time_s == shown.time_s;
}

}  // namespace vpe::explore
