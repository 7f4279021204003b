// The header of a PLY file: which elements follow, of which numbers.
//
// Typical usage:
//   const PlyHeader header = parse_ply_header(text);
//   const std::string_view numbers = text.substr(header.bytes);
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace objects {

inline constexpr std::uint64_t kMostPlyListEntries = 1'000'000;

enum class PlyFormat : std::uint8_t { kText, kLittleEndian, kBigEndian };

enum class PlyType : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

// Returns the size of a number. Pure.
std::size_t bytes_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  // of a list

  // Returns the fewest bytes that a binary file has for it.
  std::size_t least_bytes() const { return bytes_of(is_list ? count_type : type); }
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kText;
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;  // up to the first number
};

// Returns the header at the beginning of a text. Throws Refusal unless it is whole and its format, types and counts
// are known ones; counts up to MeshLimits::kMostVertices are.
PlyHeader parse_ply_header(std::string_view text);

// Returns the whole number that a word of a PLY is. Throws Refusal for anything else and for more than `most`.
std::uint64_t ply_count(std::string_view word, std::uint64_t most);

}  // namespace objects
