#include "vpe/window/workers/image_maker.h"

#include <chrono>
#include <exception>
#include <memory>
#include <utility>

namespace vpe::window {

ImageMaker::ImageMaker(MakePainter make_painter, std::function<void()> notify)
    : worker_(
          [make_painter = std::move(make_painter),
           painter = std::unique_ptr<Painter>()](ImageRequest request) mutable {
            DrawnImage drawn;
            const auto begun = std::chrono::steady_clock::now();
            try {
              if (painter == nullptr) painter = make_painter();
              drawn = painter->paint(request);
            } catch (const std::exception& e) {
              drawn.error = e.what();
            }
            drawn.request = std::move(request);
            drawn.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
            return drawn;
          },
          std::move(notify)) {}

}  // namespace vpe::window
