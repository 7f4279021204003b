// The commands of the program, of which some, as `vpe report error-time`, are two words.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace vpe::app {

// All that do something by themselves, in the order in which they were added.
std::vector<CLI::App*> all_commands(CLI::App& program);
std::vector<const CLI::App*> all_commands(const CLI::App& program);

// As it is called, but for the program's own name: "report error-time".
std::string command_words(const CLI::App& command);

}  // namespace vpe::app
