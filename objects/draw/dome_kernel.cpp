#include "objects/draw/dome_kernel.h"

#include <cstring>
#include <limits>
#include <type_traits>

// Highway compiles this file once for each instruction set and selects the best one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "objects/draw/dome_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/cache_control.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace objects::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using DomeFloats = hn::CappedTag<float, kDomeBlock_px>;
using DomeInts = hn::RebindToSigned<DomeFloats>;
using DomeFloatVec = hn::Vec<DomeFloats>;
using DomeIntVec = hn::Vec<DomeInts>;

template <class D>
using VecOf = hn::Vec<D>;

// Returns the arc tangent of t: at most t^9 / 9 off.
template <class D>
HWY_INLINE VecOf<D> arc_of(D d, VecOf<D> t) {
  using T = hn::TFromD<D>;
  const VecOf<D> square = hn::Mul(t, t);
  VecOf<D> sum = hn::Add(hn::Set(d, T(1) / 5), hn::Mul(square, hn::Set(d, T(-1) / 7)));
  sum = hn::Add(hn::Set(d, T(-1) / 3), hn::Mul(square, sum));
  return hn::Add(t, hn::Mul(t, hn::Mul(square, sum)));
}

template <class D>
HWY_INLINE auto to_floats(D /*d*/, VecOf<D> v) {
  if constexpr (std::is_same_v<hn::TFromD<D>, float>) {
    return v;
  } else {
    return hn::DemoteTo(hn::Rebind<float, D>(), v);
  }
}

// What the rays of some pixels meet.
template <class D>
struct DomeMeeting {
  VecOf<D> x;  // from the middle, of any length
  VecOf<D> y;
  VecOf<D> z;
  VecOf<D> range;
};

template <class D, class T>
HWY_INLINE DomeMeeting<D> meet_dome_at(D d, const DomeBlock<T>& block, int row, int column) {
  const auto set = [&](T value) HWY_ATTR { return hn::Set(d, value); };
  const auto along = [&](std::size_t axis) HWY_ATTR {
    const VecOf<D> side = hn::LoadU(d, block.column[axis].data() + column);
    return hn::Add(hn::Mul(set(block.row_scale[static_cast<std::size_t>(row)]), side),
                   set(block.row_rise[static_cast<std::size_t>(row)] * block.up[axis]));
  };
  const VecOf<D> x = along(0);
  const VecOf<D> y = along(1);
  const VecOf<D> z = along(2);
  const VecOf<D> level = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
  const VecOf<D> all = hn::Add(level, hn::Mul(z, z));
  if (block.is_central) {
    const VecOf<D> radius = set(block.radius_m);
    return {x, y, z, block.is_cylinder ? hn::Mul(radius, hn::Sqrt(hn::Div(all, level))) : radius};
  }
  VecOf<D> ahead = hn::Add(hn::Mul(set(block.camera[0]), x), hn::Mul(set(block.camera[1]), y));
  if (!block.is_cylinder) ahead = hn::Add(ahead, hn::Mul(set(block.camera[2]), z));
  const VecOf<D> square = block.is_cylinder ? level : all;
  const VecOf<D> open = set(block.open);
  const VecOf<D> root = hn::Sqrt(hn::Add(hn::Mul(ahead, ahead), hn::Mul(square, open)));
  // Of two forms of the larger root the one without a difference of near numbers.
  const auto goes_out = hn::Gt(ahead, hn::Zero(d));
  const VecOf<D> above = hn::IfThenElse(goes_out, open, hn::Sub(root, ahead));
  const VecOf<D> below = hn::IfThenElse(goes_out, hn::Add(root, ahead), square);
  const VecOf<D> way = hn::Div(above, below);
  return {hn::Add(set(block.camera[0]), hn::Mul(way, x)), hn::Add(set(block.camera[1]), hn::Mul(way, y)),
          hn::Add(set(block.camera[2]), hn::Mul(way, z)),
          hn::Mul(hn::Mul(way, hn::Sqrt(all)), set(block.radius_m))};
}

