// Words of command lines that are printed to be copied.
#pragma once

#include <string>

namespace vpe::app {

// Returns the word as a POSIX shell reads it back: in single quotes unless all characters are safe.
std::string shell_word(const std::string& word);

}  // namespace vpe::app
