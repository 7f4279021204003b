// Building a planet file as users see it: progress, what is continued, what to do when it stops.
#pragma once

#include "paging/builder.h"
#include "vpe/app/program.h"

namespace vpe::app {

// paging::build_planet with progress on stderr. SIGINT and SIGTERM end it with Interrupted; then, and on every
// error after the first tile, a line on stderr says that the same command continues.
paging::BuildSummary run_build(paging::BuildOptions options, const mars::ElevationSource& elevation,
                               const mars::ImageSource* image, const Common& common);

}  // namespace vpe::app
