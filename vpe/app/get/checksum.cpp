#include "vpe/app/get/checksum.h"

#include <openssl/evp.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "vpe/base/file.h"

namespace vpe::app {

const char* name_of(ChecksumKind kind) { return kind == ChecksumKind::kMd5 ? "MD5" : "SHA-256"; }

std::string file_checksum(const std::filesystem::path& file, ChecksumKind kind,
                          const std::function<void(std::int64_t bytes)>& progress) {
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  if (context == nullptr ||
      EVP_DigestInit_ex(context.get(), kind == ChecksumKind::kMd5 ? EVP_md5() : EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error(std::string("libcrypto of this machine offers no ") + name_of(kind) +
                             "; --no-checksum does without");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), std::fclose);
  if (in == nullptr) throw base::file_error("read", file, std::strerror(errno), "check the permissions");
  std::vector<unsigned char> buffer(1 << 20);
  std::int64_t bytes = 0;
  for (;;) {
    const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), in.get());
    if (got == 0) break;
    EVP_DigestUpdate(context.get(), buffer.data(), got);
    bytes += static_cast<std::int64_t>(got);
    progress(bytes);
  }
  if (std::ferror(in.get()) != 0) throw base::file_error("read", file, std::strerror(errno), "check the disk");
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  EVP_DigestFinal_ex(context.get(), digest, &size);
  constexpr const char* kDigits = "0123456789abcdef";
  std::string hex;
  for (unsigned int n = 0; n < size; ++n)
    hex.append(1, kDigits[digest[n] >> 4]).append(1, kDigits[digest[n] & 15]);
  return hex;
}

}  // namespace vpe::app
