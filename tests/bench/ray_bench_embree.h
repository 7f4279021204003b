// Casts range images by Embree in its fastest modes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "vpe/app/report/embree_scene.h"
#include "vpe/base/parallel.h"
#include "vpe/core/view.h"

namespace bench {

// Selects the function of Embree that casts.
enum class EmbreeMode {
  kPacket16,  // rtcIntersect16, 4x4 pixels
  kPacket8,   // rtcIntersect8, 4x2 pixels
  kStream,    // rtcIntersectNM, 8x8 pixels as four packets of 4x4
  kStream1,   // rtcIntersect1M, 8x8 single rays
};
inline constexpr std::array kEmbreeModes{EmbreeMode::kPacket16, EmbreeMode::kPacket8, EmbreeMode::kStream,
                                         EmbreeMode::kStream1};

// Returns the name of a mode for labels.
const char* name(EmbreeMode mode);

// Holds the rays of a view. The ray of pixel (x, y) goes along column[x] + tangent[y] * up, of length
// sqrt(column_length2[x] + tangent[y]^2). Tables are padded to whole blocks by the last column and row.
struct RayTables {
  int width = 0;
  int height = 0;
  std::vector<float> column_x, column_y, column_z, column_length2;
  std::vector<float> tangent;
  float up_x = 0, up_y = 0, up_z = 0;
};

// Casts a perspective or cylindrical view of which all is drawn. Rays are made from tables by three products
// each. All are coherent (RTC_INTERSECT_CONTEXT_FLAG_COHERENT), threads of the pool take rows of 8x8 pixels,
// and denormals are off as Embree recommends.
class EmbreeImage {
 public:
  // Throws std::invalid_argument for equirectangular views and for parts of views.
  explicit EmbreeImage(const vpe::core::View& view);

  // Writes the range of every pixel, row by row, infinity for sky, and returns the seconds taken. Without a
  // scene (nullptr) does everything but Embree's own calls.
  double cast(RTCScene scene, EmbreeMode mode, vpe::base::ThreadPool& pool, std::span<float> range_m) const;

 private:
  RayTables tables_;
};

}  // namespace bench
