#include "vpe/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>
#include <system_error>
#include <utility>

#include "vpe/base/temporary.h"

namespace vpe::base {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kDiskAdvice = "check the free space and the permissions there";

std::string system_message(int error) { return std::generic_category().message(error); }

FileStamp stamp_of(const struct stat& file) {
  return {static_cast<std::uint64_t>(file.st_dev), static_cast<std::uint64_t>(file.st_ino),
          static_cast<std::int64_t>(file.st_size),
          std::int64_t{file.st_mtim.tv_sec} * 1'000'000'000 + std::int64_t{file.st_mtim.tv_nsec}};
}

}  // namespace

FileError file_error(std::string_view operation, const std::filesystem::path& path, std::string_view reason,
                     std::string_view advice) {
  std::string message = "cannot ";
  message.append(operation).append(" '").append(path.string()).append("': ").append(reason);
  return FileError(message.append("; ").append(advice));
}

fs::path resolve_links(const fs::path& path) {
  constexpr int kMostLinks = 40;  // as the kernel's
  std::error_code none;
  const fs::file_status status = fs::status(path, none);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) return path;
  fs::path target = path;
  for (int links = 0; fs::is_symlink(target, none); ++links) {
    if (links == kMostLinks) throw file_error("write", path, system_message(ELOOP), "remove the symbolic link");
    const fs::path next = fs::read_symlink(target, none);
    target = target.parent_path() / next;  // `next` alone where it is absolute
  }
  return target;
}

OutputFile::OutputFile(const fs::path& path) : path_(path), target_(resolve_links(path)) {
  std::error_code none;
  const fs::file_status status = fs::status(target_, none);
  if (fs::is_directory(status))
    throw file_error("write", path_, system_message(EISDIR), "give the name of a file");
  if (fs::is_block_file(status) || fs::is_socket(status))
    throw file_error("write", path_, "it is a device or socket", "give the name of a file");
  is_stream_ = fs::is_fifo(status) || fs::is_character_file(status);
  const fs::path beside = is_stream_ ? fs::temp_directory_path(none) / "vpe-output" : target_;
  stream_ = make_temporary(beside, temporary_);
  if (stream_ == nullptr) {
    throw file_error("write", path_, system_message(errno),
                     "check that the folder exists and may be written to");
  }
}

OutputFile::~OutputFile() {
  if (stream_ == nullptr) return;
  std::fclose(stream_);
  std::remove(temporary_.c_str());
}

void OutputFile::write(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;  // fwrite requires a pointer even for no bytes
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) {
    throw file_error("write", path_, system_message(errno), kDiskAdvice);
  }
}

void OutputFile::flush() {
  if (std::fflush(stream_) != 0) throw file_error("write", path_, system_message(errno), kDiskAdvice);
}

// Returns an error number, or 0.
int OutputFile::copy_to_stream() const {
  const int from = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (from < 0) return errno;
  const int to = ::open(target_.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  int error = to < 0 ? errno : 0;
  std::array<char, 1 << 16> buffer{};
  while (error == 0) {
    const ssize_t count = ::read(from, buffer.data(), buffer.size());
    if (count < 0) error = errno;
    if (count <= 0) break;
    for (ssize_t done = 0; error == 0 && done < count;) {
      const ssize_t written = ::write(to, buffer.data() + done, static_cast<std::size_t>(count - done));
      if (written > 0) done += written;
      if (written < 0 && errno != EINTR) error = errno;
    }
  }
  ::close(from);
  if (to >= 0 && ::close(to) != 0 && error == 0) error = errno;
  return error;
}

void OutputFile::commit() {
  // fwrite buffers: a full disk may not be noticed before this.
  const bool was_flushed = std::fflush(stream_) == 0 && std::ferror(stream_) == 0;
  const int flush_error = errno;
  const bool was_closed = std::fclose(std::exchange(stream_, nullptr)) == 0;
  const int close_error = errno;
  std::error_code failure;
  if (!was_flushed || !was_closed) {
    failure.assign(was_flushed ? close_error : flush_error, std::generic_category());
  } else if (is_stream_) {
    failure.assign(copy_to_stream(), std::generic_category());
  } else {
    fs::rename(temporary_, target_, failure);
  }
  if (failure || is_stream_) std::remove(temporary_.c_str());
  if (failure) throw file_error("write", path_, failure.message(), kDiskAdvice);
}

void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.commit();
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::optional<FileStamp> file_stamp(const std::filesystem::path& path) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return std::nullopt;
  return stamp_of(file);
}

std::optional<FileStamp> file_stamp(int descriptor) {
  struct stat file {};
  if (::fstat(descriptor, &file) != 0) return std::nullopt;
  return stamp_of(file);
}

std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::uintmax_t max_bytes) {
  constexpr std::string_view kAdvice = "check the name and the permissions";
  std::error_code failure;
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  if (failure) throw file_error("read", path, failure.message(), kAdvice);
  if (size > max_bytes) {
    throw file_error("read", path,
                     std::to_string(size) + " bytes are more than the " + std::to_string(max_bytes) +
                         " that are accepted here",
                     "choose a smaller file");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(path.c_str(), "rb"), std::fclose);
  if (stream == nullptr) throw file_error("read", path, system_message(errno), kAdvice);
  std::vector<std::uint8_t> bytes(size);
  if (std::fread(bytes.data(), 1, bytes.size(), stream.get()) != bytes.size()) {
    const bool has_failed = std::ferror(stream.get()) != 0;
    throw file_error("read", path, has_failed ? system_message(errno) : "it ends early", kAdvice);
  }
  return bytes;
}

}  // namespace vpe::base
