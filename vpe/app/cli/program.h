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
  int memory_mb = 1024;
  int threads = 0;  // 0 = all cores
  bool quiet = false;
  bool json = false;
  std::vector<std::string> words;  // the whole command line but for the program's name
};

// Adds a command to the program. Its callback does the work and throws on failure.
using AddCommand = void (*)(CLI::App& program, Common& common);

// Runs one command line of a program with these commands; returns the exit code. Messages go to stderr, results to
// stdout.
int run_program(int argc, char** argv, std::span<const AddCommand> commands);

// Of this program, as in "0.1.0".
const char* version();

// Wrong usage found after parsing: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// For CLI::Option::check(): a finite decimal number within both ends.
CLI::Validator number_within(double low, double high);

// --memory, --threads, --config, --quiet, and --json where a command reports figures.
CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& about, Common& common,
                      bool with_json);

}  // namespace vpe::app
