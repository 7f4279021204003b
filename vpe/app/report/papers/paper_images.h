// Images of the report of the papers.
#pragma once

#include <filesystem>
#include <string>

#include "vpe/core/image/image.h"
#include "vpe/report/page.h"

namespace vpe::app {

// Writes an image as folder/name and returns it for the page. Throws core::FileError.
report::PageImage write_paper_image(const std::filesystem::path& folder, const std::string& name,
                                    const std::string& caption, const core::RgbImage& image);

// Returns the difference of two images of one size, times 8.
core::RgbImage eightfold_difference(const core::RgbImage& a, const core::RgbImage& b);

}  // namespace vpe::app
