// Names of image layers of a build, and the matching of the colours of its images.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mars/sources/source.h"

namespace vpe::app {

// Returns the names of the layers of images, one for each: those of --images-apart, with ';' between them, or for
// the images that it does not name, and for "stem", the names of their files without folder and extension. Names of files that
// stand twice get a number. Throws UsageError for names that image.layers could not hold, that stand twice, or that are more
// than the images.
std::vector<std::string> layer_names(const std::vector<std::string>& images, const std::string& images_apart);

// Matches each image to the stack of those below it (mars::fit_colour_match()), the coarsest first, and replaces it in the list.
// Returns sentences for the user about what was found. Throws mars::SourceError on a read error.
std::vector<std::string> match_colours(std::vector<std::shared_ptr<const mars::ImageSource>>& images);

}  // namespace vpe::app
