// SIGINT and SIGTERM as something that long work can ask about.
#pragma once

#include <stdexcept>
#include <string>

namespace vpe::app {

class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(int signal, const std::string& what = "stopped")
      : std::runtime_error(what), signal_(signal) {}
  int signal() const { return signal_; }

 private:
  int signal_;
};

// While one lives, SIGINT and SIGTERM are only noted; check() then throws Interrupted. Any thread may check.
// Guards may nest; the main thread makes them.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static void check();

 private:
  using Handler = void (*)(int);
  Handler interrupt_;  // what was there before
  Handler terminate_;
};

}  // namespace vpe::app
