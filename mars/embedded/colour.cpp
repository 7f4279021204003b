#include "mars/embedded/colour.h"

#include <algorithm>

#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

struct Colour {
  float r, g, b;
};
constexpr Colour kPlain{164, 111, 77};  // ground without a mosaic
constexpr Colour kStone{106, 84, 73};
constexpr Colour kLayers{196, 152, 118};
constexpr Colour kBlack{62, 53, 50};

[[gnu::always_inline]] inline Colour mix_colour(const Colour& a, const Colour& b, float t) {
  return {mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t)};
}

std::uint8_t byte(float x) { return static_cast<std::uint8_t>(std::max(0.0F, std::min(255.0F, x)) + 0.5F); }

// Sets out[i] to the brightness that detail adds, relative and of mean 0.
void shade(const Block& block, const Surface& s, Lane<float>& out) {
  const auto& n = s.octaves.n;
  std::fill_n(out.begin(), block.padded, 0.0F);
  // Drifts of dust and sand.
  float share = 0.034F;
  for (int k = 11; k >= std::max(6, s.octaves.first); --k) {
    for (std::size_t i = 0; i < block.padded; ++i) out[i] += share * n[static_cast<std::size_t>(k)][i];
    share *= 0.75F;
  }
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const float open = 1.0F - 0.6F * s.ground.ice[i];
      const float grain = std::max(-4.0F, std::min(4.0F, s.relief.grain[i]));
      out[i] = open * (out[i] + 0.03F * grain - 0.10F * s.craters.fresh[i]);
      out[i] = std::max(-0.4F, std::min(0.4F, out[i]));
    }
  });
}

}  // namespace

void colour(const Block& block, const MeasuredMars& mars, const Surface& s, vpe::base::Rgb* out) {
  const bool measured = mars.has_colours();
  Lane<float> red, green, blue;
  if (measured) {
    GridCells cells;
    grid_cells(block, s.ground.places, kMeasuredColumns, 1, cells);
    mars.red().evaluate(block, cells, red);
    mars.green().evaluate(block, cells, green);
    mars.blue().evaluate(block, cells, blue);
  }
  Lane<float> bright;
  const bool detailed = s.octaves.first < kOutlineOctave;
  if (detailed) shade(block, s, bright);
  for (std::size_t i = 0; i < block.count; ++i) {
    Colour c = kPlain;
    if (measured) c = {red[i], green[i], blue[i]};
    if (detailed) {
      const float f = 1.0F + bright[i];
      c = {c.r * f, c.g * f, c.b * f};
      const float sand = s.relief.sand.cover[i];
      const float ripple = sand * (0.16F * s.relief.sand.crest[i] - 0.08F);
      c = {c.r * (1.0F + ripple), c.g * (1.0F + ripple), c.b * (1.0F + ripple)};
      if (s.relief.rock[i] > 0.0F) {
        const float tone = s.relief.rock_tone[i];
        const Colour stone =
            mix_colour(kStone, tone > 0.0F ? kLayers : kBlack, 0.7F * std::min(1.0F, magnitude(tone)));
        c = mix_colour(c, stone, 0.8F * s.relief.rock[i] * (1.0F - s.ground.ice[i]));
      }
    }
    out[i] = {byte(c.r), byte(c.g), byte(c.b)};
  }
}

}  // namespace mars::embedded
