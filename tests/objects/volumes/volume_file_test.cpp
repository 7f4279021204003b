// Files of volumes: round trip, damaged and hostile bytes.
#include "objects/volumes/volume_file.h"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <cstring>

#include "objects/files/volume_model_file.h"
#include "tests/objects/volumes/volume_shapes.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace objects {
namespace {

using vpe::base::FileError;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kHeadBytes = 96;

// Returns why the bytes are refused; "" if they are read.
std::string refused(const Bytes& bytes, VolumeLevel* level = nullptr) {
  try {
    const VolumeModel read = volume_of_bytes(bytes, "smoke.volume");
    if (level != nullptr) *level = read.levels().front();
    return "";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("smoke.volume"), std::string::npos) << error.what();
    return error.what();
  }
}

Bytes some_bytes() { return volume_bytes(chance_level(4, 14), {9, 8, 7, 255}, "smoke.volume"); }

// Changes the head and gives it a valid checksum.
Bytes forged(Bytes bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  std::memcpy(bytes.data() + at, &value, size);
  const std::uint64_t checksum = XXH3_64bits(bytes.data(), kHeadBytes);
  std::memcpy(bytes.data() + kHeadBytes, &checksum, sizeof(checksum));
  return bytes;
}

TEST(VolumeFile, KeepsTheModel) {
  const ::test_support::TempDir folder;
  const VolumeModel model(chance_level(4), {200, 150, 100, 255});
  write_volume_file(folder / "a.volume", model);
  const VolumeModel read = read_volume_file(folder / "a.volume");
  EXPECT_EQ(read.levels(), model.levels());
  EXPECT_EQ(read.colour(), model.colour());
  write_volume_file(folder / "b.volume", read);
  EXPECT_EQ(vpe::base::read_file(folder / "a.volume", 1U << 30),
            vpe::base::read_file(folder / "b.volume", 1U << 30));
  EXPECT_EQ(read_volume_model(folder / "a.volume").levels(), model.levels());
  EXPECT_THROW(read_volume_file(folder / "none.volume"), FileError);
  EXPECT_THROW(write_volume_file(folder / "no" / "a.volume", model), FileError);
}

TEST(VolumeFile, ChangesOfEachByteAreRefused) {
  const Bytes whole = some_bytes();
  VolumeLevel level;
  ASSERT_EQ(refused(whole, &level), "");
  EXPECT_TRUE(is_volume_file(whole));
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const unsigned change : {1U, 0x80U, 0xFFU}) {
      Bytes bytes = whole;
      bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ change);
      VolumeLevel read;
      if (refused(bytes, &read).empty()) {
        EXPECT_EQ(read, level) << at;
      }
    }
  }
}

TEST(VolumeFile, EveryTruncationIsRefused) {
  const Bytes whole = some_bytes();
  for (std::size_t size = 0; size < whole.size(); ++size)
    ASSERT_NE(refused(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))), "") << size;
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_NE(refused(longer).find("bytes follow"), std::string::npos);
}

TEST(VolumeFile, SaysWhatAndWhere) {
  const Bytes whole = some_bytes();
  Bytes bytes = whole;
  bytes[0] = 'X';
  EXPECT_NE(refused(bytes).find("not a file of a volume"), std::string::npos);
  EXPECT_FALSE(is_volume_file(bytes));
  EXPECT_FALSE(is_volume_file({}));
  bytes = whole;
  bytes[8] = 9;
  EXPECT_NE(refused(bytes).find("version 9"), std::string::npos);
  bytes = whole;
  bytes[20] ^= 1U;
  EXPECT_NE(refused(bytes).find("the head"), std::string::npos);
  bytes = whole;
  bytes.back() ^= 1U;
  EXPECT_NE(refused(bytes).find("the posts"), std::string::npos);
}

// Claims are compared with limits and with the packed bytes before anything is allocated.
TEST(VolumeFile, HugeClaimsAreRefused) {
  const Bytes whole = some_bytes();
  for (const std::size_t list : {std::size_t{48}, std::size_t{72}}) {
    for (const std::uint64_t count : {std::uint64_t{1} << 20, std::uint64_t{1} << 27, std::uint64_t{1} << 40,
                                      std::uint64_t{1} << 62, ~std::uint64_t{0}}) {
      EXPECT_NE(refused(forged(whole, list, count, 8)), "");      // entries
      EXPECT_NE(refused(forged(whole, list + 8, count, 8)), "");  // packed bytes
    }
  }
  for (std::size_t side = 0; side < 3; ++side) {
    for (const std::uint64_t posts : {0x7FFFFFFFULL, 0xFFFFFFFFULL, 0ULL, 1ULL, 2049ULL, 1500ULL})
      EXPECT_NE(refused(forged(whole, 16 + side * 4, posts, 4)), "");
  }
  for (const std::size_t number : {std::size_t{28}, std::size_t{32}, std::size_t{44}}) {
    EXPECT_NE(refused(forged(whole, number, 0x7FC00000, 4)), "") << number;  // not a number
    EXPECT_NE(refused(forged(whole, number, 0x7F800000, 4)), "") << number;  // infinite
  }
}

}  // namespace
}  // namespace objects