template <class T>
HWY_INLINE bool places_of(const DomeBlock<T>& block, const float* until_m, std::size_t until_stride,
                          BlockPlaces& places) {
  const bool shows_all = until_m == nullptr;
  using Kind = PanoramaFormula::Kind;
  using D = hn::CappedTag<T, kDomeBlock_px>;
  using Vec = VecOf<D>;
  const D d;
  const hn::Rebind<float, D> df;
  const auto set = [&](T value) HWY_ATTR { return hn::Set(d, value); };
  const auto set_float = [&](float value) HWY_ATTR { return hn::Set(df, value); };
  const Vec zero = hn::Zero(d);
  const Vec most = set(static_cast<T>(kMostTangent));
  const auto is_near = [&](Vec t) HWY_ATTR { return hn::Le(hn::Abs(t), most); };
  const auto infinity = set_float(std::numeric_limits<float>::infinity());
  auto holds = hn::Eq(zero, zero);
  for (int row = 0; row < kDomeBlock_px; ++row) {
    const float* const until_row = shows_all ? nullptr : until_m + static_cast<std::size_t>(row) * until_stride;
    unsigned bits = 0;
    for (int column = 0; column < kDomeBlock_px; column += static_cast<int>(hn::Lanes(d))) {
      const DomeMeeting<D> at = meet_dome_at(d, block, row, column);
      holds = hn::And(holds, hn::Gt(at.y, zero));
      Vec x = zero;
      Vec y = zero;
      if (block.kind == Kind::kFacets) {
        const Vec inverse = hn::Div(set(block.focal_px), at.y);
        x = hn::Mul(at.x, inverse);
        y = hn::Mul(at.z, inverse);
        holds = hn::And(holds, hn::Le(hn::Abs(x), set(block.half_facet_px)));
      } else {
        const Vec level = hn::Sqrt(hn::Add(hn::Mul(at.x, at.x), hn::Mul(at.y, at.y)));
        // One division for both.
        const bool is_cylinder = block.kind == Kind::kCylinder;
        const Vec sine = set(block.sine);
        const Vec cosine = set(block.cosine);
        const Vec above = is_cylinder ? at.z : hn::Sub(hn::Mul(at.z, cosine), hn::Mul(level, sine));
        const Vec below = is_cylinder ? level : hn::Add(hn::Mul(level, cosine), hn::Mul(at.z, sine));
        const Vec inverse = hn::Div(set(T(1)), hn::Mul(at.y, below));
        const Vec t = hn::Mul(at.x, hn::Mul(below, inverse));
        const Vec rise = hn::Mul(above, hn::Mul(at.y, inverse));
        holds = hn::And(holds, hn::And(hn::Gt(below, zero), is_near(t)));
        if (!is_cylinder) holds = hn::And(holds, is_near(rise));
        x = hn::Mul(set(block.across_px), arc_of(d, t));
        y = hn::Mul(set(block.focal_px), is_cylinder ? rise : arc_of(d, rise));
      }
      const auto x_px = to_floats(d, hn::Sub(x, set(block.middle_x_px)));
      const auto y_px = to_floats(d, hn::Sub(hn::Sub(zero, y), set(block.middle_y_px)));
      const auto n = static_cast<std::size_t>(row * kDomeBlock_px + column);
      hn::StoreU(x_px, df, places.x_px.data() + n);
      hn::StoreU(y_px, df, places.y_px.data() + n);
      const auto range = to_floats(d, at.range);
      if (shows_all) {
        hn::StoreU(range, df, places.range_m.data() + n);
        continue;
      }
      auto shows =
          hn::And(hn::And(hn::Ge(x_px, set_float(block.least_x_px)), hn::Le(x_px, set_float(block.most_x_px))),
                  hn::And(hn::Ge(y_px, set_float(block.least_y_px)), hn::Le(y_px, set_float(block.most_y_px))));
      const auto is_nearer = hn::Lt(range, hn::LoadU(df, until_row + column));
      if (!block.replaces_ground) shows = hn::And(shows, is_nearer);
      hn::StoreU(hn::IfThenElse(hn::And(shows, is_nearer), range, infinity), df, places.range_m.data() + n);
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(df, shows, bytes);
      bits |= static_cast<unsigned>(bytes[0] | bytes[1] << 8) << column;
    }
    places.shows[static_cast<std::size_t>(row)] = static_cast<std::uint16_t>(bits);
  }
  return hn::AllTrue(d, holds);
}

bool float_places(const DomeBlock<float>& block, const float* until_m, std::size_t until_stride,
                  BlockPlaces& places) {
  return places_of(block, until_m, until_stride, places);
}

