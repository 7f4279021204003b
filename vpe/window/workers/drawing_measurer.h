// Measures drawings on a thread of its own, since areas on the surface may take seconds.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "vpe/base/latest_worker.h"
#include "vpe/explore/drawing/drawing_measures.h"
#include "vpe/explore/drawing/drawings.h"
#include "vpe/explore/results/ground_along.h"

namespace vpe::window {

struct MeasuredDrawing {
  explore::Drawings::Shared drawing;
  explore::SphereMeasures sphere;
  std::optional<explore::GroundMeasures> ground;  // nullopt after an error
  explore::GroundAlong along;                     // at the point, or along line or outline
  std::string error;
};

// Measures the drawing that was asked for last. For one calling thread at a time.
//
// Typical usage, in each frame:
//   measurer.request(drawing);                 // does nothing if it is the same
//   if (const MeasuredDrawing* m = measurer.measured()) show(*m);
class DrawingMeasurer {
 public:
  // Calls `notify` on the thread when a drawing is measured, and now and then as progress() grows. It must not
  // throw.
  DrawingMeasurer(std::shared_ptr<const paging::Surface> surface, std::function<void()> notify);
  // Stops what is measured.
  ~DrawingMeasurer() { stop_.request_stop(); }

  // Measures a drawing; null: none. What is measured now is stopped, if it is another.
  void request(explore::Drawings::Shared drawing);
  // Returns the measures of the drawing that was requested last, or null if they are not finished.
  const MeasuredDrawing* measured();
  // Returns which share of the present drawing is measured, 0 to 1.
  double progress() const { return progress_; }
  bool is_idle() const { return worker_.is_idle(); }

 private:
  struct Request {
    explore::Drawings::Shared drawing;
    std::stop_token stop;
  };
  std::optional<MeasuredDrawing> measure(const Request& request);

  std::shared_ptr<const paging::Surface> surface_;
  std::function<void()> notify_;
  std::stop_source stop_;
  explore::Drawings::Shared wanted_;
  std::optional<MeasuredDrawing> measured_;
  std::atomic<double> progress_{0};
  base::LatestWorker<Request, MeasuredDrawing> worker_;  // last: it uses the rest
};

}  // namespace vpe::window
