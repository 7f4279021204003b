#include "panorama/image/strip_file.h"

#include <cerrno>
#include <cstring>
#include <string_view>

#include "paging/planet/codec.h"

namespace panorama {

namespace {

constexpr std::string_view kMagic = "vpe strip 1\n";

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::span<const std::uint8_t> bytes_of(const std::uint64_t& number) {
  return {reinterpret_cast<const std::uint8_t*>(&number), sizeof number};
}

using Stream = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

Stream open_stream(const std::filesystem::path& path) { return {std::fopen(path.c_str(), "rb"), std::fclose}; }

bool read(std::FILE* stream, std::uint64_t& number) {
  return std::fread(&number, 1, sizeof number, stream) == sizeof number;
}

std::string head_of(const std::string& fingerprint) { return std::string(kMagic) + fingerprint + "\n"; }

}  // namespace

StripWriter::StripWriter(vpe::base::OutputFile& file, const std::string& fingerprint) : file_(file) {
  file_.write(bytes_of(std::string_view(head_of(fingerprint))));
}

void StripWriter::add(std::span<const std::uint8_t> block) {
  file_.write(block);
  sizes_.push_back(block.size());
  sum_ = paging::checksum(sum_, block);
}

void StripWriter::finish() {
  for (const std::uint64_t& size : sizes_) {
    file_.write(bytes_of(size));
    sum_ = paging::checksum(sum_, bytes_of(size));
  }
  file_.write(bytes_of(std::uint64_t{sizes_.size()}));
  file_.write(bytes_of(static_cast<std::uint64_t>(sum_)));
}

std::optional<StripFile> StripFile::open(const std::filesystem::path& path, const std::string& fingerprint,
                                         std::size_t blocks) {
  const Stream stream = open_stream(path);
  if (stream == nullptr) return std::nullopt;
  const std::string head = head_of(fingerprint);
  const std::uint64_t tail = sizeof(std::uint64_t) * (blocks + 2);
  std::error_code error;
  const std::uint64_t all = std::filesystem::file_size(path, error);
  std::string found(head.size(), '\0');
  if (error || all < head.size() + tail ||
      std::fread(found.data(), 1, found.size(), stream.get()) != found.size() || found != head ||
      fseeko(stream.get(), static_cast<off_t>(all - tail), SEEK_SET) != 0) {
    return std::nullopt;
  }
  StripFile strip;
  strip.path_ = path;
  strip.begin_.push_back(head.size());
  for (std::size_t n = 0; n < blocks; ++n) {
    std::uint64_t size = 0;
    if (!read(stream.get(), size) || size > all) return std::nullopt;
    strip.begin_.push_back(strip.begin_.back() + size);
  }
  std::uint64_t count = 0;
  std::uint64_t stated = 0;
  if (strip.begin_.back() != all - tail || !read(stream.get(), count) || count != blocks ||
      !read(stream.get(), stated) || fseeko(stream.get(), static_cast<off_t>(head.size()), SEEK_SET) != 0) {
    return std::nullopt;
  }
  std::int64_t sum = 0;
  std::vector<std::uint8_t> block;
  for (std::size_t n = 0; n < blocks; ++n) {
    block.resize(strip.begin_[n + 1] - strip.begin_[n]);
    if (std::fread(block.data(), 1, block.size(), stream.get()) != block.size()) return std::nullopt;
    sum = paging::checksum(sum, block);
  }
  for (std::size_t n = 0; n < blocks; ++n) {
    const std::uint64_t size = strip.begin_[n + 1] - strip.begin_[n];
    sum = paging::checksum(sum, bytes_of(size));
  }
  if (stated != static_cast<std::uint64_t>(sum)) return std::nullopt;
  return strip;
}

std::vector<std::uint8_t> StripFile::block(std::size_t n) const {
  const Stream stream = open_stream(path_);
  const auto fail = [&](const char* words) {
    throw vpe::base::file_error("read back", path_, words, "run the same command again");
  };
  if (stream == nullptr) fail(std::strerror(errno));
  std::vector<std::uint8_t> bytes(begin_.at(n + 1) - begin_[n]);
  if (fseeko(stream.get(), static_cast<off_t>(begin_[n]), SEEK_SET) != 0 ||
      std::fread(bytes.data(), 1, bytes.size(), stream.get()) != bytes.size()) {
    fail(std::ferror(stream.get()) != 0 ? std::strerror(errno) : "it ends early");
  }
  return bytes;
}

}  // namespace panorama
