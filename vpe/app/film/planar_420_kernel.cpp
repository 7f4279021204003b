#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "vpe/app/film/planar_420.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/app/film/planar_420_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

#ifndef VPE_APP_FILM_PLANAR_420_KERNEL
#define VPE_APP_FILM_PLANAR_420_KERNEL
namespace vpe::app {

// What red, green and blue add to a value, in parts of 2^15.
struct PlanarWeights {
  std::int16_t red, green, blue;
};

constexpr std::int16_t planar_weight(double weight, double range) {
  const double scaled = weight * range / 255 * 32768;
  return static_cast<std::int16_t>(scaled + (scaled < 0 ? -0.5 : 0.5));
}

// Weights of BT.709.
inline constexpr double kRedLuma = 0.2126;
inline constexpr double kBlueLuma = 0.0722;
inline constexpr double kGreenLuma = 1 - kRedLuma - kBlueLuma;
inline constexpr PlanarWeights kLuma{planar_weight(kRedLuma, 219), planar_weight(kGreenLuma, 219),
                                     planar_weight(kBlueLuma, 219)};
inline constexpr PlanarWeights kChromaU{planar_weight(-kRedLuma / (2 * (1 - kBlueLuma)), 224),
                                        planar_weight(-kGreenLuma / (2 * (1 - kBlueLuma)), 224),
                                        planar_weight(0.5, 224)};
inline constexpr PlanarWeights kChromaV{planar_weight(0.5, 224),
                                        planar_weight(-kGreenLuma / (2 * (1 - kRedLuma)), 224),
                                        planar_weight(-kBlueLuma / (2 * (1 - kRedLuma)), 224)};
inline constexpr int kDarkestLuma = 16;
inline constexpr int kGreyChroma = 128;
// Colours and values are worked on in parts of 2^7, which fit into 16 bits with their sign.
inline constexpr int kFractionBits = 7;

// Returns what is added to weighed colours before the fraction is cut off.
constexpr std::int16_t rounded_zero(int zero) {
  return static_cast<std::int16_t>((zero << kFractionBits) + (1 << (kFractionBits - 1)));
}

}  // namespace vpe::app
#endif

HWY_BEFORE_NAMESPACE();
namespace vpe::app::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Rows of two, and where their values go.
struct RowPair {
  const std::uint8_t* upper;
  const std::uint8_t* lower;
  std::uint8_t* upper_y;
  std::uint8_t* lower_y;
  std::uint8_t* u;
  std::uint8_t* v;
};

#if HWY_TARGET != HWY_SCALAR

const hn::ScalableTag<std::uint8_t> kBytes;
const hn::Repartition<std::int16_t, decltype(kBytes)> kWords;
using Bytes = hn::Vec<decltype(kBytes)>;
using Words = hn::Vec<decltype(kWords)>;

// N pixels are worked on as N / 2 lanes of 16 bits: the even ones and the odd ones of each pair.
HWY_INLINE Words even(Bytes v) { return hn::And(hn::BitCast(kWords, v), hn::Set(kWords, 0xff)); }
HWY_INLINE Words odd(Bytes v) {
  const hn::RebindToUnsigned<decltype(kWords)> d;
  return hn::BitCast(kWords, hn::ShiftRight<8>(hn::BitCast(d, v)));
}

struct Colours {
  Words red, green, blue;
};

// Returns whole values of colours in parts of 2^kFractionBits.
HWY_INLINE Words value(const Colours& c, const PlanarWeights& w, int zero) {
  const Words weighed = hn::Add(hn::Add(hn::MulFixedPoint15(c.red, hn::Set(kWords, w.red)),
                                        hn::MulFixedPoint15(c.green, hn::Set(kWords, w.green))),
                                hn::MulFixedPoint15(c.blue, hn::Set(kWords, w.blue)));
  return hn::ShiftRight<kFractionBits>(hn::Add(weighed, hn::Set(kWords, rounded_zero(zero))));
}

template <int kBits>
HWY_INLINE Colours shifted(const Colours& c) {
  return {hn::ShiftLeft<kBits>(c.red), hn::ShiftLeft<kBits>(c.green), hn::ShiftLeft<kBits>(c.blue)};
}

HWY_INLINE Colours sum(const Colours& a, const Colours& b) {
  return {hn::Add(a.red, b.red), hn::Add(a.green, b.green), hn::Add(a.blue, b.blue)};
}

