// Checksums that archives publish: MD5 and SHA-256. They guard against accidents; only SHA-256 guards against
// attacks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace vpe::app {

enum class ChecksumKind : std::uint8_t { kMd5, kSha256 };

// A checksum that a file should have.
struct Checksum {
  ChecksumKind kind = ChecksumKind::kSha256;
  std::string hex;  // in small letters
};

// Returns "MD5" or "SHA-256".
const char* name_of(ChecksumKind kind);

// Returns the checksum of a file's content in hexadecimal digits. Calls `progress` with the bytes that were
// read; it may throw to stop. Throws base::FileError.
std::string file_checksum(const std::filesystem::path& file, ChecksumKind kind,
                          const std::function<void(std::int64_t bytes)>& progress);

// Returns the MD5 checksum in a checksum file as md5sum writes it ("DIGITS  NAME"), in small letters. Returns
// nullopt if it holds none for the file of this name.
std::optional<std::string> parse_md5_file(std::string_view text, std::string_view name);

}  // namespace vpe::app
