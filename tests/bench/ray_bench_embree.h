// Range images by Embree, as fast as it goes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tests/voxel/embree_scene.h"
#include "vpe/base/parallel.h"
#include "vpe/core/view.h"

namespace bench {

enum class EmbreeMode {
  kPacket16,  // rtcIntersect16, 4x4 pixels
  kPacket8,   // rtcIntersect8, 4x2 pixels
  kStream,    // rtcIntersectNM, 8x8 pixels as four packets of 4x4
  kStream1,   // rtcIntersect1M, 8x8 single rays
};
inline constexpr std::array kEmbreeModes{EmbreeMode::kPacket16, EmbreeMode::kPacket8, EmbreeMode::kStream,
                                         EmbreeMode::kStream1};
const char* name(EmbreeMode mode);

// The rays of a view: that of pixel (x, y) goes along column[x] + tangent[y] * up, of length
// sqrt(column_length2[x] + tangent[y]^2). Padded to whole blocks by the last column and row.
struct RayTables {
  int width = 0;
  int height = 0;
  std::vector<float> column_x, column_y, column_z, column_length2;
  std::vector<float> tangent;
  float up_x = 0, up_y = 0, up_z = 0;
};

// A perspective or cylindrical view of which all is drawn. Rays are made of tables, three products each; all
// are coherent (RTC_INTERSECT_CONTEXT_FLAG_COHERENT), rows of 8x8 pixels are handed out to the pool's threads,
// denormals are off as Embree asks.
class EmbreeImage {
 public:
  explicit EmbreeImage(const vpe::core::View& view);

  // Range of every pixel, row by row, infinity for sky; returns seconds. Without a scene (nullptr) everything
  // but Embree's own calls is done.
  double cast(RTCScene scene, EmbreeMode mode, vpe::base::ThreadPool& pool, std::span<float> range_m) const;

 private:
  RayTables tables_;
};

}  // namespace bench
