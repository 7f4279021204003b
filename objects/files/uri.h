// Names of files in glTF.
#pragma once

#include <string>

namespace objects {

// Returns a name of a file with its %20 and the like decoded; data: addresses stay as they are.
std::string decoded_uri(const std::string& uri);

}  // namespace objects
