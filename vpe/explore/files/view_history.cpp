#include "vpe/explore/files/view_history.h"

#include <algorithm>
#include <limits>

namespace vpe::explore {

ViewHistory::ViewHistory(double radius_m, const ViewHistoryOptions& options)
    : radius_m_(radius_m), options_(options) {
  options_.capacity = std::max<std::size_t>(options_.capacity, 2);
}

bool ViewHistory::near(const Entry& entry, const SavedView& view) const {
  const ViewDifference d = difference(entry.first.view, view, radius_m_);
  return d.distance_m < options_.near_share * std::max(entry.first.height_m, 1.0) &&
         d.rotation_deg < options_.near_deg && d.zoom < options_.near_zoom;
}

void ViewHistory::keep(const Seen& seen) {
  if (!entries_.empty() && near(entries_[current_], seen.view)) {
    entries_[current_].view = seen.view;
    return;
  }
  if (!entries_.empty()) entries_.resize(current_ + 1);
  entries_.push_back({seen, seen.view});
  if (entries_.size() > options_.capacity) entries_.pop_front();
  current_ = entries_.size() - 1;
}

void ViewHistory::observe(double time_s, const SavedView& view, double height_m) {
  if (last_ && same(last_->view, view)) return;
  if (last_ && (entries_.empty() || time_s - last_->since_s >= options_.rest_s)) {
    keep(*last_);
    on_the_way_ = false;
  }
  if (on_the_way_ && near(entries_[current_], view)) on_the_way_ = false;
  last_ = Seen{view, height_m, time_s};
}

bool ViewHistory::elsewhere() const {
  return !entries_.empty() && !on_the_way_ && last_ && !near(entries_[current_], last_->view);
}

bool ViewHistory::can_go_back() const { return current_ > 0 || elsewhere(); }

bool ViewHistory::can_go_forward() const { return current_ + 1 < entries_.size() && !elsewhere(); }

std::optional<SavedView> ViewHistory::go(std::size_t index) {
  current_ = index;
  on_the_way_ = true;
  // The last observed view does not count as resting any more.
  last_->since_s = std::numeric_limits<double>::infinity();
  return entries_[current_].view;
}

std::optional<SavedView> ViewHistory::back() {
  if (!can_go_back()) return std::nullopt;
  if (!on_the_way_) keep(*last_);
  return go(current_ - 1);
}

std::optional<SavedView> ViewHistory::forward() {
  if (!can_go_forward()) return std::nullopt;
  if (!on_the_way_) keep(*last_);
  return go(current_ + 1);
}

}  // namespace vpe::explore
