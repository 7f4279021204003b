// The man page and the bash completion, made from the same declarations as --help.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace vpe::app {

struct Common;

// Returns the manual page vpe.1 as roff.
std::string man_page(const CLI::App& program);

// Returns a bash script that completes commands, options, keys of --set and their choices, and file names.
std::string bash_completion(const CLI::App& program);

// Adds the commands `man` and `completion`.
void add_manual(CLI::App& program, Common& common);

}  // namespace vpe::app
