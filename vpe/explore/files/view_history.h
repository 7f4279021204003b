// Back and forward through views, as in a browser.
//
// A view is kept once it has rested; what was passed through on the way is not. Views that are nearly one stay
// one entry, which follows them. No clock: the caller says the time.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "vpe/explore/files/saved_view.h"

namespace vpe::explore {

struct ViewHistoryOptions {
  std::size_t capacity = 100;  // the oldest go first; at least 2
  double rest_s = 0.5;         // a view held this long is kept
  // Less than all of these from where an entry began is still that entry:
  double near_share = 0.1;  // of the height above ground there
  double near_deg = 5;      // of turning
  double near_zoom = 1.1;   // factor of the field of view
};

class ViewHistory {
 public:
  explicit ViewHistory(double radius_m, const ViewHistoryOptions& options = {});

  // Where the camera is. Call it for every frame that is drawn: an idle window need not call, rest is seen at the
  // next call. Times ascend, seconds. `height_m`: of the camera above the ground.
  void observe(double time_s, const SavedView& view, double height_m);

  // The view to fly to, or nothing at the end of the list. Where the camera is now is kept first, rested or not,
  // so that the other direction leads back to it. What is observed on the way there adds nothing unless it
  // rests elsewhere; asked again before it is there, it goes on from where it was going.
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
    Seen first;      // where it began: what counts for nearness, so that drifting does not go on for ever
    SavedView view;  // where it was left
  };
  bool near(const Entry& entry, const SavedView& view) const;
  void keep(const Seen& seen);
  std::optional<SavedView> go(std::size_t index);
  bool elsewhere() const;  // than the current entry, and not on the way to it

  double radius_m_;
  ViewHistoryOptions options_;
  std::deque<Entry> entries_;
  std::size_t current_ = 0;
  std::optional<Seen> last_;  // observed
  bool on_the_way_ = false;   // to the current entry
};

}  // namespace vpe::explore
