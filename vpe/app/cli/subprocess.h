// Another program as a subprocess.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vpe::app {

// Runs a program, feeds its standard input, and keeps its output in memory, so that a full disk cannot lose its
// messages. The program has a process group of its own: Ctrl-C, which reaches a whole group, does not reach it.
// The destructor closes its input and waits for its end. One thread at a time.
//
// Typical usage:
//   Subprocess ffmpeg({"ffmpeg", "-i", "-", "out.mp4"});
//   if (!ffmpeg.write(bytes) || !ffmpeg.finish()) report(ffmpeg.stderr_text());
class Subprocess {
 public:
  // Starts words[0], found on PATH, with the other words as arguments, in a folder; an empty path is the current
  // one. `environment` has variables, "NAME=value", beside those of this process. Throws std::runtime_error with
  // the system's message.
  explicit Subprocess(std::vector<std::string> words, const std::filesystem::path& folder = {},
                      std::vector<std::string> environment = {});
  ~Subprocess();
  Subprocess(const Subprocess&) = delete;
  Subprocess& operator=(const Subprocess&) = delete;

  // Writes to the program's standard input. Returns false when the program reads no more.
  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes);

  // Closes the program's input and waits for its end. Returns true when it exited with status 0.
  [[nodiscard]] bool finish();

  // Returns true until the program has ended. Does not wait.
  [[nodiscard]] bool is_running();
  // Sends the program SIGINT, as Ctrl-C does. Does not wait.
  void interrupt();

  // Return what the program has written to standard output and to standard error so far, without the newlines
  // at the end.
  std::string output() const { return text_of(output_); }
  std::string stderr_text() const { return text_of(errors_); }

 private:
  static std::string text_of(int file);
  void take_status(int status);

  int output_ = -1;
  int errors_ = -1;
  int pipe_ = -1;
  pid_t pid_ = -1;
  bool succeeded_ = false;
};

}  // namespace vpe::app
