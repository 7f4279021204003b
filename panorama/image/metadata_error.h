// The error that readers and writers of a panorama's metadata throw.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace panorama {

// Says what is wrong and what to do, without the name of a file; functions that read files add it
// (vpe/base/file.h).
class MetadataError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Returns the start of a text from a file for a message, cut to at most max_bytes in whole characters of UTF-8.
std::string excerpt(std::string_view text, std::size_t max_bytes = 80);

}  // namespace panorama
