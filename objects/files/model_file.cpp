#include "objects/files/model_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "objects/files/mesh_stream.h"
#include "vpe/base/file.h"

extern char** environ;

namespace objects {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kOperation = "read the model";
constexpr const char* kProgram = "vpe-model-reader";
constexpr std::string_view kDamagedAdvice = "the file may be damaged; export it again, or try another format";

// Independent of the locale.
std::string text_of(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

struct Output {
  std::vector<std::uint8_t> bytes;
  int status = 0;  // of waitpid
  bool was_too_long = false;
};

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

pid_t start(std::vector<std::string>& words, int output) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  // A signal that this thread blocks must end the reader all the same.
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

Output run(std::vector<std::string> words, std::size_t most_bytes) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  const Descriptor in(ends[0]);
  Descriptor out(ends[1]);
  Child child(start(words, out.get()));
  out.close();
  Output output;
  output.was_too_long = read_all(in.get(), most_bytes, output.bytes);
  if (output.was_too_long) child.kill();
  output.status = child.wait();
  return output;
}

std::string signal_name(int number) {
  const char* words = ::sigdescr_np(number);  // strsignal() is not safe in threads
  return std::to_string(number) + " (" + (words != nullptr ? words : "unknown") + ")";
}

void check_options(const ModelFileOptions& options) {
  if (!(options.unit_m > 0 && options.unit_m <= MeshLimits::kMostExtent_m))
    throw std::invalid_argument("the unit of a model must be above 0 and at most 1e9 m");
  if (!(options.memory_gb >= 0.25 && options.memory_gb <= 1024))
    throw std::invalid_argument("the memory of the reader of models must be 0.25 to 1024 GB");
  if (!(options.time_s >= 1 && options.time_s <= 1e6))
    throw std::invalid_argument("the time of the reader of models must be 1 to 1e6 s");
}

}  // namespace

bool is_model_path(const fs::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".gltf" || extension == ".glb" || extension == ".obj" || extension == ".ply" ||
         extension == ".stl";
}

std::string model_reader_program() {
  if (const char* chosen = std::getenv("VPE_MODEL_READER"); chosen != nullptr && *chosen != '\0') {
    std::error_code none;
    return fs::is_regular_file(chosen, none) ? chosen : "";
  }
  std::vector<fs::path> places;
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  if (!program.empty()) {
    places.push_back(program.parent_path() / kProgram);
    places.push_back(program.parent_path().parent_path() / "libexec/vpe" / kProgram);
  }
#ifdef VPE_BUILD_READER
  places.emplace_back(VPE_BUILD_READER);
#endif
  for (const fs::path& place : places)
    if (fs::is_regular_file(place, none)) return place.string();
  return {};
}

std::vector<std::uint8_t> output_of_model_reader(const fs::path& path, const ModelFileOptions& options) {
  check_options(options);
  const auto fail = [&](std::string_view reason, std::string_view advice) {
    return vpe::base::file_error(kOperation, path, reason, advice);
  };
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (!fs::exists(status))
    throw fail(failure ? failure.message() : "there is no such file", "check the name and the permissions");
  if (!fs::is_regular_file(status))
    throw fail(fs::is_directory(status) ? "it is a folder" : "it is a device or pipe",
               "give the name of a file");
  const std::string program = model_reader_program();
  if (program.empty()) {
    const char* chosen = std::getenv("VPE_MODEL_READER");
    if (chosen != nullptr && *chosen != '\0')
      throw fail("$VPE_MODEL_READER names the program '" + std::string(chosen) + "', which does not exist",
                 "correct or unset the variable");
    throw fail("this program was built without assimp, so vpe-model-reader is missing",
               "install libassimp-dev and build it again, or set VPE_MODEL_READER");
  }

  Output output;
  const char* up = options.up == UpAxis::kAuto ? "auto" : options.up == UpAxis::kY ? "y" : "z";
  try {
    // An absolute path cannot be taken for an option.
    output = run({program, fs::absolute(path).string(), text_of(options.unit_m), up, text_of(options.memory_gb),
                  text_of(std::floor(options.time_s))},
                 static_cast<std::size_t>(options.memory_gb * 1e9));
  } catch (const std::system_error& error) {
    throw fail(error.what(), "check the permissions of the program and the limits of processes");
  }
  if (output.was_too_long)
    throw fail("it takes more than " + text_of(options.memory_gb) + " GB",
               "allow more memory or simplify the model");
  if (WIFSIGNALED(output.status)) {
    const int number = WTERMSIG(output.status);
    if (number == SIGXCPU)
      throw fail("the reader of models took more than " + text_of(options.time_s) + " s of processor time",
                 "the file may be damaged, or simplify the model");
    if (number == SIGALRM)
      throw fail("the reader of models waited too long for the disk",
                 "copy the model to a disk of this computer");
    throw fail("the reader of models ended by signal " + signal_name(number), kDamagedAdvice);
  }
  if (output.bytes.empty())
    throw fail("the reader of models ended with status " + std::to_string(WEXITSTATUS(output.status)) +
                   " and without a model",
               kDamagedAdvice);
  return std::move(output.bytes);
}

ModelFile read_model_file(const fs::path& path, const ModelFileOptions& options) {
  const auto fail = [&](std::string_view reason, std::string_view advice) {
    return vpe::base::file_error(kOperation, path, reason, advice);
  };
  std::error_code none;
  if (fs::is_regular_file(path, none) && !is_model_path(path))
    throw fail("its extension is not .gltf, .glb, .obj, .ply or .stl",
               "export the model in one of these formats");
  const std::vector<std::uint8_t> bytes = output_of_model_reader(path, options);
  MeshStream stream;
  try {
    stream = read_mesh_stream(bytes);
  } catch (const std::runtime_error& error) {
    throw fail(error.what(), kDamagedAdvice);
  }
  if (!stream.error.empty()) throw fail(stream.error, stream.advice);
  return {std::move(stream.mesh), std::move(stream.notes)};
}

}  // namespace objects
