#include "objects/sticks/stick_file.h"

#include <xxhash.h>
#include <zstd.h>

#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "vpe/base/file.h"

namespace objects {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::array<char, 8> kStickMagic = {'V', 'P', 'E', 'S', 'T', 'I', 'C', 'K'};
constexpr std::uint32_t kStickVersion = 1;
constexpr int kStickPacking = 9;  // of zstd: larger levels gain less than a hundredth
// A zstd block holds at most 128 KiB and takes at least 4 bytes.
constexpr std::uint64_t kMostZstdRatio = (std::uint64_t{128} << 10) / 4;
constexpr std::size_t kStickLists = 4;
constexpr std::array<const char*, kStickLists> kStickListNames = {"columns", "sticks", "runs", "voxels"};

using Bytes = std::vector<std::uint8_t>;

// Structures of the file have no gaps, so that no byte of them is unset.
struct StoredHead {
  std::array<char, 8> magic = kStickMagic;
  std::uint32_t version = kStickVersion;
  std::uint32_t levels = 0;
};
static_assert(sizeof(StoredHead) == 16);

struct StoredList {
  std::uint64_t entries = 0;
  std::uint64_t packed_bytes = 0;
  std::uint64_t checksum = 0;
};

struct StoredLevel {
  std::array<std::int32_t, 3> sides{};
  float voxel_m = 0;
  std::array<float, 3> corner_m{};
  std::uint32_t unused = 0;
  std::array<StoredList, kStickLists> lists;
};
static_assert(sizeof(StoredLevel) == 32 + kStickLists * 24);

struct StoredStick {
  std::uint8_t kind = 0;
  std::uint8_t unused = 0;
  std::uint16_t runs = 0;
  std::uint32_t first_run = 0;
};
static_assert(sizeof(StoredStick) == 8);

struct StoredRun {
  std::uint16_t begin = 0;
  std::uint16_t length = 0;
  std::uint32_t first_voxel = 0;
  std::uint8_t is_uniform = 0;
  std::uint8_t is_opaque = 0;
  std::uint16_t unused = 0;
};
static_assert(sizeof(StoredRun) == 12);

constexpr std::array<std::uint64_t, kStickLists> kStickEntry_bytes = {4, sizeof(StoredStick), sizeof(StoredRun),
                                                                      sizeof(StickVoxel)};

template <class T>
void append_value(Bytes& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto* from = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), from, from + sizeof(T));
}

// Appends a structure and its checksum.
template <class T>
void append_checked(Bytes& out, const T& value) {
  append_value(out, value);
  append_value(out, std::uint64_t{XXH3_64bits(&value, sizeof(T))});
}

vpe::base::FileError write_fault(const std::filesystem::path& path, const std::string& reason) {
  return vpe::base::file_error("write", path, reason, "make the model from fewer voxels");
}

template <class T>
Bytes packed(const std::vector<T>& values, const std::filesystem::path& path) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::size_t size = values.size() * sizeof(T);
  Bytes out(ZSTD_compressBound(size));
  const std::size_t got = ZSTD_compress(out.data(), out.size(), values.data(), size, kStickPacking);
  if (ZSTD_isError(got) != 0U) throw write_fault(path, std::string("zstd: ") + ZSTD_getErrorName(got));
  out.resize(got);
  return out;
}

