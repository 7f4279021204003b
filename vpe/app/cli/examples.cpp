#include "vpe/app/cli/examples.h"

#include <CLI/CLI.hpp>
#include <sstream>

namespace vpe::app {

namespace {

constexpr std::string_view kLineStart = "    vpe ";

}  // namespace

void add_examples(CLI::App& command, std::initializer_list<Example> examples) {
  std::string text = "Examples:";
  for (const Example& e : examples) text += "\n  " + std::string(e.purpose) + ":\n    " + std::string(e.line);
  command.footer(text);
}

std::vector<std::string> example_lines(const CLI::App& command) {
  std::vector<std::string> lines;
  std::istringstream footer(command.get_footer());
  for (std::string line; std::getline(footer, line);) {
    if (line.starts_with(kLineStart)) lines.push_back(line.substr(line.find("vpe ")));
  }
  return lines;
}

}  // namespace vpe::app
