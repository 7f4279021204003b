#include "vpe/app/get/part_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "vpe/base/file.h"

namespace vpe::app {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxState_bytes = 1 << 16;

fs::path with_suffix(fs::path path, const char* suffix) { return path += suffix; }

std::string_view advice_for(int error) {
  return error == ENOSPC || error == EDQUOT ? "free some space; the same command continues"
                                            : "check the folder and its permissions";
}

}  // namespace

PartFile::PartFile(const fs::path& final_path)
    : final_(final_path),
      part_(with_suffix(final_path, ".part")),
      state_(with_suffix(final_path, ".part.json")) {
  for (;;) {
    file_ = ::open(part_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) throw base::file_error("write", part_, std::strerror(errno), advice_for(errno));
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(file_);
      throw std::runtime_error("another process fetches '" + final_.string() + "'; wait for it");
    }
    struct stat status {};
    if (::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) {
      ::close(file_);
      throw base::file_error("write", part_, "it is no ordinary file", "remove it");
    }
    size_ = status.st_size;
    if (status.st_nlink > 0) return;
    // The process that held it has renamed or removed it in between.
    ::close(file_);
  }
}

PartFile::~PartFile() {
  if (file_ < 0) return;
  if (size_ == 0) {
    std::error_code none;
    fs::remove(state_, none);
    fs::remove(part_, none);
  }
  ::close(file_);
}

std::optional<PartState> PartFile::state() const {
  std::error_code none;
  if (!fs::exists(state_, none)) return std::nullopt;
  const std::vector<std::uint8_t> bytes = base::read_file(state_, kMaxState_bytes);
  return parse_part_state({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void PartFile::set_state(const PartState& state) { base::write_file(state_, part_state_text(state)); }

void PartFile::cut(std::int64_t bytes) {
  if (::ftruncate(file_, bytes) != 0 || ::lseek(file_, bytes, SEEK_SET) < 0)
    throw base::file_error("write", part_, std::strerror(errno), advice_for(errno));
  size_ = bytes;
}

void PartFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw base::file_error("write", part_, std::strerror(errno), advice_for(errno));
    size_ += written;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void PartFile::publish() {
  if (::fsync(file_) != 0) throw base::file_error("write", part_, std::strerror(errno), advice_for(errno));
  if (::rename(part_.c_str(), final_.c_str()) != 0)
    throw base::file_error("rename", part_, std::strerror(errno), "check the folder and its permissions");
  std::error_code none;
  fs::remove(state_, none);
  ::close(file_);
  file_ = -1;
}

}  // namespace vpe::app
