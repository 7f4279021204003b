#pragma once

#include <stdexcept>

namespace vpe::explore {

// A device that cannot be used: what it is, the system's words, and what to do.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace vpe::explore
