// A program run as a subprocess.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace app_test {

struct Command {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path folder;                    // to run in; its output is caught in files beside it
  std::map<std::string, std::string> environment;  // on top of ours
  std::string input;                               // standard input
  std::string output_to;                           // a file for stdout instead of catching it
  int signal = 0;                                  // sent once when() is true
  std::function<bool()> when;
  double limit_s = 120;  // then it is killed
};

struct Result {
  int exit_code = -1;      // -1 when a signal ended it
  int signal = 0;          // that ended it
  bool signalled = false;  // when() came true while it ran
  std::string out;
  std::string err;
  std::int64_t peak_bytes = 0;
};

Result run(const Command& command);

// Where a program lies on PATH; empty when it does not.
std::filesystem::path find_program(const std::string& name);

}  // namespace app_test
