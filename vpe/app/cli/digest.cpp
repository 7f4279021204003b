#include "vpe/app/cli/digest.h"

#include <xxhash.h>

#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "vpe/base/file.h"

namespace vpe::app {

namespace {

std::string to_hex(const XXH128_hash_t& hash) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, hash);
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : canonical.digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

struct FreeState {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};
using StatePointer = std::unique_ptr<XXH3_state_t, FreeState>;

StatePointer make_state() {
  StatePointer state(XXH3_createState());
  if (!state) throw std::bad_alloc();
  XXH3_128bits_reset(state.get());
  return state;
}

}  // namespace

struct Digest::State {
  StatePointer xxh = make_state();
};

Digest::Digest() : state_(std::make_unique<State>()) {}
Digest::~Digest() = default;

void Digest::add_raw(char type, std::uint64_t value) {
  unsigned char bytes[9] = {static_cast<unsigned char>(type)};
  for (int n = 0; n < 8; ++n) bytes[1 + n] = static_cast<unsigned char>(value >> (8 * n));
  XXH3_128bits_update(state_->xxh.get(), bytes, sizeof bytes);
}

Digest& Digest::add(std::string_view text) {
  add_raw('s', text.size());
  XXH3_128bits_update(state_->xxh.get(), text.data(), text.size());
  return *this;
}

Digest& Digest::add(std::int64_t number) {
  add_raw('i', static_cast<std::uint64_t>(number));
  return *this;
}

Digest& Digest::add(double number) {
  add_raw('d', std::bit_cast<std::uint64_t>(number));
  return *this;
}

std::string Digest::hex() const { return to_hex(XXH3_128bits_digest(state_->xxh.get())); }

std::string checksum_of(std::span<const std::uint8_t> bytes) {
  return to_hex(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string checksum_of(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  const auto fail = [&] {
    throw base::file_error("read", path, std::strerror(errno), "check the name and the permissions");
  };
  if (file == nullptr) fail();
  const StatePointer state = make_state();
  std::vector<std::uint8_t> buffer(std::size_t{1} << 20);
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get())) {
    XXH3_128bits_update(state.get(), buffer.data(), count);
  }
  if (std::ferror(file.get()) != 0) fail();
  return to_hex(XXH3_128bits_digest(state.get()));
}

}  // namespace vpe::app
