// Colours as words with red in the lowest byte, in vectors. Included once for each instruction set.
#if defined(VPE_WARP_COLOUR_WORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_WARP_COLOUR_WORDS_INL_H_
#undef VPE_WARP_COLOUR_WORDS_INL_H_
#else
#define VPE_WARP_COLOUR_WORDS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "vpe/base/rgb.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::warp::HWY_NAMESPACE {

// Mixes colours in 256ths: within half a step of 8 bits.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE V mix(D d, V a, V b, V share_256) {
  namespace hn = hwy::HWY_NAMESPACE;
  const V rest = hn::Sub(hn::Set(d, 256), share_256);
  const V even = hn::Set(d, 0x00FF00FF);
  const auto blend = [&](V x, V y) HWY_ATTR {
    const V sum = hn::Add(hn::Mul(x, rest), hn::Mul(y, share_256));
    return hn::And(hn::ShiftRight<8>(hn::Add(sum, hn::Set(d, 0x00800080))), even);
  };
  const V red_blue = blend(hn::And(a, even), hn::And(b, even));
  const V green =
      blend(hn::And(hn::ShiftRight<8>(a), hn::Set(d, 0xFF)), hn::And(hn::ShiftRight<8>(b), hn::Set(d, 0xFF)));
  return hn::Or(red_blue, hn::ShiftLeft<8>(green));
}

template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> load_words(D d, const base::Rgb* from) {
  namespace hn = hwy::HWY_NAMESPACE;
  static_assert(sizeof(base::Rgb) == 3);
  const hn::Rebind<std::uint8_t, D> d8;
  hn::Vec<decltype(d8)> red;
  hn::Vec<decltype(d8)> green;
  hn::Vec<decltype(d8)> blue;
  hn::LoadInterleaved3(d8, &from->r, red, green, blue);
  return hn::Or(hn::PromoteTo(d, red),
                hn::Or(hn::ShiftLeft<8>(hn::PromoteTo(d, green)), hn::ShiftLeft<16>(hn::PromoteTo(d, blue))));
}

template <class D>
HWY_INLINE void store_words(D d, hwy::HWY_NAMESPACE::Vec<D> words, base::Rgb* out) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::RebindToSigned<D> di;
  const hn::Rebind<std::uint8_t, D> d8;
  const auto byte = hn::Set(d, 0xFF);
  const auto narrow = [&](auto word)
                          HWY_ATTR { return hn::DemoteTo(d8, hn::BitCast(di, hn::And(word, byte))); };
  hn::StoreInterleaved3(narrow(words), narrow(hn::ShiftRight<8>(words)), narrow(hn::ShiftRight<16>(words)), d8,
                        &out->r);
}

}  // namespace vpe::warp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
