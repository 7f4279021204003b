#include "vpe/window/workers/job.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace vpe::window {

std::string JobList::start(Order order) {
  if (!start_) return "nothing can be made here";
  try {
    Entry entry{std::move(order), nullptr, {}};
    entry.job = start_(entry.order.words);
    entry.state = entry.job->state();
    entries_.push_back(std::move(entry));
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}

std::vector<std::size_t> JobList::update() {
  std::vector<std::size_t> ended;
  for (std::size_t n = 0; n < entries_.size(); ++n) {
    Entry& entry = entries_[n];
    if (entry.job == nullptr) continue;
    entry.state = entry.job->state();
    if (entry.state.is_running) continue;
    entry.job.reset();
    ended.push_back(n);
  }
  return ended;
}

void JobList::stop(std::size_t index) {
  Entry& entry = entries_.at(index);
  if (entry.job == nullptr) return;
  entry.is_stopped = true;
  entry.job->stop();
}

void JobList::remove(std::size_t index) {
  entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(index));
}

bool JobList::is_running() const {
  return std::any_of(entries_.begin(), entries_.end(), [](const Entry& e) { return e.job != nullptr; });
}

}  // namespace vpe::window
