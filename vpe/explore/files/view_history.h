// Back and forward through views, as in a web browser.
//
// A view is stored once it has rested; views passed on the way are not. Views that are close together share one
// entry, which follows them. The history has no clock: the caller passes the time.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "vpe/explore/files/saved_view.h"

namespace vpe::explore {

struct ViewHistoryOptions {
  std::size_t capacity = 100;  // the oldest go first; at least 2
  double rest_s = 0.5;  // Smaller: more views are stored; larger: only views that were looked at for longer.
  // A view that differs from the beginning of an entry by less than all of these belongs to the entry:
  double near_share = 0.1;  // distance, as a share of the height above ground there
  double near_deg = 5;      // rotation
  double near_zoom = 1.1;   // factor of the field of view
};

// Stores views. For one thread at a time.
//
// Typical usage:
//   history.observe(time_s, view, height_m);               // for each image
//   if (const auto view = history.back()) session.go(view->pose);
class ViewHistory {
 public:
  explicit ViewHistory(double radius_m, const ViewHistoryOptions& options = {});

  // Records the present view. Call it for every image that is drawn; an idle window need not call it. Times
  // ascend, seconds. `height_m` is the height of the camera above the ground.
  void observe(double time_s, const SavedView& view, double height_m);

  // Return the view to fly to, or nullopt at the end of the list. The present view is stored first, even if it
  // has not rested, so that the other direction returns to it. Views observed on the way are not stored, unless
  // the camera rests elsewhere. A second call before arrival continues from the view that the first one
  // returned.
  std::optional<SavedView> back();
  std::optional<SavedView> forward();
  bool can_go_back() const;
  bool can_go_forward() const;

  std::size_t size() const { return entries_.size(); }

 private:
  struct Seen {
    SavedView view;
    double height_m = 0;
    double since_s = 0;
  };
  struct Entry {
    Seen first;      // nearness is measured from here, so that slow drift makes new entries
    SavedView view;  // the last view of the entry
  };
  bool near(const Entry& entry, const SavedView& view) const;
  void keep(const Seen& seen);
  std::optional<SavedView> go(std::size_t index);
  bool elsewhere() const;  // away from the current entry, and not on the way to it

  double radius_m_;
  ViewHistoryOptions options_;
  std::deque<Entry> entries_;
  std::size_t current_ = 0;
  std::optional<Seen> last_;  // observed
  bool on_the_way_ = false;   // to the current entry
};

}  // namespace vpe::explore
