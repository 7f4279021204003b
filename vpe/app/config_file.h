// --config: options of a command from a TOML file.
#pragma once

#include "vpe/app/program.h"

namespace vpe::app {

// Adds --config to a command. In the file, `size = "640x360"` at the top stands for --size of every command
// that has it, and in a table [render] for that of `render` alone; a list stands for a repeated option. What
// the command line gives goes first, then the table, then the top. A key that no command has, a table that is
// no command, or a value that the option refuses throws UsageError with file, line and key.
void add_config_option(CLI::App& program, CLI::App& command);

}  // namespace vpe::app
