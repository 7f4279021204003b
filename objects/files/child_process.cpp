#include "objects/files/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

extern char** environ;

namespace objects {

namespace {

class Descriptor {
 public:
  explicit Descriptor(int file) : file_(file) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return file_; }
  void close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }

 private:
  int file_;
};

pid_t start(std::vector<std::string>& words, int input, int output) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (input >= 0) {
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  } else {
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  // A signal that this thread blocks must end the child all the same.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t child = -1;
  const int error = ::posix_spawn(&child, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) throw std::system_error(error, std::generic_category(), "cannot start " + words[0]);
  return child;
}

// Reads until the end of the stream; true if it has more than `most` bytes.
bool read_all(int stream, std::size_t most, std::vector<std::uint8_t>& bytes) {
  std::size_t size = 0;
  bytes.resize(std::min<std::size_t>(most, 1 << 16));
  for (;;) {
    if (size == bytes.size()) {
      if (size == most) return true;
      bytes.resize(std::min(most, size * 2));
    }
    const ssize_t count = ::read(stream, bytes.data() + size, bytes.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    size += static_cast<std::size_t>(count);
  }
  bytes.resize(size);
  return false;
}

// Ends a child that is not yet waited for, also when memory for its output is short.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  void kill() const { ::kill(id_, SIGKILL); }
  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

 private:
  pid_t id_;
};

// Returns a file in memory that holds the bytes: a child that ends early cannot stop who writes them, as with a pipe.
int memory_file(std::span<const std::uint8_t> bytes) {
  const auto fail = [] { return std::system_error(errno, std::generic_category(), "cannot keep the input"); };
  const int file = ::memfd_create("input", MFD_CLOEXEC);
  if (file < 0) throw fail();
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const std::system_error error = fail();
      ::close(file);
      throw error;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  ::lseek(file, 0, SEEK_SET);
  return file;
}

}  // namespace

ChildOutput run_child(std::vector<std::string> words, std::span<const std::uint8_t> input,
                      std::size_t most_bytes) {
  const Descriptor given(input.empty() ? -1 : memory_file(input));
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  const Descriptor in(ends[0]);
  Descriptor out(ends[1]);
  Child child(start(words, given.get(), out.get()));
  out.close();
  ChildOutput output;
  output.was_too_long = read_all(in.get(), most_bytes, output.bytes);
  if (output.was_too_long) child.kill();
  output.status = child.wait();
  return output;
}

std::string child_program(const char* name, const char* variable) {
  namespace fs = std::filesystem;
  std::error_code none;
  if (const char* chosen = std::getenv(variable); chosen != nullptr && *chosen != '\0')
    return fs::is_regular_file(chosen, none) ? chosen : "";
  std::vector<fs::path> places;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  if (!program.empty()) {
    places.push_back(program.parent_path() / name);
    places.push_back(program.parent_path().parent_path() / "libexec/vpe" / name);
  }
#ifdef VPE_BUILD_FOLDER
  places.push_back(fs::path(VPE_BUILD_FOLDER) / name);
#endif
  for (const fs::path& place : places)
    if (fs::is_regular_file(place, none)) return place.string();
  return {};
}

std::string signal_text(int number) {
  const char* words = ::sigdescr_np(number);  // strsignal() is not safe in threads
  return std::to_string(number) + " (" + (words != nullptr ? words : "unknown") + ")";
}

std::string number_text(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

}  // namespace objects
