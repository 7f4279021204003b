#include "objects/volumes/volume_file.h"

#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "vpe/base/file.h"

namespace objects {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::array<char, 8> kVolumeMagic = {'V', 'P', 'E', 'V', 'O', 'L', 'U', 'M'};
constexpr std::uint32_t kVolumeVersion = 1;
constexpr int kVolumePacking = 9;  // of zstd
// A zstd block holds at most 128 KiB and takes at least 4 bytes.
constexpr std::uint64_t kMostPackedRatio = (std::uint64_t{128} << 10) / 4;

struct PackedList {
  std::uint64_t entries = 0;
  std::uint64_t packed_bytes = 0;
  std::uint64_t checksum = 0;
};

// Has no gaps, so that no byte of it is unset.
struct VolumeHead {
  std::array<char, 8> magic = kVolumeMagic;
  std::uint32_t version = kVolumeVersion;
  std::array<std::uint8_t, 4> colour{};
  std::array<std::int32_t, 3> posts{};
  float spacing_m = 0;
  std::array<float, 3> corner_m{};
  float unit_per_m = 0;
  PackedList places;
  PackedList bricks;
};
static_assert(sizeof(VolumeHead) == 96);

template <class T>
std::vector<std::uint8_t> packed_list(const std::vector<T>& values, PackedList& list,
                                      const std::filesystem::path& name) {
  const std::size_t size = values.size() * sizeof(T);
  std::vector<std::uint8_t> out(ZSTD_compressBound(size));
  const std::size_t got = ZSTD_compress(out.data(), out.size(), values.data(), size, kVolumePacking);
  if (ZSTD_isError(got) != 0U) {
    throw vpe::base::file_error("write", name, std::string("zstd: ") + ZSTD_getErrorName(got),
                                "make the volume from fewer voxels");
  }
  out.resize(got);
  list = {values.size(), out.size(), XXH3_64bits(out.data(), out.size())};
  return out;
}

class VolumeReader {
 public:
  VolumeReader(std::span<const std::uint8_t> bytes, const std::filesystem::path& name)
      : name_(name), size_(bytes.size()), rest_(bytes) {}

  VolumeModel read() {
    const VolumeHead head = read_head();
    VolumeLevel level;
    level.lattice = {{head.posts[0], head.posts[1], head.posts[2]},
                     head.spacing_m,
                     {head.corner_m[0], head.corner_m[1], head.corner_m[2]}};
    level.unit_per_m = head.unit_per_m;
    check_sizes(head, level);
    level.places = unpacked<std::uint32_t>(head.places, "the places of bricks");
    level.posts = unpacked<std::uint8_t>(head.bricks, "the posts");
    if (!rest_.empty()) throw fault("the end", "bytes follow");
    try {
      return VolumeModel(std::move(level), {head.colour[0], head.colour[1], head.colour[2], 255});
    } catch (const std::invalid_argument& error) {
      throw fault("the end", error.what());
    }
  }

 private:
  vpe::base::FileError fault(const std::string& place, const std::string& reason) const {
    return vpe::base::file_error(
        "read", name_, place + ", before byte " + std::to_string(size_ - rest_.size()) + ": " + reason,
        "make the file again with 'vpe object'");
  }

  std::span<const std::uint8_t> take(std::uint64_t size, const std::string& place) {
    if (size > rest_.size()) throw fault(place, "the file ends early");
    const std::span<const std::uint8_t> taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }

  VolumeHead read_head() {
    VolumeHead head;
    std::uint64_t checksum = 0;
    std::memcpy(&head, take(sizeof(head), "the head").data(), sizeof(head));
    if (head.magic != kVolumeMagic) throw fault("the head", "it is not a file of a volume");
    if (head.version != kVolumeVersion)
      throw fault("the head", "version " + std::to_string(head.version) + " is not known here");
    std::memcpy(&checksum, take(sizeof(checksum), "the head").data(), sizeof(checksum));
    if (checksum != XXH3_64bits(&head, sizeof(head))) throw fault("the head", "its checksum is wrong");
    return head;
  }