bool double_places(const DomeBlock<double>& block, const float* until_m, std::size_t until_stride,
                   BlockPlaces& places) {
  return places_of(block, until_m, until_stride, places);
}

struct ChannelVecs {
  DomeFloatVec red;
  DomeFloatVec green;
  DomeFloatVec blue;
};

HWY_INLINE DomeFloatVec mixed(DomeFloatVec a, DomeFloatVec b, DomeFloatVec share) {
  return hn::Add(a, hn::Mul(share, hn::Sub(b, a)));
}

HWY_INLINE DomeIntVec clamped(DomeIntVec n, int size) {
  const DomeInts di;
  return hn::Min(hn::Max(n, hn::Zero(di)), hn::Set(di, size - 1));
}

// What one level gives to the pixels of a block. Texels are copied one pixel at a time, as that takes a third of the time of
// gathering them.
struct BlockTexels {
  static constexpr std::size_t kPixels = kDomeBlock_px * kDomeBlock_px;
  HWY_ALIGN std::uint32_t upper[kPixels];  // places of the texels on the left
  HWY_ALIGN std::uint32_t lower[kPixels];
  HWY_ALIGN std::int32_t beside[kPixels];  // from there to those on the right
  HWY_ALIGN float across[kPixels];         // share of those on the right
  HWY_ALIGN float down[kPixels];
  HWY_ALIGN std::uint32_t upper_pair[2 * kPixels];
  HWY_ALIGN std::uint32_t lower_pair[2 * kPixels];
};

// Returns whether all texels on the right follow those on the left.
HWY_INLINE bool find_texels(const BlockLevel& level, bool repeats_across, const BlockPlaces& places,
                            BlockTexels& texels) {
  const DomeFloats d;
  const DomeInts di;
  const DomeIntVec one = hn::Set(di, 1);
  const DomeIntVec width = hn::Set(di, level.width);
  const DomeIntVec last = hn::Set(di, level.width - 1);
  const auto place = [&](float rest, float scale, const float* px) HWY_ATTR {
    return hn::Add(hn::Set(d, rest), hn::Mul(hn::Set(d, scale), hn::LoadU(d, px)));
  };
  auto follow = hn::Eq(one, one);
  for (std::size_t n = 0; n < BlockTexels::kPixels; n += hn::Lanes(d)) {
    const DomeFloatVec x = place(level.rest_x, level.scale_x, places.x_px.data() + n);
    const DomeFloatVec y = place(level.rest_y, level.scale_y, places.y_px.data() + n);
    const DomeFloatVec left = hn::Floor(x);
    const DomeFloatVec top = hn::Floor(y);
    DomeIntVec x0 = hn::Add(hn::ConvertTo(di, left), hn::Set(di, level.first_x));
    const DomeIntVec y0 = hn::Add(hn::ConvertTo(di, top), hn::Set(di, level.first_y));
    DomeIntVec x1 = hn::Add(x0, one);
    if (repeats_across) {
      const auto wrapped = [&](DomeIntVec v) HWY_ATTR {
        const DomeIntVec low = hn::Add(v, hn::IfThenElseZero(hn::Lt(v, hn::Zero(di)), width));
        return hn::Sub(low, hn::IfThenElseZero(hn::Gt(low, last), width));
      };
      x0 = wrapped(x0);
      x1 = wrapped(x1);
    }
    // Also keeps pixels that show no dome within the texture.
    x0 = clamped(x0, level.width);
    x1 = clamped(x1, level.width);
    const DomeIntVec beside = hn::Sub(x1, x0);
    follow = hn::And(follow, hn::Eq(beside, one));
    const auto row = [&](DomeIntVec at)
                         HWY_ATTR { return hn::Add(hn::Mul(clamped(at, level.height), width), x0); };
    hn::Store(row(y0), di, reinterpret_cast<std::int32_t*>(texels.upper + n));
    hn::Store(row(hn::Add(y0, one)), di, reinterpret_cast<std::int32_t*>(texels.lower + n));
    hn::Store(beside, di, texels.beside + n);
    hn::Store(hn::Sub(x, left), d, texels.across + n);
    hn::Store(hn::Sub(y, top), d, texels.down + n);
  }
  return hn::AllTrue(di, follow);
}

