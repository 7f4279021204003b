// Who makes the images that a window shows. The window says what; how is the backends' business.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "vpe/core/frame.h"
#include "vpe/core/image/image.h"
#include "vpe/core/stereo.h"

namespace vpe::window {

enum class Backend : std::uint8_t { kPolygons, kRays };

// "polygon", "voxel", as on the command line.
const char* to_string(Backend backend);

struct ImageRequest {
  std::uint64_t number = 0;  // of orders of one window; later ones are larger
  Backend backend = Backend::kPolygons;
  core::DrawRequest request;
  std::optional<core::StereoLayout> stereo;
  double eye_base_m = 0;           // with stereo; > 0
  double flight_time_s = 0;        // for the overlay of that name
  std::optional<double> logged_s;  // its time in the log, while one is written
};

// What became of an order.
struct DrawnImage {
  ImageRequest order;
  core::RgbImage image;     // of another size than the view's in stereo; empty after an error
  core::DrawResult result;  // without its pixels; of the left eye in stereo
  double seconds = 0;
  std::string error;  // empty when all went well
};

// Used by one thread, on which it was made.
class Painter {
 public:
  virtual ~Painter() = default;
  // Throws what renderers throw.
  virtual DrawnImage paint(const ImageRequest& order) = 0;
};

using MakePainter = std::function<std::unique_ptr<Painter>()>;

}  // namespace vpe::window
