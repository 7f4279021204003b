// Digests of what a film is made of: fingerprints of inputs, checksums of files. XXH3 with 128 bits: they guard
// against accidents, not against people.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace vpe::app {

// Of a sequence of values, each with its type and length, so that different sequences are different bytes. The
// same on every machine.
class Digest {
 public:
  Digest();
  ~Digest();
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;

  Digest& add(std::string_view text);
  Digest& add(std::int64_t number);
  Digest& add(double number);  // its bits

  std::string hex() const;  // 32 hexadecimal digits

 private:
  struct State;
  void add_raw(char type, std::uint64_t value);
  std::unique_ptr<State> state_;
};

// Of bytes, as `xxh128sum` prints it.
std::string checksum_of(std::span<const std::uint8_t> bytes);
// Throws base::FileError.
std::string checksum_of(const std::filesystem::path& file);

}  // namespace vpe::app
