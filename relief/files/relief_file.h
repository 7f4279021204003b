// Files of reliefs: what formulas change the ground of a planet, and where.
//
// A file `*.relief.toml` has these tables. Keys are those of relief_keys(); docs/guide/relief.md describes them.
//
//   version = 1
//   [[relief]]
//   name = "landing pad"
//   kind = "pad"
//   lon = 137.44
//   lat = -4.59
//   radius_m = 20
//   falloff_m = 8
//   [[relief]]
//   kind = "flood"
//   lon = 137.5
//   lat = -4.6
//   rise_m = 12
//   polygon = [[137.49, -4.61], [137.51, -4.61], [137.5, -4.59]]
//
// Typical usage:
//   const std::vector<ReliefSpec> reliefs = read_relief_file("pad.relief.toml");
//   write_relief_file(reliefs, "copy.relief.toml");   // has the same reliefs, numbers to the bit
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relief/spec.h"

namespace relief {

inline constexpr std::size_t kMostReliefFileBytes = std::size_t{64} << 20U;

// Return the reliefs of a file, and of a text that messages call `path`, in their order. At most kMostReliefs; names are
// unique. Throw std::runtime_error "FILE:LINE: what" for a text that is wrong, and vpe::base::FileError for a file that
// cannot be read.
std::vector<ReliefSpec> read_relief_file(const std::filesystem::path& path);
std::vector<ReliefSpec> parse_relief_toml(std::string_view text, const std::filesystem::path& path);

// Returns true for the names of files of reliefs: *.relief.toml.
bool is_relief_path(const std::filesystem::path& path);

// Returns the text of a file, from which parse_relief_toml() reads the same reliefs, numbers to the bit by the fewest
// digits. Keys with their usual values are left out. Throws std::invalid_argument for reliefs that no file can hold: with
// a problem_of(), of the same name, or more than kMostReliefs.
std::string to_toml(std::span<const ReliefSpec> reliefs);

// Replaces a file by the text of the reliefs at once. Throws what to_toml() throws, and vpe::base::FileError.
void write_relief_file(std::span<const ReliefSpec> reliefs, const std::filesystem::path& path);

}  // namespace relief
