// Computes profiles and lines of sight on a thread of its own, since they may take seconds.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vpe/base/latest_worker.h"
#include "vpe/explore/measure/line_of_sight.h"
#include "vpe/explore/measure/profile.h"
#include "vpe/explore/measure/sight_scene.h"
#include "vpe/explore/results/ground_along.h"

namespace vpe::window {

// Holds the points of a path, the heights above the ground of its two ends, and what may stand between them.
struct MeasureRequest {
  std::vector<mars::LonLat> places;
  double from_height_m = 0;
  double to_height_m = 0;
  explore::SightScene scene = {};
};

struct Measured {
  std::uint64_t number = 0;  // returned by Measurer::request()
  MeasureRequest request;
  std::shared_ptr<const explore::Profile> profile;  // null after an error
  explore::GroundAlong ground;                      // at the points of the profile
  std::optional<explore::LineOfSight> sight;        // between the first and the last place
  bool moves = false;  // objects of the scene do: at other times the sight may be another
  std::string error;
};

// Keeps at most one request waiting. For one calling thread at a time.
//
// Typical usage:
//   const std::uint64_t number = measurer.request({places, 2, 0});
//   if (auto measured = measurer.take(); measured && measured->number == number) show(*measured);
class Measurer {
 public:
  // Calls `notify` on the thread when a request is finished. It must not throw. Calls `open_scene` on the thread, for
  // requests with a scene; empty: objects do not count.
  Measurer(std::shared_ptr<const paging::Surface> surface, std::function<void()> notify,
           explore::OpenScene open_scene = {});

  // Replaces a request that has not begun. Returns the request's number, larger than all before.
  std::uint64_t request(MeasureRequest request);
  // Drops a request that has not begun, and a result that was not taken.
  void forget() { worker_.forget(); }
  // Returns the latest result, once.
  std::optional<Measured> take() { return worker_.take(); }
  // Returns true if no request waits or runs, and no result can be taken.
  bool is_idle() const { return worker_.is_idle(); }

 private:
  Measured measure(std::uint64_t number, const MeasureRequest& request);

  std::shared_ptr<const paging::Surface> surface_;
  explore::OpenScene open_scene_;
  Measured last_;  // for the thread alone: its profile is reused if the places are the same
  std::uint64_t requested_ = 0;
  base::LatestWorker<std::pair<std::uint64_t, MeasureRequest>, Measured> worker_;  // last: it uses the rest
};

}  // namespace vpe::window
