#include <algorithm>
#include <glm/geometric.hpp>

#include "vpe/core/appearance/nodata_pattern.h"
#include "vpe/voxel/paint/nodata_stripes.h"
#include "vpe/voxel/paint/paint_job.h"

// Highway compiles this file once for each instruction set and selects the best one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/voxel/paint/paint_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "vpe/voxel/paint/paint_air-inl.h"
#include "vpe/voxel/paint/paint_ground-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel {
namespace HWY_NAMESPACE {

// Returns which pixels of a block are to be painted, as bits.
inline std::uint32_t wanted_bits(const PaintJob& job, int x, int y) {
  const int count = std::min(kBlock, job.width - x);
  const std::uint32_t all = count >= kBlock ? ~std::uint32_t{0} : (std::uint32_t{1} << count) - 1;
  if (job.wanted == nullptr) return all;
  const std::uint8_t* const wanted = job.wanted + static_cast<std::ptrdiff_t>(y) * job.width + x;
  std::uint32_t bits = 0;
  for (int i = 0; i < count; ++i) bits |= (wanted[i] != 0 ? 1U : 0U) << i;
  return bits;
}

inline HWY_NOINLINE void store_colours(const Block& block, base::Rgb* out, int count, std::uint32_t wanted) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const hn::Rebind<std::uint8_t, Floats> du;
  static_assert(sizeof(base::Rgb) == 3);
  std::uint8_t part[3 * kBlock];
  const bool is_whole = count == kBlock && wanted == ~std::uint32_t{0};
  std::uint8_t* const bytes = is_whole ? &out->r : part;
  const auto byte = [&](const float* x) HWY_ATTR {
    return hn::DemoteTo(du, hn::ConvertTo(di, hn::Add(clamp(d, hn::Load(d, x), 0, 255), hn::Set(d, 0.5F))));
  };
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d)))
    hn::StoreInterleaved3(byte(block.red + i), byte(block.green + i), byte(block.blue + i), du, bytes + 3 * i);
  if (is_whole) return;
  for (std::uint32_t left = wanted; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    std::copy_n(part + 3 * i, 3, &out[i].r);
  }
}

HWY_INLINE void begin(const PaintJob& job, PaintTiles& tiles, const PaintTile*& tile, int x, int y,
                      Block& block) {
  begin_block(job, tiles.max_level(), x, y, std::min(kBlock, job.width - x), block);
  if (block.ground != 0 && !job.by_point && !job.one_colour) locate(tiles, tile, block);
}

// Paints nodata ground: the image in stripes, or else in their mean. Requires colours of the ground.
inline HWY_NOINLINE void paint_nodata(const PaintJob& job, Block& block) {
  const bool of_image = paging::shows_image(job.shading->colour_source);
  for (std::uint32_t left = block.nodata; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    if (!of_image) {
      block.red[i] = block.green[i] = block.blue[i] = static_cast<float>(core::kNodataMean);
      continue;
    }
    const float tone = nodata_tone(job, block.x + i, block.y);
    // Without light and hue. paint_by_point() has left them out.
    const float* const image = block.texel[i];
    block.red[i] = tone * (job.by_point ? block.red[i] : image[0]);
    block.green[i] = tone * (job.by_point ? block.green[i] : image[1]);
    block.blue[i] = tone * (job.by_point ? block.blue[i] : image[2]);
  }
}

// Returns the number of nodata pixels.
HWY_INLINE int finish(const PaintJob& job, PaintTiles& tiles, Block& block) {
  const core::SettingsValues& settings = job.request->settings;
  if (block.ground != 0) {
    if (job.by_point) {
      paint_by_point(job, tiles, block);
    } else {
      paint_ground(job, block);
    }
  }
  if (block.nodata != 0) paint_nodata(job, block);
  const bool hazy = settings.haze_visibility_m > 0.0 && block.ground != 0;
  const bool sky = settings.background == core::Background::kSky && block.sky != 0;
  if (hazy || sky) ray_angles(job, block);
  if (hazy) paint_haze(job, settings.haze_visibility_m, block);
  if (sky) {
    paint_sky(job, block);
  } else if (block.sky != 0) {
    const float behind = settings.background == core::Background::kWhite ? 255.0F : 0.0F;
    for (int i = 0; i < kBlock; ++i) {
      if (block.is_sky[i] > 0.0F) block.red[i] = block.green[i] = block.blue[i] = behind;
    }
  }
  const std::uint32_t wanted = wanted_bits(job, block.x, block.y);
  store_colours(block, job.colour + static_cast<std::ptrdiff_t>(block.y) * job.width + block.x, block.count,
                wanted);
  return __builtin_popcount(block.nodata & wanted);
}

std::int64_t paint(const PaintJob& job, PaintTiles& tiles, int first_row, int end_row) {
  std::int64_t nodata_count = 0;
  const PaintTile* tile = nullptr;
  // Two blocks overlap, so that the memory of the later one arrives while the earlier one is finished.
  Block blocks[2];
  for (int y = first_row; y < end_row; ++y) {
    if (tiles.trim()) tile = nullptr;
    int n = 0;
    for (int x = 0; x < job.width; x += kBlock) {
      if (job.wanted != nullptr && wanted_bits(job, x, y) == 0) continue;
      begin(job, tiles, tile, x, y, blocks[n & 1]);
      if (n > 0) nodata_count += finish(job, tiles, blocks[(n - 1) & 1]);
      ++n;
    }
    if (n > 0) nodata_count += finish(job, tiles, blocks[(n - 1) & 1]);
  }
  return nodata_count;
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
