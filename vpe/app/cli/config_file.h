// Options of a command from the environment and from TOML files.
#pragma once

#include <filesystem>
#include <vector>

#include "vpe/app/cli/program.h"

namespace vpe::app {

// Adds --config to a command, and with it all that may give its options where the command line is silent. In
// their order, first come first served: the environment (VPE_MEMORY, VPE_THREADS), the file of --config, the
// user's file, the system's files (config_files()), the default.
//
// In a file, `size = "640x360"` at the top stands for --size of every command that has it, and in a table
// [render] for that of `render` alone, in [report.scaling] for that of `report scaling`; the table goes before the top; a list stands for a repeated option. A
// key that no command has, a table that is no command, or a value that the option refuses throws UsageError
// with file, line and key.
void add_config_option(CLI::App& command);

// Those that exist of $XDG_CONFIG_HOME/vpe/config.toml (~/.config when not set), the user's, and, after it,
// vpe/config.toml in each of $XDG_CONFIG_DIRS (/etc/xdg). A value that is relative or empty counts as not set.
std::vector<std::filesystem::path> config_files();

}  // namespace vpe::app
