#include "vpe/app/cli/program.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

#include "vpe/app/cli/command_list.h"
#include "vpe/app/cli/config_file.h"
#include "vpe/app/cli/former_options.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/base/number.h"

#ifndef VPE_VERSION
#define VPE_VERSION "0"
#endif

namespace vpe::app {

namespace {

// Returns the words of a command line last first, as CLI11 wants them.
std::vector<std::string> reversed_arguments(std::vector<std::string> words) {
  for (std::string& word : words) {
    // CLI11 accepts numbers like -5 as values, but takes -.5 for an option.
    if (word.starts_with("-.") && parse_numbers(word)) word.insert(1, "0");
  }
  // CLI11 ends a command at "--". What follows is never an option: numbers are none, and names get a folder.
  if (const auto end = std::ranges::find(words, "--"); end != words.end()) {
    for (auto word = words.erase(end); word != words.end(); ++word) {
      if (word->starts_with('-') && word->size() > 1 && !parse_numbers(*word)) word->insert(0, "./");
    }
  }
  std::reverse(words.begin(), words.end());
  return words;
}

void check_command_name(const CLI::App& program, const std::vector<std::string>& reversed) {
  if (reversed.empty() || reversed.back().starts_with('-')) return;
  std::string names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == reversed.back()) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw UsageError("unknown command '" + reversed.back() + "'; the commands are " + names);
}

// Returns CLI11's words for wrong usage, and the help that says what is right.
std::string usage_text(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  const std::string words = command_words(*command);
  const std::string help = "vpe " + words + (words.empty() ? "" : " ") + "--help";
  return std::string(error.what()) + "; '" + help + "' says what is expected";
}

// Returns the exit code. A full disk shows only when the results leave the buffer.
int flush_results() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return kSuccess;
  // A reader that closed the pipe early, like head(1), needs no message.
  if (errno != EPIPE) std::fprintf(stderr, "vpe: cannot write to standard output: %s\n", std::strerror(errno));
  return kFailure;
}

}  // namespace

CLI::Validator number_within(double low, double high) {
  const std::string range = base::format_number(low) + " .. " + base::format_number(high);
  return {[low, high, range](const std::string& text) {
            const auto number = base::parse_number(text);
            return number && *number >= low && *number <= high
                       ? ""
                       : "'" + text + "' is not a number within " + range;
          },
          range};
}

CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& about, Common& common,
                      bool with_json) {
  CLI::App* command = program.add_subcommand(name, about);
  command->add_option("--memory", common.memory_mb, "Memory for tiles and other data, MB")
      ->check(CLI::Range(64, 1 << 20))
      ->capture_default_str();
  command->add_option("--threads", common.threads, "Number of worker threads; 0 uses all cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag("--quiet,-q", common.quiet, "Print no progress and no summary, only errors");
  add_config_option(*command);
  if (with_json) command->add_flag("--json", common.json, "Print results as JSON on stdout");
  return command;
}

const char* version() { return VPE_VERSION; }

int run_program(int argc, char** argv, std::span<const AddCommand> commands) {
  // In the C locale a number means the same on every machine.
  std::setlocale(LC_ALL, "C");
  std::signal(SIGPIPE, SIG_IGN);
  CLI::App program(
      "vpe explores planets: it builds planet files, answers queries, draws images and panoramas, and flies.",
      "vpe");
  program.set_version_flag("--version", std::string("vpe ") + version());
  program.require_subcommand(1);
  program.footer(
      "Examples:\n"
      "  vpe render --pose -59.2,-13.7,0,90,-5,0 --height 2000 -o view.png\n"
      "  vpe build mola.tif --image viking.tif -o mars.vpe\n"
      "  vpe explore mars.vpe\n\n"
      "'vpe COMMAND --help' explains a command, with examples. Without PLANET, the embedded Mars is used: "
      "MOLA and MDIM at eight posts a degree, with synthetic detail below.");
  Common common;
  common.words.assign(argv + std::min(argc, 1), argv + argc);
  use_current_names(common.words);
  for (const AddCommand add : commands) add(program, common);
  try {
    std::vector<std::string> arguments = reversed_arguments(common.words);
    check_command_name(program, arguments);
    program.parse(std::move(arguments));
    return flush_results();
  } catch (const CLI::Success& e) {
    program.exit(e);  // prints the help or the version
    return flush_results();
  } catch (const CLI::ParseError& e) {
    std::fprintf(stderr, "vpe: %s\n", usage_text(program, e).c_str());
    return kUsage;
  } catch (const UsageError& e) {
    std::fprintf(stderr, "vpe: %s\n", e.what());
    return kUsage;
  } catch (const Interrupted& e) {
    std::fprintf(stderr, "vpe: %s\n", e.what());
    return kSignalBase + e.signal();
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "vpe: out of memory; lower --memory, --size or --threads\n");
    return kFailure;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "vpe: %s\n", e.what());
    return kFailure;
  }
}

}  // namespace vpe::app
