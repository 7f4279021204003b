// Masks that leave posts of elevation rasters out.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mars/sources/source.h"

namespace vpe::app {

// Holds an option of the form [NAME=]VALUE.
struct NamedValue {
  std::string name;  // empty: not given
  std::string value;
};
NamedValue named_value(const std::string& text);

// Returns the numbers of the sources that a name on the command line means: those with this path, else those whose file
// has this name.
std::vector<std::size_t> named_sources(const std::vector<std::shared_ptr<const mars::ElevationSource>>& sources,
                                       const std::string& name);

// Leaves out posts of elevation sources where a mask, a raster of its own grid, is below one half or has no data. Each
// text is NAME=RASTER; the content of the raster becomes part of the source's treatment. Throws UsageError for a name
// that no source has, and mars::SourceError when a raster cannot be read, when it leaves no post, or when a source has
// no posts of its own.
void apply_masks(const std::vector<std::string>& masks,
                 std::vector<std::shared_ptr<const mars::ElevationSource>>& sources);

}  // namespace vpe::app
