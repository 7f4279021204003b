// Folders of the data that the program carries: the files of mars/data.
#pragma once

#include <string>
#include <vector>

namespace mars {

// Returns the folders in which carried data are looked for, in this order: $VPE_DATA, the folder share/vpe beside the
// program's own bin, that of the install prefix, and mars/data of the source tree that the program was built from.
std::vector<std::string> data_folders();

// Returns the path of a carried file, or an empty string if no folder has it.
std::string find_data_file(const std::string& name);

}  // namespace mars
