#include "vpe/app/cli/config_file.h"

#include <toml++/toml.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>

#include "vpe/app/cli/command_list.h"
#include "vpe/app/cli/former_options.h"
#include "vpe/base/number.h"
#include "vpe/base/toml_table.h"
#include "vpe/base/user_folders.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

class ConfigFile {
 public:
  // `done` holds the options that files before this one have set; apply() adds its own.
  ConfigFile(CLI::App& program, CLI::App& command, std::string path, std::set<std::string>& done)
      : program_(program), command_(command), path_(std::move(path)), done_(done) {}

  void apply() {
    const toml::table config = parse();
    for (const auto& [key, node] : config) {
      if (const toml::table* table = node.as_table()) apply_table(std::string(key.str()), *table);
    }
    for (const auto& [key, node] : config) {
      if (node.is_table()) continue;
      const auto all = all_commands(program_);
      if (std::none_of(all.begin(), all.end(),
                       [name = key.str()](CLI::App* c) { return option(*c, name) != nullptr; })) {
        fail(node, "no command has an option --" + std::string(key.str()));
      }
      if (CLI::Option* found = option(command_, key.str())) set(*found, key.str(), node);
    }
  }

 private:
  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    throw UsageError(path_ + ":" + std::to_string(node.source().begin.line) + ": " + what);
  }

  static CLI::Option* option(CLI::App& command, std::string_view key) {
    if (key == "help" || key == "config") return nullptr;
    return command.get_option_no_throw(std::string(current_option("--" + std::string(key))));
  }

  toml::table parse() const {
    std::ifstream in(path_, std::ios::binary);
    // A folder can be opened, but not read.
    if (!in || (in.peek(), in.bad())) {
      throw UsageError(path_ + ": cannot read the configuration: " + std::strerror(errno) + "; check the name");
    }
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    try {
      return base::parse_toml(text, path_);
    } catch (const std::runtime_error& e) {
      throw UsageError(e.what());
    }
  }

  // `name` holds the command's words, or the first of them.
  void apply_table(const std::string& name, const toml::table& table) {
    const auto all = all_commands(program_);
    const auto at =
        std::find_if(all.begin(), all.end(), [&](CLI::App* c) { return command_words(*c) == name; });
    const bool is_first_word = std::any_of(
        all.begin(), all.end(), [&](CLI::App* c) { return command_words(*c).starts_with(name + " "); });
    if (at == all.end() && !is_first_word) fail(table, "[" + name + "] is not a command");
    for (const auto& [key, node] : table) {
      if (const toml::table* inner = node.as_table(); inner != nullptr && is_first_word) {
        apply_table(name + " " + std::string(key.str()), *inner);
        continue;
      }
      CLI::Option* found = at == all.end() ? nullptr : option(**at, key.str());
      if (found == nullptr) fail(node, "'" + name + "' has no option --" + std::string(key.str()));
      if (*at == &command_) set(*found, key.str(), node);
    }
  }

  std::string text(const toml::node& node, std::string_view key) const {
    if (const auto* value = node.as_string()) return value->get();
    if (const auto* value = node.as_integer()) return std::to_string(value->get());
    if (const auto* value = node.as_floating_point()) return base::format_number(value->get());
    if (const auto* value = node.as_boolean()) return value->get() ? "true" : "false";
    fail(node, std::string(key) + ": expected text, a number, true, false or a list of these");
  }

  static std::string name_of(const CLI::Option& option) { return "--" + option.get_lnames().front(); }

  std::string value(const CLI::Option& option, const toml::node& node, std::string_view key) const {
    return current_value(name_of(option), text(node, key));
  }

  void set(CLI::Option& option, std::string_view key, const toml::node& node) {
    if (option.count() > 0 || !done_.insert(name_of(option)).second) return;
    if (option.get_expected_max() == 0) {
      if (!node.is_boolean()) fail(node, std::string(key) + ": expected true or false");
      if (!node.as_boolean()->get()) return;
      option.add_result(option.get_flag_value(option.get_lnames().front(), ""));
    } else if (const toml::array* list = node.as_array()) {
      for (const toml::node& entry : *list) option.add_result(value(option, entry, key));
    } else {
      option.add_result(value(option, node, key));
    }
    try {
      option.run_callback();
    } catch (const CLI::ParseError& e) {
      fail(node, e.what());
    }
  }

  CLI::App& program_;
  CLI::App& command_;
  std::string path_;
  std::set<std::string>& done_;  // a flag that is set to false leaves no trace in the option
};

void apply_environment(CLI::App& command) {
  for (std::string name : {"memory", "threads"}) {
    CLI::Option* option = command.get_option_no_throw("--" + name);
    if (option == nullptr || option->count() > 0) continue;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    name.insert(0, "VPE_");
    const char* value = std::getenv(name.c_str());
    if (value == nullptr || *value == '\0') continue;
    option->add_result(value);
    try {
      option->run_callback();
    } catch (const CLI::ParseError& e) {
      throw UsageError("environment variable " + name + ": " + e.what());
    }
  }
}

}  // namespace

std::vector<fs::path> config_files() {
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::path& folder : base::config_folders()) {
    if (fs::exists(folder / "config.toml", none)) files.push_back(folder / "config.toml");
  }
  return files;
}

void add_config_option(CLI::App& command) {
  // CLI11 calls this after it has read the whole command line and before it checks for required options. Its
  // own set_config() has no effect on subcommands.
  command
      .add_option_function<std::string>(
          "--config",
          [&command](const std::string& path) {
            if (!command.parsed()) return;
            CLI::App* top = &command;
            while (top->get_parent() != nullptr) top = top->get_parent();
            CLI::App& program = *top;
            apply_environment(command);
            std::set<std::string> done;
            if (!path.empty()) ConfigFile(program, command, path, done).apply();
            for (const fs::path& file : config_files())
              ConfigFile(program, command, file.string(), done).apply();
          },
          "TOML file to read options from")
      ->force_callback();
}

}  // namespace vpe::app
