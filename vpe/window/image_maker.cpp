#include "vpe/window/image_maker.h"

#include <chrono>
#include <exception>
#include <utility>

namespace vpe::window {

const char* to_string(Backend backend) { return backend == Backend::kRays ? "voxel" : "polygon"; }

ImageMaker::ImageMaker(MakePainter make_painter, std::function<void()> tell)
    : make_painter_(std::move(make_painter)), tell_(std::move(tell)), thread_([this] { run(); }) {}

ImageMaker::~ImageMaker() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void ImageMaker::ask(ImageRequest order) {
  {
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(order);
  }
  changed_.notify_all();
}

bool ImageMaker::is_idle() const {
  const std::lock_guard lock(mutex_);
  return !waiting_ && !is_busy_ && !finished_;
}

std::optional<DrawnImage> ImageMaker::take(double wait_s) {
  std::unique_lock lock(mutex_);
  if (wait_s > 0 && !finished_ && (waiting_ || is_busy_))
    changed_.wait_for(lock, std::chrono::duration<double>(wait_s), [this] { return finished_.has_value(); });
  return std::exchange(finished_, std::nullopt);
}

void ImageMaker::run() {
  std::unique_ptr<Painter> painter;
  while (true) {
    ImageRequest order;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return waiting_ || ends_; });
      if (ends_) return;
      order = std::move(*waiting_);
      waiting_.reset();
      is_busy_ = true;
    }
    DrawnImage image;
    const auto begun = std::chrono::steady_clock::now();
    try {
      if (painter == nullptr) painter = make_painter_();
      image = painter->paint(order);
    } catch (const std::exception& e) {
      image.error = e.what();
    }
    image.order = std::move(order);
    image.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    {
      const std::lock_guard lock(mutex_);
      finished_ = std::move(image);
      is_busy_ = false;
    }
    changed_.notify_all();
    if (tell_) tell_();
  }
}

}  // namespace vpe::window
