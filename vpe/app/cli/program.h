// The command line program: vpe COMMAND [options].
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

// CLI11's header takes seconds to compile: only sources that declare options include it.
namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace vpe::app {

enum ExitCode : int { kSuccess = 0, kFailure = 1, kUsage = 2, kSignalBase = 128 };

// Options of every command.
struct Common {
  int memory_mb =
      1024;         // for data. Smaller: more tiles are read again; larger: less is left for other programs
  int threads = 0;  // 0 = all cores
  bool quiet = false;
  bool json = false;
  std::vector<std::string> words;  // the command line without the program's name, with current names
};

// Adds a command to the program. Its callback does the work and throws on failure.
//
// Typical usage:
//   void add_example(CLI::App& program, Common& common) {
//     auto arguments = std::make_shared<ExampleArguments>();
//     CLI::App* command = add_command(program, "example", "Do something", common, /*with_json=*/false);
//     command->add_option("-o,--output", arguments->output, "File to write")->required();
//     command->callback([arguments, &common] { run_example(*arguments, common); });
//   }
using AddCommand = void (*)(CLI::App& program, Common& common);

// Runs one command line of a program with these commands and returns the exit code. Prints messages on stderr
// and results on stdout. Accepts former names of options (former_options.h).
int run_program(int argc, char** argv, std::span<const AddCommand> commands);

// Returns the program's version, such as "0.1.0".
const char* version();

// Reports wrong usage found after parsing: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Returns a check for CLI::Option::check(): a finite decimal number from `low` to `high`, both included.
CLI::Validator number_within(double low, double high);

// Adds a command with --memory, --threads, --config and --quiet, and with --json where it reports figures.
CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& about, Common& common,
                      bool with_json);

}  // namespace vpe::app
