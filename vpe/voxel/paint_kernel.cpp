#include <algorithm>
#include <glm/geometric.hpp>

#include "vpe/voxel/paint_job.h"

// Built once for each instruction set; the best one that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/voxel/paint_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "vpe/voxel/paint_air-inl.h"
#include "vpe/voxel/paint_ground-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel {
namespace HWY_NAMESPACE {

// Ground without data, the mean of the polygon backend's stripes.
constexpr float kGap = 105;

HWY_INLINE void store_colours(const Block& block, mars::Rgb* out, int count) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const hn::Rebind<std::uint8_t, Floats> du;
  static_assert(sizeof(mars::Rgb) == 3);
  std::uint8_t part[3 * kBlock];
  std::uint8_t* const bytes = count == kBlock ? &out->r : part;
  const auto byte = [&](const float* x) HWY_ATTR {
    return hn::DemoteTo(du, hn::ConvertTo(di, hn::Add(clamp(d, hn::Load(d, x), 0, 255), hn::Set(d, 0.5F))));
  };
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d)))
    hn::StoreInterleaved3(byte(block.red + i), byte(block.green + i), byte(block.blue + i), du, bytes + 3 * i);
  if (count < kBlock) std::copy_n(part, 3 * count, &out->r);
}

std::int64_t paint(const PaintJob& job, PaintTiles& tiles, int begin, int end) {
  const core::DrawRequest& request = *job.request;
  const bool sky = request.settings.background == core::Background::kSky;
  const float behind = request.settings.background == core::Background::kWhite ? 255.0F : 0.0F;
  const double visibility_m = request.settings.haze_visibility_m;
  std::int64_t without_data = 0;
  const PaintTile* tile = nullptr;
  Block block{};
  // Columns of blocks: neighbouring rows take the same tiles.
  for (int x = 0; x < job.width; x += kBlock) {
    const int count = std::min(kBlock, job.width - x);
    for (int y = begin; y < end; ++y) {
      begin_block(job, tiles.max_level(), x, y, count, block);
      std::uint32_t missing = 0;
      if (block.ground != 0)
        missing = job.by_point ? paint_by_point(job, tiles, block) : paint_ground(job, tiles, tile, block);
      for (std::uint32_t left = missing; left != 0; left &= left - 1) {
        const int i = __builtin_ctz(left);
        block.red[i] = block.green[i] = block.blue[i] = kGap;
        ++without_data;
      }
      const bool hazy = visibility_m > 0.0 && block.ground != 0;
      if (hazy || (sky && block.sky != 0)) ray_angles(job, block);
      if (hazy) paint_haze(job, visibility_m, block);
      if (block.sky != 0) {
        if (sky) {
          paint_sky(job, block);
        } else {
          for (int i = 0; i < kBlock; ++i) {
            if (block.is_sky[i] > 0.0F) block.red[i] = block.green[i] = block.blue[i] = behind;
          }
        }
      }
      store_colours(block, job.colour + static_cast<std::ptrdiff_t>(y) * job.width + x, count);
    }
  }
  return without_data;
}

}  // namespace HWY_NAMESPACE
}  // namespace vpe::voxel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::voxel {

HWY_EXPORT(paint);

std::int64_t paint_rows(const PaintJob& job, PaintTiles& tiles, int begin, int end) {
  return HWY_DYNAMIC_DISPATCH(paint)(job, tiles, begin, end);
}

}  // namespace vpe::voxel
#endif
