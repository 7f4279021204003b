#include "vpe/app/video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

extern char** environ;

namespace vpe::app {

namespace fs = std::filesystem;

VideoWriter::VideoWriter(fs::path path, int width, int height, const scripts::FrameRate& rate)
    : path_(std::move(path)) {
  if (width % 2 != 0 || height % 2 != 0) {
    throw std::runtime_error(path_.string() + ": a video needs an even width and height, not " +
                             std::to_string(width) + "x" + std::to_string(height));
  }
  part_ = path_.string() + ".part";
  log_ = path_.string() + ".log.part";
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  std::vector<std::string> words{"ffmpeg",
                                 "-y",
                                 "-nostdin",
                                 "-loglevel",
                                 "error",
                                 "-f",
                                 "rawvideo",
                                 "-pix_fmt",
                                 "rgb24",
                                 "-s",
                                 size,
                                 "-framerate",
                                 scripts::to_text(rate),
                                 "-i",
                                 "-",
                                 "-c:v",
                                 "libx264",
                                 "-preset",
                                 "veryfast",
                                 "-crf",
                                 "18",
                                 "-pix_fmt",
                                 "yuv420p",
                                 "-movflags",
                                 "+faststart",
                                 "-f",
                                 "mp4",
                                 part_.string()};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  // Ctrl-C reaches the whole process group; ffmpeg is told to stop by the end of its input instead.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int error = ::posix_spawnp(&pid_, "ffmpeg", &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  ::close(ends[0]);
  pipe_ = ends[1];
  if (error != 0) {
    pid_ = -1;
    ::close(pipe_);
    pipe_ = -1;
    std::error_code ignored;
    fs::remove(log_, ignored);  // made before the program was looked for
    throw std::runtime_error(path_.string() + ": cannot start ffmpeg: " + std::strerror(error) +
                             "; install ffmpeg, or give a folder to get PNG frames");
  }
}

VideoWriter::~VideoWriter() {
  if (pipe_ >= 0) ::close(pipe_);
  if (pid_ > 0) wait();
  std::error_code ignored;
  fs::remove(part_, ignored);
  fs::remove(log_, ignored);
}

int VideoWriter::wait() {
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

void VideoWriter::fail(const std::string& what) {
  if (pipe_ >= 0) ::close(pipe_);
  pipe_ = -1;
  if (pid_ > 0) wait();
  std::ifstream log(log_);
  std::string words((std::istreambuf_iterator<char>(log)), std::istreambuf_iterator<char>());
  while (!words.empty() && words.back() == '\n') words.pop_back();
  throw std::runtime_error(path_.string() + ": " + what + (words.empty() ? "" : ": ffmpeg says: " + words));
}

void VideoWriter::add(const core::Frame& frame) {
  const auto* data = reinterpret_cast<const char*>(frame.colour.data());
  std::size_t left = frame.colour.size() * sizeof(mars::Rgb);
  while (left > 0) {
    const ssize_t written = ::write(pipe_, data, left);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot write the video");
    data += written;
    left -= static_cast<std::size_t>(written);
  }
}

void VideoWriter::close() {
  ::close(pipe_);
  pipe_ = -1;
  const int status = wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail("ffmpeg failed");
  std::error_code error;
  fs::rename(part_, path_, error);
  if (error)
    throw std::runtime_error(path_.string() + ": cannot rename the finished video: " + error.message());
}

}  // namespace vpe::app
