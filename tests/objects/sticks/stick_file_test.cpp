// Files of models of sticks: round trip, damaged and hostile bytes.
#include "objects/sticks/stick_file.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <xxhash.h>

#include <cstring>
#include <filesystem>
#include <memory>

#include "tests/objects/sticks/stick_shapes.h"
#include "vpe/base/file.h"

namespace objects {
namespace {

namespace fs = std::filesystem;
using vpe::base::FileError;
using Bytes = std::vector<std::uint8_t>;

class StickFile : public testing::Test {
 protected:
  StickFile() : folder_(fs::temp_directory_path() / ("stick_file_test_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    path_ = folder_ / "rock.sticks";
  }
  ~StickFile() override { fs::remove_all(folder_); }

  // Returns why the bytes are refused; "" if they are read.
  std::string refused(const Bytes& bytes, StickModel* model = nullptr) const {
    vpe::base::write_file(path_, bytes);
    try {
      StickModel read = read_stick_file(path_);
      if (model != nullptr) *model = std::move(read);
      return "";
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("rock.sticks"), std::string::npos) << error.what();
      return error.what();
    }
  }
  Bytes written(const StickModel& model) const {
    write_stick_file(path_, model);
    return vpe::base::read_file(path_, 1U << 30);
  }

  fs::path folder_;
  fs::path path_;
};

StickModel some_model() {
  std::mt19937 random(5);
  VoxelGrid voxels({13, 11, 40, 0.1F, {1, 2, 3}});
  for (int n = 0; n < 700; ++n) {
    const auto alpha = static_cast<std::uint8_t>(random() % 3 == 0 ? 100 : 255);
    voxels.set(static_cast<int>(random() % 13), static_cast<int>(random() % 11),
               static_cast<int>(random() % 40),
               stick_voxel({static_cast<std::uint8_t>(random() % 5), 0, 9, alpha}, {0, 1, 0}));
  }
  return build_sticks(voxels);
}

TEST_F(StickFile, KeepsTheModel) {
  const StickModel model = some_model();
  const Bytes bytes = written(model);
  EXPECT_EQ(read_stick_file(path_).levels(), model.levels());
  EXPECT_EQ(written(read_stick_file(path_)), bytes);
  EXPECT_TRUE(read_stick_file(path_).ball().radius_m == model.ball().radius_m);
  written(StickModel());
  EXPECT_TRUE(read_stick_file(path_).levels().empty());
  written(build_sticks(VoxelGrid({3, 3, 3, 1, {0, 0, 0}})));  // no voxel, so empty lists
  EXPECT_EQ(read_stick_file(path_).levels().size(), 1U);
}

TEST_F(StickFile, EveryTruncationIsRefused) {
  Bytes bytes = written(some_model());
  const Bytes whole = bytes;
  for (std::size_t size = 0; size < whole.size(); size += size < 300 ? 1 : 13) {
    bytes.assign(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_NE(refused(bytes), "") << size;
  }
  bytes = whole;
  bytes.push_back(0);
  EXPECT_NE(refused(bytes).find("bytes follow"), std::string::npos);
  EXPECT_EQ(refused(whole), "");
}

TEST_F(StickFile, ChangedBytesAreRefused) {
  const StickModel model = some_model();
  const Bytes whole = written(model);
  std::mt19937 random(2026);
  for (int n = 0; n < 800; ++n) {
    Bytes bytes = whole;
    const std::size_t at = n < 300 ? static_cast<std::size_t>(n) : random() % bytes.size();
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1U << (random() % 8)));
    StickModel read;
    if (refused(bytes, &read).empty()) {
      EXPECT_EQ(read.levels(), model.levels()) << at;
    }
  }
}

TEST_F(StickFile, SaysWhatAndWhere) {
  Bytes bytes = written(some_model());
  Bytes other = bytes;
  other[0] = 'X';
  EXPECT_NE(refused(other).find("not a file of sticks"), std::string::npos);
  other = bytes;
  other[8] = 9;
  EXPECT_NE(refused(other).find("version 9"), std::string::npos);
  other = bytes;
  other[24 + 40] ^= 1U;
  EXPECT_NE(refused(other).find("the head of level 0"), std::string::npos);
  other = bytes;
  other[24 + 136 + 2] ^= 1U;
  EXPECT_NE(refused(other).find("the columns of level 0"), std::string::npos);
  EXPECT_THROW(read_stick_file(folder_ / "none.sticks"), FileError);
  EXPECT_THROW(write_stick_file(folder_ / "no" / "folder.sticks", StickModel()), FileError);
}

// Changes the head of level 0 and gives it a valid checksum.
Bytes forged(Bytes bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  std::memcpy(bytes.data() + 24 + at, &value, size);
  const std::uint64_t checksum = XXH3_64bits(bytes.data() + 24, 128);
  std::memcpy(bytes.data() + 24 + 128, &checksum, sizeof(checksum));
  return bytes;
}

std::size_t peak_bytes() {
  const Bytes text = [] {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/proc/self/status", "rb"), std::fclose);
    Bytes all(1 << 14);
    all.resize(file == nullptr ? 0 : std::fread(all.data(), 1, all.size(), file.get()));
    return all;
  }();
  const std::string status(text.begin(), text.end());
  const std::size_t at = status.find("VmPeak:");
  return at == std::string::npos ? 0 : std::stoull(status.substr(at + 7)) * 1024;
}

TEST_F(StickFile, HugeCountsTakeNoMemory) {
  const Bytes whole = written(some_model());
  const std::size_t before = peak_bytes();
  for (std::size_t list = 0; list < 4; ++list) {
    for (const std::uint64_t count : {std::uint64_t{1} << 24, std::uint64_t{1} << 27, std::uint64_t{1} << 40,
                                      std::uint64_t{1} << 62, ~std::uint64_t{0}}) {
      EXPECT_NE(refused(forged(whole, 32 + list * 24, count, 8)), "");      // entries
      EXPECT_NE(refused(forged(whole, 32 + list * 24 + 8, count, 8)), "");  // packed bytes
    }
  }
  for (std::size_t side = 0; side < 3; ++side) {
    for (const std::uint64_t size : {0x7FFFFFFFULL, 0xFFFFFFFFULL, 0ULL, 4097ULL, 2ULL})
      EXPECT_NE(refused(forged(whole, side * 4, size, 4)), "");
  }
  EXPECT_NE(refused(forged(whole, 12, 0x7FC00000, 4)), "");  // an edge that is not a number
  EXPECT_LT(peak_bytes() - before, std::size_t{64} << 20);
}

TEST_F(StickFile, WrongContentUnderGoodChecksumsIsRefused) {
  StickModel::Level level = some_model().levels()[0];
  const Bytes good = written(StickModel({level}));
  const std::uint32_t stick = level.columns[0];
  EXPECT_EQ(refused(good), "");
  // The list of voxels of another file of fewer voxels.
  VoxelGrid voxels(level.grid);
  voxels.set(0, 0, 0);
  const Bytes small = written(build_sticks(voxels));
  EXPECT_NE(small, good);
  EXPECT_LT(stick, level.sticks.size());
  const auto list_at = [](const Bytes& bytes, std::size_t list) {
    std::size_t at = 24 + 136;
    for (std::size_t n = 0; n < list; ++n) {
      std::uint64_t size = 0;
      std::memcpy(&size, bytes.data() + 24 + 32 + n * 24 + 8, 8);
      at += size;
    }
    return static_cast<std::ptrdiff_t>(at);
  };
  Bytes mixed(good.begin(), good.begin() + list_at(good, 3));
  std::memcpy(mixed.data() + 24 + 32 + 3 * 24, small.data() + 24 + 32 + 3 * 24, 24);
  mixed.insert(mixed.end(), small.begin() + list_at(small, 3), small.begin() + list_at(small, 4));
  mixed = forged(mixed, 12, 0x3DCCCCCD, 4);
  const std::string reason = refused(mixed);
  EXPECT_NE(reason, "");
}

}  // namespace
}  // namespace objects
