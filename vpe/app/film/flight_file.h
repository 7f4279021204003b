// A flight from a file.
#pragma once

#include <string>

#include "scripts/flight.h"

namespace vpe::app {

// Throws std::runtime_error that names the file and every bad line.
scripts::Flight read_flight(const std::string& path);

}  // namespace vpe::app
