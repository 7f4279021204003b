// Another program as a subprocess.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vpe::app {

// What it writes to stderr goes to a file that is removed with the object. It has a process group of its own:
// Ctrl-C, which reaches a whole group, passes it by. One thread at a time. The destructor ends its input and
// waits for it.
class Child {
 public:
  // words[0] is looked for on PATH. Its standard input is fed by write(); its standard output goes nowhere, or
  // to the file. Throws std::runtime_error with the system's words.
  Child(std::vector<std::string> words, std::filesystem::path log,
        const std::filesystem::path& output = "/dev/null");
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // False when it reads no more.
  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes);

  // Ends its input and waits; true when it ended well.
  [[nodiscard]] bool finish();

  // What it has said on stderr so far, without the newlines at the end.
  std::string said() const;

 private:
  std::filesystem::path log_;
  int pipe_ = -1;
  pid_t pid_ = -1;
  bool ended_well_ = false;
};

}  // namespace vpe::app
