#include "vpe/app/cli/command_list.h"

#include <CLI/CLI.hpp>

namespace vpe::app {

namespace {

template <class App>
void collect(App& command, std::vector<App*>& all) {
  const auto inner = command.get_subcommands([](const CLI::App*) { return true; });
  if (inner.empty() && command.get_parent() != nullptr) all.push_back(&command);
  for (App* one : inner) collect(*one, all);
}

}  // namespace

std::vector<CLI::App*> all_commands(CLI::App& program) {
  std::vector<CLI::App*> all;
  collect(program, all);
  return all;
}

std::vector<const CLI::App*> all_commands(const CLI::App& program) {
  std::vector<const CLI::App*> all;
  collect(program, all);
  return all;
}

std::string command_words(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  if (parent == nullptr) return {};
  const std::string before = command_words(*parent);
  return before.empty() ? command.get_name() : before + " " + command.get_name();
}

}  // namespace vpe::app