HWY_INLINE void copy_texels(const std::uint32_t* from, bool follow, BlockTexels& texels) {
  if (follow) {
    for (std::size_t n = 0; n < BlockTexels::kPixels; ++n) {
      std::memcpy(texels.upper_pair + 2 * n, from + texels.upper[n], 2 * sizeof *from);
      std::memcpy(texels.lower_pair + 2 * n, from + texels.lower[n], 2 * sizeof *from);
    }
    return;
  }
  for (std::size_t n = 0; n < BlockTexels::kPixels; ++n) {
    texels.upper_pair[2 * n] = from[texels.upper[n]];
    texels.upper_pair[2 * n + 1] = from[texels.upper[n] + static_cast<std::uint32_t>(texels.beside[n])];
    texels.lower_pair[2 * n] = from[texels.lower[n]];
    texels.lower_pair[2 * n + 1] = from[texels.lower[n] + static_cast<std::uint32_t>(texels.beside[n])];
  }
}

HWY_INLINE ChannelVecs colours_between(const BlockTexels& texels, std::size_t n) {
  const DomeFloats d;
  const DomeInts di;
  const hn::RebindToUnsigned<DomeFloats> du;
  const DomeFloatVec across = hn::Load(d, texels.across + n);
  const DomeFloatVec down = hn::Load(d, texels.down + n);
  auto ul = hn::Zero(du), ur = ul, ll = ul, lr = ul;
  hn::LoadInterleaved2(du, texels.upper_pair + 2 * n, ul, ur);
  hn::LoadInterleaved2(du, texels.lower_pair + 2 * n, ll, lr);
  const auto byte = hn::Set(du, 255);
  const auto channel = [&](auto shifted) HWY_ATTR {
    const auto of = [&](auto texel)
                        HWY_ATTR { return hn::ConvertTo(d, hn::BitCast(di, hn::And(shifted(texel), byte))); };
    return mixed(mixed(of(ul), of(ur), across), mixed(of(ll), of(lr), across), down);
  };
  return {channel([](auto v) HWY_ATTR { return v; }),
          channel([](auto v) HWY_ATTR { return hn::ShiftRight<8>(v); }),
          channel([](auto v) HWY_ATTR { return hn::ShiftRight<16>(v); })};
}

// Colours of a block's pixels, 0 to 255.
struct BlockChannels {
  HWY_ALIGN float red[BlockTexels::kPixels];
  HWY_ALIGN float green[BlockTexels::kPixels];
  HWY_ALIGN float blue[BlockTexels::kPixels];
};

HWY_INLINE void store_words(const ChannelVecs& c, float steps, std::uint32_t* words) {
  const DomeFloats d;
  const DomeInts di;
  const hn::RebindToUnsigned<DomeFloats> du;
  const DomeFloatVec half = hn::Set(d, 0.5F);
  const auto rounded = [&](DomeFloatVec value) HWY_ATTR {
    return hn::ConvertTo(di, hn::Add(hn::Mul(value, hn::Set(d, steps)), half));
  };
  const DomeIntVec word =
      hn::Or(hn::Or(rounded(c.red), hn::ShiftLeft<10>(rounded(c.green))), hn::ShiftLeft<20>(rounded(c.blue)));
  hn::StoreU(hn::BitCast(du, word), du, words);
}

