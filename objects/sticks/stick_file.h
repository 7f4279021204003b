// Files of models of sticks (*.sticks).
//
// A file has a head: "VPESTICK", the version, the number of levels and a checksum of these. A level follows the
// other: a head with the grid, for each list the number of entries, the packed size and a checksum of the packed
// bytes, and a checksum of all that; then the four lists, each a zstd frame: columns, sticks, runs, voxels. Numbers
// are little-endian. Checksums are XXH3 of 64 bits.
//
// Typical usage:
//   write_stick_file("rover.sticks", model);
//   const StickModel again = read_stick_file("rover.sticks");
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "objects/sticks/stick_model.h"

namespace objects {

// Limits that both functions enforce.
struct StickFileLimits {
  static constexpr std::uint32_t kMostLevels = 16;
  static constexpr std::uint64_t kMostUnpacked_bytes = std::uint64_t{1} << 29;  // of all lists together
  static constexpr std::uint64_t kMostFile_bytes = std::uint64_t{1} << 30;
};

// Writes a model. The same model gives the same bytes. Throws vpe::base::FileError, also for a model beyond the
// limits.
void write_stick_file(const std::filesystem::path& path, const StickModel& model);

// Reads a model. Compares all sizes with the limits, and with what the packed bytes can hold, before it allocates.
// Throws vpe::base::FileError, which names the file, the place and what is wrong there.
StickModel read_stick_file(const std::filesystem::path& path);

}  // namespace objects
