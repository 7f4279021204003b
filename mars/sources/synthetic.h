// Says what of a planet is made up rather than measured.
#pragma once

#include <span>
#include <string>

#include "mars/sources/source.h"

namespace mars {

// Returns a sentence that names the data and what is made up, for notes and metadata; "" where all is data.
std::string synthetic_statement(std::span<const SourceInfo> sources);

}  // namespace mars
