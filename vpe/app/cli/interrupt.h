// SIGINT and SIGTERM as a condition that long work checks.
#pragma once

#include <stdexcept>
#include <string>

namespace vpe::app {

// Ends the program with the exit code of the signal.
class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(int signal, const std::string& what = "stopped")
      : std::runtime_error(what), signal_(signal) {}
  int signal() const { return signal_; }

 private:
  int signal_;
};

// Records SIGINT and SIGTERM instead of ending the process, as long as it lives. Guards may nest. Only the main
// thread makes guards; any thread may check.
//
// Typical usage:
//   const InterruptGuard guard;
//   for (const Item& item : items) {
//     InterruptGuard::check();
//     process(item);
//   }
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  // Throws Interrupted once a signal has come.
  static void check();
  // Returns the signal that has come, 0 for none.
  static int pending();

 private:
  using Handler = void (*)(int);
  Handler interrupt_;  // the handlers before this guard
  Handler terminate_;
};

}  // namespace vpe::app
