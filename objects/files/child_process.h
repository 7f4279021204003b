// Programs of this project that run in processes of their own, so that a fault there ends only them.
//
// Typical usage:
//   const ChildOutput output = run_child({program, "file.glb"}, {}, 1 << 30);
//   if (WIFSIGNALED(output.status)) complain(signal_text(WTERMSIG(output.status)));
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace objects {

struct ChildOutput {
  std::vector<std::uint8_t> bytes;  // of its standard output
  int status = 0;                   // of waitpid()
  bool was_too_long = false;        // the child was ended because it wrote more than it may
};

// Runs words[0] with the other words as arguments, `input` as its standard input and no standard error. Waits for its
// end. Any thread may call it. Throws std::system_error if the program cannot be started.
ChildOutput run_child(std::vector<std::string> words, std::span<const std::uint8_t> input,
                      std::size_t most_bytes);

// Returns the path of a program of this project: $VARIABLE alone where that is set, else the first that exists of: beside
// this program, in libexec/vpe beside the program's bin, in the folder in which this program was built. Returns an empty
// string if there is none.
std::string child_program(const char* name, const char* variable);

// Returns a signal's number and name.
std::string signal_text(int number);

// Returns digits that read back as the value, whatever the locale.
std::string number_text(double value);

}  // namespace objects
