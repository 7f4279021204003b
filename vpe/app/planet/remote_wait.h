// Messages about servers that keep the program waiting.
#pragma once

#include <string>

namespace vpe::app {

// Time after which a read of a remote raster is told on stderr; then again at twice the time, and so on.
inline constexpr double kToldWait_s = 10;

// Tells, from now on, reads of remote rasters that take long, unless quiet, and ends the process with the exit code
// of a signal that has come if such a read does not end within a second. Unfinished files stay as a kill would
// leave them, and the same command continues them.
void watch_remote_reads(bool quiet);

// Throws std::runtime_error with the advice to fetch it if a planet file's name is an address.
void require_local_planet(const std::string& name);

}  // namespace vpe::app
