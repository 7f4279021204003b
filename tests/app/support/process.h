// Runs of a program as a subprocess.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/support/sanitized.h"

namespace app_test {

struct Command {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path folder;                    // working directory
  std::map<std::string, std::string> environment;  // in addition to this process's
  std::string input;                               // standard input
  std::string output_to;                           // file for stdout; then Result::out stays empty
  int signal = 0;                                  // sent once when() is true
  std::function<bool()> when;
  std::function<void(const std::string& err)> watch;  // called again and again with what is on stderr so far
  double limit_s = test_support::kIsSanitized ? 1200 : 120;  // time after which it is killed
};

struct Result {
  int exit_code = -1;      // -1 when a signal ended it
  int signal = 0;          // the signal that ended it
  bool signalled = false;  // when() came true while it ran
  std::string out;
  std::string err;
  std::int64_t peak_bytes = 0;
};

Result run(const Command& command);

// Returns the path of a program on PATH, or an empty path.
std::filesystem::path find_program(const std::string& name);

}  // namespace app_test
