// Changes of ground that are made of others.
//
// Typical usage:
//   const auto half = partial_change(relief_change(reliefs), 0.5);
//   const auto all = changes_in_order({mixed_ground(strip, 1), half});
#pragma once

#include <memory>
#include <vector>

#include "paging/live/ground_change.h"

namespace paging {

// Returns a change that makes a share of another: h + share * (changed - h). A share of 1 is the other to the bit, 0
// changes nothing. Where the other gives ground to nodata, it does so from a share of 1/2 on. Throws
// std::invalid_argument for a share that is not 0 to 1, and for no change.
std::shared_ptr<const GroundChange> partial_change(std::shared_ptr<const GroundChange> change, double share);

// Returns the change that makes all of these, each to the ground that those before it leave. Its infos() are theirs, one
// after the other. Throws std::invalid_argument for a null pointer.
std::shared_ptr<const GroundChange> changes_in_order(std::vector<std::shared_ptr<const GroundChange>> changes);

}  // namespace paging
