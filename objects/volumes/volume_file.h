// Files of semi-transparent models (*.volume).
//
// A file has a head: "VPEVOLUM", the version, the colour, the lattice, the extinction of a stored 1, and for each of two
// lists the number of entries, the packed size and a checksum of the packed bytes; then a checksum of the head. The lists
// follow, each a zstd frame: places of bricks, and posts. Only the finest level is stored. Numbers are little-endian.
// Checksums are XXH3 of 64 bits.
//
// Typical usage:
//   write_volume_file("devil.volume", model);
//   const VolumeModel again = read_volume_file("devil.volume");
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "objects/volumes/volume_model.h"

namespace objects {

// Gives limits that both directions enforce, beside VolumeLimits.
struct VolumeFileLimits {
  static constexpr std::uint64_t kMostUnpacked_bytes = std::uint64_t{1} << 28;  // of both lists together
  static constexpr std::uint64_t kMostFile_bytes = std::uint64_t{1} << 28;
};

// Writes a model. The same model gives the same bytes. Throws vpe::base::FileError, also for a model beyond the limits.
void write_volume_file(const std::filesystem::path& path, const VolumeModel& model);

// Reads a model. Compares all sizes with the limits, and with what the packed bytes can hold, before it allocates. Throws
// vpe::base::FileError, which names the file, the place and what is wrong there.
VolumeModel read_volume_file(const std::filesystem::path& path);

// Do the same in memory; `name` is the file's in messages. is_volume_file() says whether bytes begin as such a file does.
std::vector<std::uint8_t> volume_bytes(const VolumeLevel& finest, Rgba colour,
                                       const std::filesystem::path& name);
VolumeModel volume_of_bytes(std::span<const std::uint8_t> bytes, const std::filesystem::path& name);
bool is_volume_file(std::span<const std::uint8_t> bytes);

}  // namespace objects
