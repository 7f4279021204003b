#include "panorama/image/input.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "vpe/base/file.h"

namespace panorama {

Input::Input(const std::filesystem::path& path) {
  constexpr char kAdvice[] = "check the name and the permissions";
  std::error_code failure;
  size_ = std::filesystem::file_size(path, failure);
  if (failure) throw vpe::base::file_error("read", path, failure.message(), kAdvice);
  stream_.reset(std::fopen(path.c_str(), "rb"));
  if (stream_ == nullptr) throw vpe::base::file_error("read", path, std::strerror(errno), kAdvice);
}

void Input::read(std::uint64_t at, std::span<std::uint8_t> out) const {
  const bool fits = at <= size_ && out.size() <= size_ - at;
  bool ok = fits;
  if (fits && stream_ == nullptr) {
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at), out.size(), out.begin());
  } else if (fits) {
    ok = fseeko(stream_.get(), static_cast<off_t>(at), SEEK_SET) == 0 &&
         std::fread(out.data(), 1, out.size(), stream_.get()) == out.size();
  }
  if (!ok) {
    throw MetadataError("it ends early: " + std::to_string(out.size()) + " bytes wanted at byte " +
                        std::to_string(at) + " of " + std::to_string(size_) + "; the file is damaged");
  }
}

std::string Input::read_text(std::uint64_t at, std::size_t size) const {
  std::string text(size, '\0');
  read(at, {reinterpret_cast<std::uint8_t*>(text.data()), text.size()});
  return text;
}

}  // namespace panorama
