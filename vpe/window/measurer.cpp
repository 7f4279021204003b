#include "vpe/window/measurer.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace vpe::window {

namespace {

bool is_same_way(const std::vector<mars::LonLat>& a, const std::vector<mars::LonLat>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](mars::LonLat p, mars::LonLat q) {
    return p.lon_deg == q.lon_deg && p.lat_deg == q.lat_deg;
  });
}

}  // namespace

Measurer::Measurer(std::shared_ptr<const paging::Surface> surface, std::function<void()> tell)
    : surface_(std::move(surface)), tell_(std::move(tell)), thread_([this] { run(); }) {}

Measurer::~Measurer() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::uint64_t Measurer::ask(MeasureRequest order) {
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    number = ++asked_;
    waiting_.emplace(number, std::move(order));
  }
  changed_.notify_all();
  return number;
}

void Measurer::forget() {
  const std::lock_guard lock(mutex_);
  waiting_.reset();
  finished_.reset();
}

std::optional<Measured> Measurer::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(finished_, std::nullopt);
}

bool Measurer::is_at_rest() const {
  const std::lock_guard lock(mutex_);
  return !waiting_ && !is_busy_ && !finished_;
}

void Measurer::run() {
  while (true) {
    std::pair<std::uint64_t, MeasureRequest> next;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return waiting_ || ends_; });
      if (ends_) return;
      next = std::move(*waiting_);
      waiting_.reset();
      is_busy_ = true;
    }
    Measured measured = measure(next.first, next.second);
    {
      const std::lock_guard lock(mutex_);
      is_busy_ = false;
      finished_ = std::move(measured);
    }
    tell_();
  }
}

Measured Measurer::measure(std::uint64_t number, const MeasureRequest& order) {
  Measured out;
  out.number = number;
  out.order = order;
  try {
    if (last_.profile != nullptr && is_same_way(last_.order.places, order.places))
      out.profile = last_.profile;
    else
      out.profile = std::make_shared<const explore::Profile>(explore::make_profile(*surface_, order.places));
    out.sight = explore::line_of_sight(*surface_, {order.places.front(), order.from_height_m},
                                       {order.places.back(), order.to_height_m});
  } catch (const std::exception& e) {
    out.trouble = e.what();
  }
  last_ = out;
  return out;
}

}  // namespace vpe::window
