// The numbers of a PLY file, one element after another. The file is read in pieces and never all in memory.
//
// Typical usage:
//   PlyValues values("cloud.ply");
//   std::vector<double> numbers;
//   for (const PlyElement& element : values.header().elements)
//     for (std::uint64_t n = 0; n < element.count; ++n) values.next(element, numbers);
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "objects/reader/ply_header.h"

namespace objects {

class PlyValues {
 public:
  // Opens a file and reads its header. Throws Refusal for a file that cannot be read or has a damaged header.
  explicit PlyValues(const std::filesystem::path& path);

  const PlyHeader& header() const { return header_; }
  // Throws Refusal unless the file is so long that it may hold as many elements of this kind as the header claims.
  // Call it before memory is allocated for them.
  void check_size(const PlyElement& element) const;

  // Reads the next element. Its kind must be that which the header has at this place. `values` gets a number for each
  // property, NaN for a list. Throws Refusal where the file ends early, a word is no number, and a list or line is too
  // long.
  void next(const PlyElement& element, std::vector<double>& values);

 private:
  void next_text(const PlyElement& element, std::vector<double>& values);
  void next_binary(const PlyElement& element, std::vector<double>& values);
  double number(PlyType type);
  // Makes `bytes` more bytes available, fewer only at the end of the file. Returns all that are.
  std::string_view ahead(std::size_t bytes);

  std::ifstream file_;
  std::uint64_t file_bytes_ = 0;
  std::vector<char> piece_;
  std::size_t at_ = 0;   // in the piece
  std::size_t end_ = 0;  // of what the piece holds
  PlyHeader header_;
};

}  // namespace objects
