#include "vpe/app/cli/interrupt.h"

#include <atomic>
#include <csignal>

namespace vpe::app {

namespace {

std::atomic<int> g_signal{0};  // a signal handler reaches nothing but globals
static_assert(std::atomic<int>::is_always_lock_free);

void record(int signal) { g_signal.store(signal); }

}  // namespace

InterruptGuard::InterruptGuard()
    : interrupt_(std::signal(SIGINT, record)), terminate_(std::signal(SIGTERM, record)) {}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, interrupt_);
  std::signal(SIGTERM, terminate_);
}

int InterruptGuard::pending() { return g_signal.load(); }

void InterruptGuard::check() {
  if (const int signal = pending(); signal != 0) throw Interrupted(signal);
}

}  // namespace vpe::app
