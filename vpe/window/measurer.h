// Profiles and lines of sight, made on a thread of their own: they may take seconds.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "vpe/explore/measure/line_of_sight.h"
#include "vpe/explore/measure/profile.h"

namespace vpe::window {

// Points of a way and how high above the ground its ends look from.
struct MeasureRequest {
  std::vector<mars::LonLat> places;
  double from_height_m = 0;
  double to_height_m = 0;
};

struct Measured {
  std::uint64_t number = 0;  // of the order
  MeasureRequest order;
  std::shared_ptr<const explore::Profile> profile;  // null: trouble says why
  std::optional<explore::LineOfSight> sight;        // between the first and the last place
  std::string trouble;
};

// One caller at a time.
class Measurer {
 public:
  // `tell` is called on the thread when something is finished. It must not throw.
  Measurer(std::shared_ptr<const paging::Surface> surface, std::function<void()> tell);
  // Waits for what is being measured.
  ~Measurer();
  Measurer(const Measurer&) = delete;
  Measurer& operator=(const Measurer&) = delete;

  // In place of what has not begun. The number of the order, larger than all before.
  std::uint64_t ask(MeasureRequest order);
  // Drops what has not begun and what is finished.
  void forget();
  // What is finished, once.
  std::optional<Measured> take();
  // Nothing waits, is being measured or is to be taken.
  bool is_at_rest() const;

 private:
  void run();
  Measured measure(std::uint64_t number, const MeasureRequest& order);

  std::shared_ptr<const paging::Surface> surface_;
  std::function<void()> tell_;
  Measured last_;  // the thread's own: a profile that still holds is not made again
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t asked_ = 0;
  std::optional<std::pair<std::uint64_t, MeasureRequest>> waiting_;
  std::optional<Measured> finished_;
  bool is_busy_ = false;
  bool ends_ = false;
  std::thread thread_;  // last: it uses the rest
};

}  // namespace vpe::window
