// What is wrong with a panorama's metadata.
#pragma once

#include <stdexcept>

namespace panorama {

// Says what is wrong and what to do, without the name of a file: who reads files adds it (vpe/core/file.h).
class MetadataError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace panorama
