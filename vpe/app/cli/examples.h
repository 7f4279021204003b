// Examples of command lines at the end of `vpe COMMAND --help`, and in the manual page.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace vpe::app {

// A command line that can be typed, and what it does.
struct Example {
  std::string_view purpose;  // begins with a small letter, without a full stop
  std::string_view line;     // begins with "vpe COMMAND"
};

// Makes the examples the end of the command's help.
//
// Typical usage:
//   add_examples(*command, {{"the whole file", "vpe info mars.vpe"}, {"as JSON", "vpe info mars.vpe --json"}});
void add_examples(CLI::App& command, std::initializer_list<Example> examples);

// Returns the examples of a command, without purposes: one line each.
std::vector<std::string> example_lines(const CLI::App& command);

}  // namespace vpe::app
