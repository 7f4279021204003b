// Digests: fingerprints of inputs and checksums of files. XXH3 with 128 bits, which guards against accidents,
// not against attacks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace vpe::app {

// Digests a sequence of values. Every value enters with its type and length, so that different sequences are
// different bytes. The result is the same on every machine. One thread at a time.
//
// Typical usage:
//   const std::string fingerprint = Digest().add("render").add(std::int64_t{width}).add(fov_deg).hex();
class Digest {
 public:
  Digest();
  ~Digest();
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;

  Digest& add(std::string_view text);
  Digest& add(std::int64_t number);
  Digest& add(double number);  // by its bits: 0.0 and -0.0 differ

  // Returns 32 hexadecimal digits.
  std::string hex() const;

 private:
  struct State;
  void add_raw(char type, std::uint64_t value);
  std::unique_ptr<State> state_;
};

// Returns the checksum of the bytes as `xxh128sum` prints it.
std::string checksum_of(std::span<const std::uint8_t> bytes);
// Returns the checksum of a file's content. Throws base::FileError.
std::string checksum_of(const std::filesystem::path& file);

}  // namespace vpe::app
