// Where a planet differs from one of fewer sources.
#pragma once

#include <set>
#include <string>

#include "paging/plan/kept_tiles.h"
#include "vpe/app/planet/build_request.h"

namespace vpe::app {

// Returns where the elevation of `now` may differ from that of `before`, which was opened from the first `before.dems`
// alone: within sources that were added, within what was warped to meet them, and within sources that the added ones
// change: by another alignment, another fade or other outliers. `rejects_outliers` is the option of both.
paging::ChangedIn elevation_changes(const RequestedSources& before, const RequestedSources& now,
                                    bool rejects_outliers);

// Does the same for images.
paging::ChangedIn image_changes(const RequestedSources& before, const RequestedSources& now);

}  // namespace vpe::app
