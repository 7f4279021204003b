#include "panorama/strip_file.h"

#include <cerrno>
#include <cstring>
#include <string_view>

#include "paging/codec.h"

namespace panorama {

namespace {

constexpr std::string_view kMagic = "vpe strip 1\n";
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 40;

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

void write_strip(vpe::core::OutputFile& file, const std::string& fingerprint, const Blocks& blocks) {
  file.write(bytes_of(std::string_view(head_of(fingerprint))));
  file.write(bytes_of(std::uint64_t{blocks.size()}));
  std::int64_t sum = 0;
  for (const auto& block : blocks) {
    const std::uint64_t size = block.size();
    file.write(bytes_of(size));
    sum = paging::checksum(sum, bytes_of(size));
  }
  for (const auto& block : blocks) {
    file.write(block);
    sum = paging::checksum(sum, block);
  }
  file.write(bytes_of(static_cast<std::uint64_t>(sum)));
}

std::optional<StripFile> StripFile::open(const std::filesystem::path& path, const std::string& fingerprint,
                                         std::size_t blocks) {
  const Stream stream = open_stream(path);
  if (stream == nullptr) return std::nullopt;
  const std::string head = head_of(fingerprint);
  std::string found(head.size(), '\0');
  std::uint64_t count = 0;
  if (std::fread(found.data(), 1, found.size(), stream.get()) != found.size() || found != head ||
      !read(stream.get(), count) || count != blocks) {
    return std::nullopt;
  }
  StripFile strip;
  strip.path_ = path;
  strip.begin_.push_back(head.size() + sizeof count * (blocks + 1));
  std::int64_t sum = 0;
  for (std::size_t n = 0; n < blocks; ++n) {
    std::uint64_t size = 0;
    if (!read(stream.get(), size) || size > kMostBytes) return std::nullopt;
    sum = paging::checksum(sum, bytes_of(size));
    strip.begin_.push_back(strip.begin_.back() + size);
  }
  std::error_code error;
  const std::uint64_t all = strip.begin_.back() + sizeof(std::uint64_t);
  if (std::filesystem::file_size(path, error) != all || error) return std::nullopt;
  std::vector<std::uint8_t> block;
  for (std::size_t n = 0; n < blocks; ++n) {
    block.resize(strip.begin_[n + 1] - strip.begin_[n]);
    if (std::fread(block.data(), 1, block.size(), stream.get()) != block.size()) return std::nullopt;
    sum = paging::checksum(sum, block);
  }
  std::uint64_t stated = 0;
  if (!read(stream.get(), stated) || stated != static_cast<std::uint64_t>(sum)) return std::nullopt;
  return strip;
}

std::vector<std::uint8_t> StripFile::block(std::size_t n) const {
  const Stream stream = open_stream(path_);
  const auto fail = [&](const char* words) {
    throw vpe::core::file_error("read back", path_, words, "run the same command again");
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
