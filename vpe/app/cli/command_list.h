// The program's commands as CLI11 knows them.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace vpe::app {

// Returns the commands that can be run, in the order in which they were added. A command with subcommands, such
// as `report`, is not among them; its subcommands are.
std::vector<CLI::App*> all_commands(CLI::App& program);
std::vector<const CLI::App*> all_commands(const CLI::App& program);

// Returns the words that call the command, without the program's own name: "report error-time".
std::string command_words(const CLI::App& command);

}  // namespace vpe::app
