// Tells the content of sources apart, wherever copies of their files lie.
#pragma once

#include <string>

#include "mars/sources/source.h"

namespace paging {

// Returns a hash of the sizes of a source's local files and of blocks spread evenly over each, or an empty text for
// a source without such files. Copies have the same hash, whatever their folder and time. A change of a few bytes
// between the blocks does not show.
std::string content_of(const mars::SourceInfo& source);

}  // namespace paging
