// The ways of objects that the lines of a flight describe.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "scripts/flight.h"
#include "vpe/core/object_track.h"

namespace scripts {

// Returns a track for each name, by ascending names; null if there is no line. Lines must ascend in time. Throws
// std::runtime_error, naming object and time, when two successive places of an object are opposite, so that no great
// circle is defined.
std::shared_ptr<const std::vector<vpe::core::ObjectTrack>> object_tracks(std::span<const ObjectCommand> lines);

}  // namespace scripts
