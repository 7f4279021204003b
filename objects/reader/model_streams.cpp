#include "objects/reader/model_streams.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "vpe/base/quote.h"

namespace objects {

namespace fs = std::filesystem;

namespace {

// Bytes in memory, then the rest of a file.
class Stream : public Assimp::IOStream {
 public:
  Stream(int file, std::uint64_t file_bytes, Replacement replacement)
      : file_(file), head_(std::move(replacement.head)), skipped_(replacement.replaced_bytes) {
    size_ = head_.size() + (file_bytes > skipped_ ? file_bytes - skipped_ : 0);
  }
  ~Stream() override { ::close(file_); }

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    if (size == 0 || count == 0) return 0;
    const std::uint64_t whole = std::min<std::uint64_t>(count, (size_ - at_) / size);
    auto* out = static_cast<char*>(buffer);
    std::uint64_t left = whole * size;
    if (at_ < head_.size()) {
      const std::uint64_t part = std::min<std::uint64_t>(left, head_.size() - at_);
      std::memcpy(out, head_.data() + at_, part);
      out += part;
      at_ += part;
      left -= part;
    }
    while (left > 0) {
      const ssize_t got = ::pread(file_, out, left, static_cast<off_t>(at_ - head_.size() + skipped_));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return 0;
      out += got;
      at_ += static_cast<std::uint64_t>(got);
      left -= static_cast<std::uint64_t>(got);
    }
    return whole;
  }
  std::size_t Write(const void* /*buffer*/, std::size_t /*size*/, std::size_t /*count*/) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::uint64_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : size_;
    const std::uint64_t to = origin == aiOrigin_END ? from - offset : from + offset;
    if (to > size_) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return size_; }
  void Flush() override {}

 private:
  int file_;
  std::string head_;
  std::uint64_t skipped_;
  std::uint64_t size_ = 0;
  std::uint64_t at_ = 0;
};

}  // namespace

ModelStreams::ModelStreams(const ModelFolder& folder, std::optional<Replacement> model)
    : folder_(folder), model_(std::move(model)) {}

std::optional<fs::path> ModelStreams::allowed(const char* file) const {
  std::error_code failure;
  const fs::path path = fs::weakly_canonical(file, failure);
  if (!failure && folder_.holds(path)) return path;
  if (!refusal_) {
    // The folder of the model stands before the name that the model has for the file.
    const std::string before = folder_.model().parent_path().string() + "/";
    const std::string name(file);
    refusal_.emplace("it names the file " +
                         vpe::base::quote_text(name.starts_with(before) ? name.substr(before.size()) : name) +
                         ", which lies outside of the model's folder",
                     "move it into the folder of the model and name it relative to that folder");
  }
  return {};
}

bool ModelStreams::Exists(const char* file) const {
  const std::optional<fs::path> path = allowed(file);
  std::error_code none;
  return path && fs::is_regular_file(*path, none);
}

Assimp::IOStream* ModelStreams::Open(const char* file, const char* mode) {
  if (mode == nullptr || mode[0] != 'r' || std::strchr(mode, '+') != nullptr) return nullptr;
  const std::optional<fs::path> path = allowed(file);
  if (!path) return nullptr;
  // Without O_NONBLOCK, opening a pipe would wait for ever.
  const int descriptor = ::open(path->c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat facts {};
  if (descriptor < 0 || ::fstat(descriptor, &facts) != 0 || !S_ISREG(facts.st_mode)) {
    if (descriptor >= 0) ::close(descriptor);
    missing_.push_back(path->filename().string());
    return nullptr;
  }
  const auto bytes = static_cast<std::uint64_t>(facts.st_size);
  if (bytes > ModelFolder::kMostBytes) {
    ::close(descriptor);
    if (!refusal_)
      refusal_.emplace("its file " + vpe::base::quote_text(path->filename().string()) + " has more than 2 GB",
                       "simplify the model or split it");
    return nullptr;
  }
  const bool is_model = *path == folder_.model();
  if (!is_model) opened_.push_back(*path);
  return new Stream(descriptor, bytes, is_model && model_ ? *model_ : Replacement{});
}

}  // namespace objects
