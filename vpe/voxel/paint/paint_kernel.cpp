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
#include "vpe/voxel/paint/paint_facets-inl.h"
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

// Holds the squares that a row's blocks used last; null: none.
struct LastSquares {
  const PaintTile* tile = nullptr;
  const FacetSquare* facets = nullptr;
};

// Where facets need texels they are found when the facets are known, at their middles.
inline bool takes_texels_of_facets(const PaintJob& job) { return job.needs.facets && job.needs.image; }

HWY_INLINE void begin(const PaintJob& job, PaintTiles& tiles, LastSquares& last, int x, int y, Block& block) {
  begin_block(job, tiles.max_level(), x, y, std::min(kBlock, job.width - x), block);
  if (block.ground == 0 || job.one_colour) return;
  if (job.needs.facets) {
    locate_facets(tiles, last.facets, block);
  } else {
    locate(tiles, last.tile, block);
  }
}

// Does what is between begin() and finish() where facets take texels.
HWY_INLINE void take_texels_of_facets(const PaintJob& job, PaintTiles& tiles, LastSquares& last, Block& block) {
  if (block.ground == 0) return;
  take_facets(job, true, block);
  locate(tiles, last.tile, block);
}

// Colours the block's ground.
inline HWY_NOINLINE void paint_ground(const PaintJob& job, PaintTiles& tiles, Block& block) {
  const PaintNeeds& needs = job.needs;
  const auto takes_place = [](paging::ColourSource s) {
    return s == paging::ColourSource::kSlope || s == paging::ColourSource::kAspect;
  };
  if (needs.facets && !needs.image) take_facets(job, takes_place(job.shading->colour_source), block);
  if (needs.posts) take_posts(static_cast<std::size_t>(job.posts_side), block);
  if (needs.posts && job.normals != nullptr) take_normals(job, block);
  if (needs.image) take_texels(block);
  if (needs.post_colours) take_colours(job, tiles, block);
  paint_shading(job, block);
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
    // Without light and hue.
    const float* const image = block.texel[i];
    block.red[i] = tone * image[0];
    block.green[i] = tone * image[1];
    block.blue[i] = tone * image[2];
  }
}

// Returns the number of nodata pixels.
HWY_INLINE int finish(const PaintJob& job, PaintTiles& tiles, Block& block) {
  const core::SettingsValues& settings = job.request->settings;
  if (block.ground != 0) paint_ground(job, tiles, block);
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
  LastSquares last;
  // Blocks overlap, so that the memory of the later one arrives while the earlier one is finished.
  Block blocks[3];
  const int steps = takes_texels_of_facets(job) ? 3 : 2;
  for (int y = first_row; y < end_row; ++y) {
    if (tiles.trim()) last = {};
    int n = 0;
    const auto go_on = [&](int finished) {
      if (steps == 3 && n >= 1 && n - 1 > finished)
        take_texels_of_facets(job, tiles, last, blocks[(n - 1) % steps]);
      if (finished >= 0) nodata_count += finish(job, tiles, blocks[finished % steps]);
    };
    for (int x = 0; x < job.width; x += kBlock) {
      if (job.wanted != nullptr && wanted_bits(job, x, y) == 0) continue;
      begin(job, tiles, last, x, y, blocks[n % steps]);
      go_on(n - steps + 1);
      ++n;
    }
    for (int left = steps - 1; left > 0; --left) go_on(n - left);
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
