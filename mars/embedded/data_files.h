// Folders of the data that the program carries: the files of mars/data, and names of places.
#pragma once

#include <string>
#include <vector>

namespace mars {

// Names the files that the embedded Mars needs: heights, colours, and the image that the colours' VRT reads.
inline constexpr const char* kEmbeddedFiles[] = {"mola8.tif", "mdim21.vrt", "mdim21.jpg"};

// Names the file of places of Mars (core::read_gazetteer()).
inline constexpr const char* kPlacesFile = "places/mars.csv";

// Returns the folders in which carried data are looked for, in this order: the folder share/vpe beside the program's
// own bin, the folder share in which the program was built, that of the install prefix, and mars/data and scripts of
// the source tree that the program was built from; or $VPE_DATA alone, where that is set.
std::vector<std::string> data_folders();

// Returns the path of a carried file, or an empty string if no folder has it.
std::string find_data_file(const std::string& name);

}  // namespace mars
