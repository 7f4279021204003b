// Weights of neighbouring pixels for a place between them. Private to vpe/warp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace vpe::warp {

// Says how four pixels of a row or a column are mixed, in 64ths; the weights add up to 64.
struct Taps {
  std::array<std::int16_t, 4> weight{};
  std::array<std::int16_t, 16> by_byte{};  // each weight four times, for the bytes of a word
};

// Weights for every 64th of the way between two pixels, the second and the third of four: the cubic of Catmull and Rom, which
// keeps the contrast between pixels that mixing two of them would lose. At the ends of a row the two are the first or the
// last of the four; they are mixed linearly.
class TapTable {
 public:
  static constexpr int kParts = 64;

  TapTable() {
    for (int part = 0; part <= kParts; ++part) {
      const double f = static_cast<double>(part) / kParts;
      const double g = f * f;
      const double h = g * f;
      const auto in_parts = [](double weight) {
        return static_cast<std::int16_t>(std::lround(kParts * weight));
      };
      const std::int16_t before = in_parts(0.5 * (-f + 2 * g - h));
      const std::int16_t second = in_parts(0.5 * (f + 4 * g - 3 * h));
      const std::int16_t after = in_parts(0.5 * (h - g));
      const auto rest = static_cast<std::int16_t>(kParts - before - second - after);
      const auto far = static_cast<std::int16_t>(part);
      const auto near = static_cast<std::int16_t>(kParts - part);
      const auto n = static_cast<std::size_t>(part);
      taps_[0][n] = of({near, far, 0, 0});
      taps_[1][n] = of({before, rest, second, after});
      taps_[2][n] = of({0, 0, near, far});
    }
  }

  // Returns the first of four pixels for a place between the pixel `at` and the next one of `count`, 4 or more.
  static std::int32_t first(std::int32_t at, std::int32_t count) { return std::clamp(at - 1, 0, count - 4); }
  // Returns their weights.
  const Taps& at(std::int32_t at, std::int32_t count, std::int32_t part) const {
    return taps_[static_cast<std::size_t>(at - first(at, count))][static_cast<std::size_t>(part)];
  }

 private:
  static Taps of(const std::array<std::int16_t, 4>& weight) {
    Taps taps;
    taps.weight = weight;
    for (std::size_t n = 0; n < 16; ++n) taps.by_byte[n] = weight[n / 4];
    return taps;
  }

  std::array<std::array<Taps, kParts + 1>, 3> taps_{};
};

}  // namespace vpe::warp