Bytes packed_level(const StickModel::Level& level, const std::filesystem::path& path) {
  std::vector<StoredStick> sticks;
  sticks.reserve(level.sticks.size());
  for (const StickModel::Stick& s : level.sticks)
    sticks.push_back({static_cast<std::uint8_t>(s.kind), 0, s.runs, s.first_run});
  std::vector<StoredRun> runs;
  runs.reserve(level.runs.size());
  for (const StickModel::Run& r : level.runs)
    runs.push_back({r.begin, r.length, r.first_voxel, static_cast<std::uint8_t>(r.is_uniform ? 1 : 0),
                    static_cast<std::uint8_t>(r.is_opaque ? 1 : 0), 0});
  const std::array<Bytes, kStickLists> lists = {packed(level.columns, path), packed(sticks, path),
                                                packed(runs, path), packed(level.voxels, path)};
  const std::array<std::size_t, kStickLists> entries = {level.columns.size(), sticks.size(), runs.size(),
                                                        level.voxels.size()};
  const StickGrid& g = level.grid;
  StoredLevel head;
  head.sides = {g.columns_x, g.columns_y, g.height};
  head.voxel_m = g.voxel_m;
  head.corner_m = {g.corner_m.x, g.corner_m.y, g.corner_m.z};
  for (std::size_t n = 0; n < kStickLists; ++n)
    head.lists[n] = {entries[n], lists[n].size(), XXH3_64bits(lists[n].data(), lists[n].size())};
  Bytes out;
  append_checked(out, head);
  for (const Bytes& list : lists) out.insert(out.end(), list.begin(), list.end());
  return out;
}

class StickFileReader {
 public:
  explicit StickFileReader(const std::filesystem::path& path)
      : path_(path), bytes_(vpe::base::read_file(path, StickFileLimits::kMostFile_bytes)), rest_(bytes_) {}

  StickModel read() {
    const auto head = checked<StoredHead>("the head");
    if (head.levels > StickFileLimits::kMostLevels)
      throw fault("the head", "it states " + std::to_string(head.levels) + " levels");
    std::vector<StickModel::Level> levels;
    for (std::uint32_t n = 0; n < head.levels; ++n) levels.push_back(level("level " + std::to_string(n)));
    if (!rest_.empty()) throw fault("the end", "bytes follow");
    try {
      return StickModel(std::move(levels));
    } catch (const std::invalid_argument& error) {
      throw fault("the end", error.what());
    }
  }

 private:
  vpe::base::FileError fault(const std::string& place, const std::string& reason) const {
    const std::size_t at = bytes_.size() - rest_.size();
    return vpe::base::file_error("read", path_, place + ", before byte " + std::to_string(at) + ": " + reason,
                                 "make the file again with 'vpe object' or 'vpe sculpt'");
  }

  std::span<const std::uint8_t> take(std::uint64_t size, const std::string& place) {
    if (size > rest_.size()) throw fault(place, "the file ends early");
    const std::span<const std::uint8_t> taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }

  template <class T>
  T checked(const std::string& place) {
    T value;
    std::uint64_t checksum = 0;
    std::memcpy(&value, take(sizeof(T), place).data(), sizeof(T));
    if constexpr (std::is_same_v<T, StoredHead>) {
      if (value.magic != kStickMagic) throw fault(place, "it is not a file of sticks");
      if (value.version != kStickVersion)
        throw fault(place, "version " + std::to_string(value.version) + " is not known here");
    }
    std::memcpy(&checksum, take(sizeof(checksum), place).data(), sizeof(checksum));
    if (checksum != XXH3_64bits(&value, sizeof(T))) throw fault(place, "its checksum is wrong");
    return value;
  }

  template <class T>
  std::vector<T> unpacked(const StoredLevel& head, std::size_t list, const std::string& level) {
    const StoredList& stated = head.lists[list];
    const std::string place = "the " + std::string(kStickListNames[list]) + " of " + level;
    const std::span<const std::uint8_t> bytes = take(stated.packed_bytes, place);
    if (XXH3_64bits(bytes.data(), bytes.size()) != stated.checksum)
      throw fault(place, "their checksum is wrong");
    const std::uint64_t size = stated.entries * sizeof(T);
    if (ZSTD_getFrameContentSize(bytes.data(), bytes.size()) != size ||
        ZSTD_findFrameCompressedSize(bytes.data(), bytes.size()) != bytes.size() ||
        size > bytes.size() * kMostZstdRatio)
      throw fault(place, "they are not packed as the head states");
    std::vector<T> values(stated.entries);
    const std::size_t got = ZSTD_decompress(values.data(), size, bytes.data(), bytes.size());
    if (ZSTD_isError(got) != 0U) throw fault(place, std::string("zstd: ") + ZSTD_getErrorName(got));
    if (got != size) throw fault(place, "they end early");
    return values;
  }