  void check_sizes(const VolumeHead& head, const VolumeLevel& level) const {
    for (const std::int32_t side : head.posts) {
      if (side < 2 || side > VolumeLimits::kMostSide) throw fault("the head", "a side is out of range");
    }
    if (post_count(level.lattice) > VolumeLimits::kMostPosts) throw fault("the head", "it has too many posts");
    const std::size_t places = place_count(level.lattice);
    if (head.places.entries != places) throw fault("the head", "it has another number of places of bricks");
    if (head.bricks.entries > places * VolumeLevel::kBrickPosts)
      throw fault("the head", "it has too many bricks");
    if (head.places.entries * sizeof(std::uint32_t) + head.bricks.entries >
        VolumeFileLimits::kMostUnpacked_bytes)
      throw fault("the head", "the lists are too long");
  }

  template <class T>
  std::vector<T> unpacked(const PackedList& list, const std::string& place) {
    const std::span<const std::uint8_t> bytes = take(list.packed_bytes, place);
    if (XXH3_64bits(bytes.data(), bytes.size()) != list.checksum) throw fault(place, "their checksum is wrong");
    const std::uint64_t size = list.entries * sizeof(T);
    if (ZSTD_getFrameContentSize(bytes.data(), bytes.size()) != size ||
        ZSTD_findFrameCompressedSize(bytes.data(), bytes.size()) != bytes.size() ||
        size > bytes.size() * kMostPackedRatio)
      throw fault(place, "they are not packed as the head states");
    std::vector<T> values(list.entries);
    const std::size_t got = ZSTD_decompress(values.data(), size, bytes.data(), bytes.size());
    if (ZSTD_isError(got) != 0U) throw fault(place, std::string("zstd: ") + ZSTD_getErrorName(got));
    if (got != size) throw fault(place, "they end early");
    return values;
  }

  const std::filesystem::path& name_;
  std::size_t size_;
  std::span<const std::uint8_t> rest_;
};

}  // namespace

std::vector<std::uint8_t> volume_bytes(const VolumeLevel& finest, Rgba colour,
                                       const std::filesystem::path& name) {
  if (finest.bytes() > VolumeFileLimits::kMostUnpacked_bytes) {
    throw vpe::base::file_error("write", name, "the volume takes " + std::to_string(finest.bytes()) + " bytes",
                                "make it from fewer voxels");
  }
  VolumeHead head;
  head.colour = {colour.r, colour.g, colour.b, 255};
  for (std::size_t k = 0; k < 3; ++k) {
    head.posts[k] = finest.lattice.posts[k];
    head.corner_m[k] = finest.lattice.corner_m[static_cast<int>(k)];
  }
  head.spacing_m = finest.lattice.spacing_m;
  head.unit_per_m = finest.unit_per_m;
  const std::vector<std::uint8_t> places = packed_list(finest.places, head.places, name);
  const std::vector<std::uint8_t> bricks = packed_list(finest.posts, head.bricks, name);
  std::vector<std::uint8_t> out(sizeof(head));
  std::memcpy(out.data(), &head, sizeof(head));
  const std::uint64_t checksum = XXH3_64bits(&head, sizeof(head));
  out.resize(sizeof(head) + sizeof(checksum));
  std::memcpy(out.data() + sizeof(head), &checksum, sizeof(checksum));
  out.insert(out.end(), places.begin(), places.end());
  out.insert(out.end(), bricks.begin(), bricks.end());
  return out;
}

void write_volume_file(const std::filesystem::path& path, const VolumeModel& model) {
  const std::vector<std::uint8_t> bytes = volume_bytes(model.levels().front(), model.colour(), path);
  vpe::base::write_file(path, bytes);
}

VolumeModel volume_of_bytes(std::span<const std::uint8_t> bytes, const std::filesystem::path& name) {
  return VolumeReader(bytes, name).read();
}

VolumeModel read_volume_file(const std::filesystem::path& path) {
  return volume_of_bytes(vpe::base::read_file(path, VolumeFileLimits::kMostFile_bytes), path);
}

bool is_volume_file(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kVolumeMagic.size() &&
         std::equal(kVolumeMagic.begin(), kVolumeMagic.end(), bytes.begin(),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

}  // namespace objects
