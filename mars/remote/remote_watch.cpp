#include "mars/remote/remote_watch.h"

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

namespace mars {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPeriod{200};

class Watcher {
 public:
  static Watcher& common() {
    static Watcher watcher;
    return watcher;
  }

  void set(RemoteWatch watch) {
    const std::lock_guard lock(mutex_);
    watch_ = watch ? std::make_shared<const RemoteWatch>(std::move(watch)) : nullptr;
    if (watch_ && !thread_.joinable())
      thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  int begin(std::string address) {
    const std::lock_guard lock(mutex_);
    waits_.emplace(++last_, std::pair{std::move(address), Clock::now()});
    if (watch_ && waits_.size() == 1) changed_.notify_all();
    return last_;
  }

  void end(int number) {
    const std::lock_guard lock(mutex_);
    waits_.erase(number);
  }

 private:
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      std::optional<RemoteWait> longest;
      std::shared_ptr<const RemoteWatch> watch;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, stop, [this] { return !waits_.empty(); });
        if (!waits_.empty()) {  // numbers rise, so the first is the oldest
          const auto& [number, wait] = *waits_.begin();
          longest = {number, wait.first, std::chrono::duration<double>(Clock::now() - wait.second).count()};
        }
        watch = watch_;
      }
      if (longest && watch) (*watch)(*longest);
      std::unique_lock lock(mutex_);
      asleep_.wait_for(lock, stop, kPeriod, [] { return false; });
    }
  }

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::condition_variable_any asleep_;
  std::map<int, std::pair<std::string, Clock::time_point>> waits_;
  int last_ = 0;
  std::shared_ptr<const RemoteWatch> watch_;
  std::jthread thread_;  // last, so that it ends first
};

}  // namespace

void set_remote_watch(RemoteWatch watch) { Watcher::common().set(std::move(watch)); }
int begin_remote_wait(std::string address) { return Watcher::common().begin(std::move(address)); }
void end_remote_wait(int number) { Watcher::common().end(number); }

}  // namespace mars
