// Makes images on a thread of its own, so that a window never waits for one longer than it wants to.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "vpe/window/painter.h"

namespace vpe::window {

// One thread at a time calls. An order that is not begun is replaced by a later one; one that is begun is
// finished. Errors come as images: nothing is thrown across threads.
class ImageMaker {
 public:
  // The painter is made on the maker's thread, at the first order. `tell`: called on that thread when an image
  // is finished.
  ImageMaker(MakePainter make_painter, std::function<void()> tell);
  ~ImageMaker();  // waits for the image that is begun
  ImageMaker(const ImageMaker&) = delete;
  ImageMaker& operator=(const ImageMaker&) = delete;

  void ask(ImageRequest order);
  // Neither begun nor waiting nor finished and not taken.
  bool is_idle() const;
  // The image finished last, once. Waits for at most so long when there is none but one is on its way.
  std::optional<DrawnImage> take(double wait_s = 0);

 private:
  void run();

  MakePainter make_painter_;
  std::function<void()> tell_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<ImageRequest> waiting_;
  std::optional<DrawnImage> finished_;
  bool is_busy_ = false;
  bool ends_ = false;
  std::thread thread_;  // last: uses all of the above
};

}  // namespace vpe::window
