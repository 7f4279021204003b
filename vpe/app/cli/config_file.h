// Options of a command from the environment and from TOML files.
#pragma once

#include <filesystem>
#include <vector>

#include "vpe/app/cli/program.h"

namespace vpe::app {

// Adds --config to a command. An option that the command line does not give is taken from the first of these
// that has it: the environment (VPE_MEMORY, VPE_THREADS), the file of --config, the user's file, the system's
// files (config_files()), the default.
//
// In a file, `size = "640x360"` at the top sets --size for every command that has it. In a table [render] it
// sets --size for `render` alone, in [report.scaling] for `report scaling`; a table wins over the top. A list
// stands for a repeated option. Former names of options and values are accepted (former_options.h).
//
// Throws UsageError with file, line and key for a key that no command has, for a table that is not a command,
// and for a value that the option refuses.
void add_config_option(CLI::App& command);

// Returns the existing configuration files, the user's before the system's: $XDG_CONFIG_HOME/vpe/config.toml
// (~/.config when the variable is not set), then vpe/config.toml in each of $XDG_CONFIG_DIRS (/etc/xdg). A
// variable whose value is relative or empty counts as not set.
std::vector<std::filesystem::path> config_files();

}  // namespace vpe::app
