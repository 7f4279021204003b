#include "vpe/window/ui/driver_lock.h"

#include <atomic>

namespace vpe::window {
namespace {

std::mutex driver;
std::atomic<bool> is_kept_apart{false};

}  // namespace

DriverLock::DriverLock() : lock_(driver, std::defer_lock) {
  if (is_kept_apart) lock_.lock();
}

void DriverLock::keep_apart(bool on) { is_kept_apart = on; }

}  // namespace vpe::window