// Writes luma of N pixels and returns the sums of their pairs.
HWY_INLINE Colours convert_luma(const std::uint8_t* pixels, std::uint8_t* y) {
  Bytes r, g, b;
  hn::LoadInterleaved3(kBytes, pixels, r, g, b);
  const Colours left{even(r), even(g), even(b)};
  const Colours right{odd(r), odd(g), odd(b)};
  const Words first = value(shifted<kFractionBits>(left), kLuma, kDarkestLuma);
  const Words second = value(shifted<kFractionBits>(right), kLuma, kDarkestLuma);
  hn::StoreU(hn::BitCast(kBytes, hn::Or(first, hn::ShiftLeft<8>(second))), kBytes, y);
  return sum(left, right);
}

// Converts as many pixels as fit into whole vectors. Returns their number.
std::size_t convert_vectors(const RowPair& rows, std::size_t width) {
  const hn::Rebind<std::uint8_t, decltype(kWords)> halves;
  const std::size_t step = hn::Lanes(kBytes);
  std::size_t x = 0;
  for (; x + step <= width; x += step) {
    const Colours sums = shifted<kFractionBits - 2>(sum(convert_luma(rows.upper + 3 * x, rows.upper_y + x),
                                                        convert_luma(rows.lower + 3 * x, rows.lower_y + x)));
    hn::StoreU(hn::DemoteTo(halves, value(sums, kChromaU, kGreyChroma)), halves, rows.u + x / 2);
    hn::StoreU(hn::DemoteTo(halves, value(sums, kChromaV, kGreyChroma)), halves, rows.v + x / 2);
  }
  return x;
}

#else

std::size_t convert_vectors(const RowPair&, std::size_t) { return 0; }

#endif

// The same of one pair of pixels in each row.
int plain_value(const int* colour, const PlanarWeights& w, int zero) {
  const auto product = [](int a, int b) { return (a * b + (1 << 14)) >> 15; };
  return (product(colour[0], w.red) + product(colour[1], w.green) + product(colour[2], w.blue) +
          rounded_zero(zero)) >>
         kFractionBits;
}

void convert_pair(const RowPair& rows, std::size_t x) {
  int sums[3] = {};
  const auto luma = [&sums](const std::uint8_t* pixel, std::uint8_t* y) {
    int colour[3];
    for (int k = 0; k < 3; ++k) {
      colour[k] = pixel[k] << kFractionBits;
      sums[k] += colour[k] >> 2;
    }
    *y = static_cast<std::uint8_t>(plain_value(colour, kLuma, kDarkestLuma));
  };
  for (std::size_t k = x; k < x + 2; ++k) {
    luma(rows.upper + 3 * k, rows.upper_y + k);
    luma(rows.lower + 3 * k, rows.lower_y + k);
  }
  rows.u[x / 2] = static_cast<std::uint8_t>(plain_value(sums, kChromaU, kGreyChroma));
  rows.v[x / 2] = static_cast<std::uint8_t>(plain_value(sums, kChromaV, kGreyChroma));
}

void planar_420_kernel(const std::uint8_t* pixels, std::size_t width, std::size_t height,
                       std::uint8_t* planes) {
  std::uint8_t* const u = planes + width * height;
  std::uint8_t* const v = u + width / 2 * (height / 2);
  for (std::size_t y = 0; y < height; y += 2) {
    const RowPair rows{pixels + 3 * y * width,   pixels + 3 * (y + 1) * width, planes + y * width,
                       planes + (y + 1) * width, u + y / 2 * (width / 2),      v + y / 2 * (width / 2)};
    for (std::size_t x = convert_vectors(rows, width); x < width; x += 2) convert_pair(rows, x);
  }
}

}  // namespace
}  // namespace vpe::app::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::app {

HWY_EXPORT(planar_420_kernel);

void to_planar_420(std::span<const base::Rgb> pixels, int width, int height,
                   std::vector<std::uint8_t>& planes) {
  if (width < 2 || height < 2 || width % 2 != 0 || height % 2 != 0 ||
      pixels.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw std::invalid_argument("to_planar_420: " + std::to_string(pixels.size()) + " pixels as an image of " +
                                std::to_string(width) + "x" + std::to_string(height));
  }
  static_assert(sizeof(base::Rgb) == 3);
  planes.resize(pixels.size() / 2 * 3);
  HWY_DYNAMIC_DISPATCH(planar_420_kernel)
  (reinterpret_cast<const std::uint8_t*>(pixels.data()), static_cast<std::size_t>(width),
   static_cast<std::size_t>(height), planes.data());
}

}  // namespace vpe::app
#endif
