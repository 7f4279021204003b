// The line for `vpe build` that makes planet files of fetched products.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vpe/app/get/selection.h"

namespace vpe::app {

// Stands for an elevation raster where only images were fetched.
inline constexpr const char* kNoElevation = "ELEVATION";

struct BuildLine {
  std::string body;
  std::string text;
};

// Returns one line for each body, in the order in which the bodies appear. Elevation comes first, images follow
// after --image; the datum is stated for all rasters, or for each one if the products differ. The planet file
// is called like the first product. Paths are quoted as a POSIX shell needs it.
std::vector<BuildLine> build_lines(const std::vector<SelectedProduct>& selected,
                                   const std::filesystem::path& folder);

}  // namespace vpe::app
