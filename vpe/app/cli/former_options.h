// Former names of options on the command line and in configuration files (vpe/core/registry/former_names.h).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vpe::app {

// Returns the current name of an option, with the dashes. Any other text comes back unchanged.
std::string_view current_option(std::string_view option);

// Returns the current word for a value of an option that is given by its current name. Any other text comes
// back unchanged.
std::string current_value(std::string_view option, std::string_view value);

// Replaces former names of options and of their values in a command line, in the forms `--option value` and
// `--option=value`. Words after "--" stay as they are.
void use_current_names(std::vector<std::string>& words);

}  // namespace vpe::app