  void check_sizes(const StoredLevel& head, const std::string& place) {
    std::uint64_t columns = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      if (head.sides[k] < 1 || head.sides[k] > StickLimits::kMostSide)
        throw fault(place, "a side is out of range");
      if (k < 2) columns *= static_cast<std::uint64_t>(head.sides[k]);
    }
    if (columns > StickLimits::kMostColumns) throw fault(place, "it has too many columns");
    const std::array<std::uint64_t, kStickLists> most = {columns, columns + 1, StickLimits::kMostVoxels,
                                                         StickLimits::kMostVoxels};
    for (std::size_t n = 0; n < kStickLists; ++n) {
      const std::uint64_t entries = head.lists[n].entries;
      if (entries > most[n]) throw fault(place, std::string("it has too many ") + kStickListNames[n]);
      unpacked_bytes_ += entries * kStickEntry_bytes[n];
      if (unpacked_bytes_ > StickFileLimits::kMostUnpacked_bytes)
        throw fault(place,
                    "the lists are over " + std::to_string(StickFileLimits::kMostUnpacked_bytes) + " bytes");
    }
  }

  StickModel::Level level(const std::string& name) {
    const auto head = checked<StoredLevel>("the head of " + name);
    check_sizes(head, "the head of " + name);
    StickModel::Level out;
    out.grid.columns_x = head.sides[0];
    out.grid.columns_y = head.sides[1];
    out.grid.height = head.sides[2];
    out.grid.voxel_m = head.voxel_m;
    out.grid.corner_m = {head.corner_m[0], head.corner_m[1], head.corner_m[2]};
    out.columns = unpacked<std::uint32_t>(head, 0, name);
    const std::vector<StoredStick> sticks = unpacked<StoredStick>(head, 1, name);
    out.sticks.reserve(sticks.size());
    for (const StoredStick& s : sticks)
      out.sticks.push_back({static_cast<StickKind>(s.kind), s.runs, s.first_run});
    const std::vector<StoredRun> runs = unpacked<StoredRun>(head, 2, name);
    out.runs.reserve(runs.size());
    for (const StoredRun& r : runs) {
      if (r.is_uniform > 1 || r.is_opaque > 1) throw fault("the runs of " + name, "a mark is neither 0 nor 1");
      out.runs.push_back({r.begin, r.length, r.first_voxel, r.is_uniform == 1, r.is_opaque == 1});
    }
    out.voxels = unpacked<StickVoxel>(head, 3, name);
    return out;
  }

  std::filesystem::path path_;
  Bytes bytes_;
  std::span<const std::uint8_t> rest_;
  std::uint64_t unpacked_bytes_ = 0;
};

}  // namespace

void write_stick_file(const std::filesystem::path& path, const StickModel& model) {
  std::uint64_t size = 0;
  for (const StickModel::Level& l : model.levels()) {
    size += l.columns.size() * kStickEntry_bytes[0] + l.sticks.size() * kStickEntry_bytes[1] +
            l.runs.size() * kStickEntry_bytes[2] + l.voxels.size() * kStickEntry_bytes[3];
  }
  if (model.levels().size() > StickFileLimits::kMostLevels || size > StickFileLimits::kMostUnpacked_bytes)
    throw write_fault(path, "the model has " + std::to_string(model.levels().size()) + " levels and " +
                                std::to_string(size) + " bytes, more than a file may hold");
  vpe::base::OutputFile file(path);
  StoredHead head;
  head.levels = static_cast<std::uint32_t>(model.levels().size());
  Bytes bytes;
  append_checked(bytes, head);
  file.write(bytes);
  for (const StickModel::Level& l : model.levels()) file.write(packed_level(l, path));
  file.commit();
}

StickModel read_stick_file(const std::filesystem::path& path) { return StickFileReader(path).read(); }

}  // namespace objects