void colours_kernel(const BlockColours& colours, const BlockPlaces& places, BlockWords& words) {
  const DomeFloats d;
  const DomeFloatVec zero = hn::Zero(d);
  const DomeFloatVec one = hn::Set(d, 1.0F);
  constexpr float kStep = 1.0F / kDomeBlock_px;
  BlockTexels texels;
  BlockChannels sum;
  const std::size_t last = colours.levels.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    copy_texels(colours.levels[k].texels,
                find_texels(colours.levels[k], colours.repeats_across, places, texels), texels);
    for (int row = 0; row < kDomeBlock_px; ++row) {
      const float below = (static_cast<float>(row) + 0.5F) * kStep;
      const float left = colours.level[0] + below * (colours.level[2] - colours.level[0]);
      const float right = colours.level[1] + below * (colours.level[3] - colours.level[1]);
      const DomeFloatVec slope = hn::Set(d, (right - left) * kStep);
      for (int column = 0; column < kDomeBlock_px; column += static_cast<int>(hn::Lanes(d))) {
        const auto n = static_cast<std::size_t>(row * kDomeBlock_px + column);
        ChannelVecs c = colours_between(texels, n);
        if (k > 0) {
          const DomeFloatVec level =
              hn::Add(hn::Set(d, left), hn::Mul(slope, hn::Iota(d, static_cast<float>(column) + 0.5F)));
          const DomeFloatVec share =
              hn::Min(hn::Max(hn::Sub(level, hn::Set(d, static_cast<float>(k - 1))), zero), one);
          c = {mixed(hn::Load(d, sum.red + n), c.red, share), mixed(hn::Load(d, sum.green + n), c.green, share),
               mixed(hn::Load(d, sum.blue + n), c.blue, share)};
        }
        if (k == last) {
          store_words(c, colours.steps, words.data() + n);
          continue;
        }
        hn::Store(c.red, d, sum.red + n);
        hn::Store(c.green, d, sum.green + n);
        hn::Store(c.blue, d, sum.blue + n);
      }
    }
  }
}

// A line of memory holds 16 texels. At the first level a pixel is one to two texels wide, at the next one half of that.
void fetch_kernel(const BlockColours& colours, const BlockPlaces& places) {
  std::size_t down = 1;
  std::size_t across = 7;
  for (const BlockLevel& level : colours.levels) {
    for (std::size_t row = 0; row < kDomeBlock_px; row += down) {
      for (std::size_t column = 0; column < kDomeBlock_px; column += across) {
        const std::size_t n = row * kDomeBlock_px + column;
        const int x = level.first_x + static_cast<int>(level.rest_x + level.scale_x * places.x_px[n]);
        const int y = level.first_y + static_cast<int>(level.rest_y + level.scale_y * places.y_px[n]);
        if (x < 0 || y < 0 || x >= level.width || y + 1 >= level.height) continue;
        const std::uint32_t* const texel =
            level.texels + static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) + x;
        hwy::Prefetch(texel);
        hwy::Prefetch(texel + level.width);
      }
    }
    down = 2;
    across = 15;
  }
}

void bytes_kernel(const std::uint32_t* words, vpe::base::Rgb* out) {
  const DomeInts di;
  const hn::Rebind<std::uint8_t, DomeInts> d8;
  const DomeIntVec byte = hn::Set(di, 255);
  for (std::size_t n = 0; n < kDomeBlock_px; n += hn::Lanes(di)) {
    const DomeIntVec word = hn::LoadU(di, reinterpret_cast<const std::int32_t*>(words + n));
    const auto bytes = [&](DomeIntVec channel) HWY_ATTR { return hn::DemoteTo(d8, hn::And(channel, byte)); };
    hn::StoreInterleaved3(bytes(word), bytes(hn::ShiftRight<10>(word)), bytes(hn::ShiftRight<20>(word)), d8,
                          reinterpret_cast<std::uint8_t*>(out + n));
  }
}

}  // namespace
}  // namespace objects::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace objects {

HWY_EXPORT(float_places);
HWY_EXPORT(double_places);
HWY_EXPORT(colours_kernel);
HWY_EXPORT(fetch_kernel);
HWY_EXPORT(bytes_kernel);

bool find_places(const DomeBlock<float>& block, const float* until_m, std::size_t until_stride,
                 BlockPlaces& places) {
  return HWY_DYNAMIC_DISPATCH(float_places)(block, until_m, until_stride, places);
}

bool find_places(const DomeBlock<double>& block, const float* until_m, std::size_t until_stride,
                 BlockPlaces& places) {
  return HWY_DYNAMIC_DISPATCH(double_places)(block, until_m, until_stride, places);
}

void take_colours(const BlockColours& colours, const BlockPlaces& places, BlockWords& words) {
  HWY_DYNAMIC_DISPATCH(colours_kernel)(colours, places, words);
}

void fetch_ahead(const BlockColours& colours, const BlockPlaces& places) {
  HWY_DYNAMIC_DISPATCH(fetch_kernel)(colours, places);
}

void store_bytes(const std::uint32_t* words, vpe::base::Rgb* out) {
  HWY_DYNAMIC_DISPATCH(bytes_kernel)(words, out);
}

}  // namespace objects
#endif
