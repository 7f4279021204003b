// What is wrong with a panorama's metadata.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace panorama {

// Says what is wrong and what to do, without the name of a file: who reads files adds it (vpe/base/file.h).
class MetadataError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What a file says, for a message: as much of its start as a message may have, in whole characters of UTF-8.
std::string excerpt(std::string_view text, std::size_t max_bytes = 80);

}  // namespace panorama
