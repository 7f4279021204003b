// Keeps threads apart in a driver of OpenGL that cannot have two contexts of one display at work at once.
//
// Before it reads, fills or shows an image, Mesa's llvmpipe (22.3) looks without a lock through what other contexts of the display have
// yet to draw. So a window's frame may crash while a painter draws in a context of the same display. Drivers of GPUs can do it.
#pragma once

#include <mutex>

namespace vpe::window {

// Has the driver to itself while it lives, where threads are kept apart; else does nothing. Any thread may make one, one at a time.
//
// Typical usage:
//   const DriverLock lock;
//   glfwSwapBuffers(window);
class DriverLock {
 public:
  DriverLock();

  // Keeps threads apart from now on, or no longer. May be called while none of them uses the driver but the caller's.
  static void keep_apart(bool on);
  bool is_held() const { return lock_.owns_lock(); }

 private:
  std::unique_lock<std::mutex> lock_;
};

}  // namespace vpe::window
