// Draws images on a thread of its own, so that a window can limit how long it waits for them.
#pragma once

#include <functional>
#include <optional>

#include "vpe/base/latest_worker.h"
#include "vpe/window/workers/painter.h"

namespace vpe::window {

// Keeps at most one request waiting; a later request replaces it. A request that has begun is finished. Errors
// are returned in DrawnImage::error; nothing is thrown across threads. For one calling thread at a time.
//
// Typical usage, in each iteration of the event loop:
//   if (maker.is_idle()) maker.request(next_request());
//   if (const auto drawn = maker.take(0.1)) show(*drawn);
class ImageMaker {
 public:
  // Creates the painter on the maker's thread, at the first request. Calls `notify` on that thread when an
  // image is finished.
  ImageMaker(MakePainter make_painter, std::function<void()> notify);

  void request(ImageRequest request) { worker_.request(std::move(request)); }
  // Returns true if no request waits or runs, and no image can be taken.
  bool is_idle() const { return worker_.is_idle(); }
  // Returns the image finished last, once. Waits for at most `wait_s` seconds if there is none yet but one is
  // being drawn.
  std::optional<DrawnImage> take(double wait_s = 0) { return worker_.take(wait_s); }

 private:
  base::LatestWorker<ImageRequest, DrawnImage> worker_;
};

}  // namespace vpe::window
