// Another program as a subprocess.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vpe::app {

// What it says is kept in memory, so that a full disk does not take its words away. It has a process group of
// its own: Ctrl-C, which reaches a whole group, passes it by. One thread at a time. The destructor ends its
// input and waits for it.
class Subprocess {
 public:
  // words[0] is looked for on PATH. Its standard input is fed by write(). Throws std::runtime_error with the
  // system's words.
  explicit Subprocess(std::vector<std::string> words);
  ~Subprocess();
  Subprocess(const Subprocess&) = delete;
  Subprocess& operator=(const Subprocess&) = delete;

  // False when it reads no more.
  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes);

  // Ends its input and waits; true when it ended well.
  [[nodiscard]] bool finish();

  // What it has written to standard output and to standard error so far, without the newlines at the end.
  std::string output() const { return text_of(output_); }
  std::string stderr_text() const { return text_of(errors_); }

 private:
  static std::string text_of(int file);

  int output_ = -1;
  int errors_ = -1;
  int pipe_ = -1;
  pid_t pid_ = -1;
  bool ended_well_ = false;
};

}  // namespace vpe::app
