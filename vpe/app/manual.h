// The man page and the bash completion, made from the same declarations as --help.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace vpe::app {

// vpe.1 as roff.
std::string man_page(const CLI::App& program);

// A script that completes commands, options, keys of --set and their choices, and file names.
std::string bash_completion(const CLI::App& program);

}  // namespace vpe::app
