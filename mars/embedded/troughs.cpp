#include "mars/embedded/troughs.h"

#include <algorithm>

#include "mars/embedded/block.h"
#include "mars/embedded/landforms.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"
#include "mars/embedded/spurs.h"

namespace mars::embedded {

namespace {

struct System {
  std::span<const TroughPiece> pieces;
  double scallop_m;  // largest irregularity of the rim
  double scallop;    // and its largest share of the half-width
  double slope;      // ratio of depth to width of the wall
  double shallow_m;  // depth below which only heights change
  bool spurs;        // walls with spurs and gullies, floors with landslides
};

constexpr double kMasked_m = -4e3;  // depth_m from which on the factors of Terrain may change

// Returns true if a trough may change the ground of some post, given its depth inside the smooth rim.
bool any_cut(const Block& block, const Inside& in, const Lane<double>& smooth_m, const Terrain& t) {
  for (std::size_t i = 0; i < block.padded; ++i) {
    if (t.height_m[i] > in.floor_m[i] && smooth_m[i] > kMasked_m) return true;
  }
  return false;
}

// Holds the fields that place landslides on the floors.
struct Litter {
  const Lane<double>&depth_m, &width_m;
  const Lane<float>&floor, &coves, &nicks;
};

// Adds landslides, which run out over the floor from some alcoves, with a toe and grooves along the run.
void lay_landslides(const Block& block, double spacing_m, const Inside& in, const Litter& on,
                    Lane<double>& texture) {
  Points far;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double back = 0.8 * std::max(0.0, std::min(32e3, in.depth_m[i] + 9e3));
      far.x[i] = block.x[i] * kRadius_m - back * in.gx[i];
      far.y[i] = block.y[i] * kRadius_m - back * in.gy[i];
      far.z[i] = block.z[i] * kRadius_m - back * in.gz[i];
    }
  });
  Lane<float> lobes, grooves{};
  Lane<double> lobe, run;
  noise(far, block.padded, block.simd, 48e3, 0x3e1, lobes);
  std::int32_t any = 0;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      run[i] = (on.depth_m[i] - 0.6 * on.width_m[i]) /
               (17e3 + 24e3 * clamp01(0.1 + 0.55 * static_cast<double>(lobes[i])));
      lobe[i] = ramp(0.15, 0.75, static_cast<double>(lobes[i])) * ramp(-0.35, 0.1, run[i]) *
                ramp(1.0, 0.93, run[i]) * ramp(6e3, 16e3, in.to_axis_m[i]) * clamp01(on.depth_m[i] * 1e-3);
      any |= static_cast<std::int32_t>(lobe[i] > 0.0);
    }
  });
  if (any == 0) return;
  if (spacing_m <= 1024.0) noise(far, block.padded, block.simd, 2.4e3, 0x3e2, grooves);
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double apron = clamp01(run[i]);
      const double toe = ramp(0.66, 0.92, apron);
      texture[i] += lobe[i] * (520.0 - 420.0 * apron + 170.0 * toe + 75.0 * static_cast<double>(grooves[i]) +
                               26.0 * static_cast<double>(on.nicks[i]));
    }
  });
}

void cut(const Block& block, const OutlineNoise& w, double spacing_m, const System& system, Terrain& t) {
  Inside in;
  if (!find_inside(block, system.pieces, in)) return;

  // Nothing to do where even crests of all sizes leave the rim too far away.
  Lane<double> depth, plain, scallop_m;
  for (std::size_t i = 0; i < block.padded; ++i) {
    scallop_m[i] = std::min(system.scallop_m, system.scallop * (in.to_axis_m[i] + in.depth_m[i]));
    plain[i] = in.depth_m[i] + scallop_m[i] * (0.40 + 0.25 * static_cast<double>(w.km100[i]));
  }
  if (!any_cut(block, in, plain, t)) return;

  // The rim has rounded alcoves between cusps, at several sizes.
  Lane<float> bays, coves, nicks, notches;
  noise(block, 52e3, 0x311, bays);
  noise(block, 21e3, 0x322, coves);
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      plain[i] = in.depth_m[i] +
                 scallop_m[i] * (-0.62 * (crest(bays[i]) - 0.45) + 0.25 * static_cast<double>(w.km100[i]) -
                                 0.22 * (crest(coves[i]) - 0.45));
    }
  });
  if (!any_cut(block, in, plain, t)) return;
  nicks.fill(kMeanNoise);
  notches.fill(kMeanNoise);
  if (spacing_m <= 2048.0) noise(block, 8e3, 0x333, nicks);
  if (spacing_m <= 1024.0) noise(block, 3.1e3, 0x344, notches);

  Lane<double> width;
  Lane<float> floor;  // share of the trough's floor
  std::int32_t below = 0;
  std::int32_t on_wall = 0;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      depth[i] =
          plain[i] - scallop_m[i] * (0.065 * (crest(nicks[i]) - 0.4) + 0.018 * (crest(notches[i]) - 0.4));
      const double drop = t.height_m[i] - in.floor_m[i];
      width[i] = std::max(2500.0, drop / system.slope);
      // The factors follow the smooth rim, so that they are the same at every spacing.
      const bool changed = drop > 0.0 && plain[i] > kMasked_m;
      const float inside = changed ? static_cast<float>(ramp(-1500.0, 1500.0, plain[i]) *
                                                        ramp(system.shallow_m, 8.0 * system.shallow_m, drop))
                                   : 0.0F;
      const float on_floor = inside * static_cast<float>(ramp(0.75 * width[i], 1.15 * width[i], plain[i]));
      const float walled = std::max(t.wall[i] * (1.0F - on_floor), inside * (1.0F - on_floor));
      floor[i] = on_floor;
      t.wall[i] = changed ? walled : t.wall[i];
      t.trough[i] = changed ? std::max(t.trough[i], on_floor) : t.trough[i];
      t.cratered[i] = changed ? std::min(t.cratered[i], mix(1.0F, 0.06F, inside)) : t.cratered[i];
      t.rugged[i] = changed ? mix(t.rugged[i], mix(0.15F, 0.30F, on_floor), inside) : t.rugged[i];
      t.rough[i] = changed ? mix(t.rough[i], mix(0.9F, 0.95F, on_floor), inside) : t.rough[i];
      t.volcanic[i] = changed ? t.volcanic[i] * (1.0F - inside) : t.volcanic[i];
      depth[i] = changed ? depth[i] : 0.0;
      below |= static_cast<std::int32_t>(depth[i] > 0.0);
      on_wall |= static_cast<std::int32_t>(depth[i] > 0.0 && depth[i] < width[i]);
    }
  });
  if (below == 0) return;

  Lane<double> along = depth;
  Lane<double> texture{}, kept{}, broken{};
  if (system.spurs && on_wall != 0) {
    Points drawn;  // each post moved back to its rim, where noise makes spurs and gullies that run downhill
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        const double back = 0.8 * std::max(0.0, std::min(22e3, in.depth_m[i] + 9e3));
        const double sway = 550.0 * static_cast<double>(nicks[i]) + 240.0 * static_cast<double>(notches[i]);
        drawn.x[i] = block.x[i] * kRadius_m - back * in.gx[i] + sway;
        drawn.y[i] = block.y[i] * kRadius_m - back * in.gy[i] - sway;
        drawn.z[i] = block.z[i] * kRadius_m - back * in.gz[i] + sway;
      }
    });
    const Spurs spurs(drawn, block.padded, block.simd, spacing_m, 0x351U);
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) {
        const double s = clamp01(along[i] / width[i]);
        along[i] -= width[i] * spurs.shift(i, s);
        texture[i] = spurs.rills_m(i, s);
      }
    });
  }
  if (system.spurs) {
    const Litter litter{depth, width, floor, coves, nicks};
    lay_landslides(block, spacing_m, in, litter, texture);
  }
  lay_chaos(block, {coves, w.km16, nicks, floor}, broken, texture);
  if (!system.spurs) scour(block, spacing_m, in, floor, broken, kept, texture);
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double drop = t.height_m[i] - in.floor_m[i];
      const double s = clamp01(along[i] / width[i]);
      // A steep upper cliff, a talus slope that becomes gentler, and a floor that still falls a little.
      const double wall = s * (2.0 - s);
      const double basin = ramp(0.0, 4.0 * width[i], depth[i]);
      const double shallow = ramp(0.0, 500.0, drop);
      double h = t.height_m[i] - shallow * drop * (1.0 - kept[i]) * (0.94 * wall + 0.06 * basin) +
                 shallow * texture[i];
      if (system.spurs && spacing_m <= 256.0) {
        // Beds crop out in the upper wall.
        const double bed = h * (1.0 / 260.0);
        const double phase = bed - floor_int(bed);
        h += clamp01(2.0 - 2.6 * s) * clamp01(s * 20.0) * 46.0 * phase * (1.0 - phase) * (phase - 0.35);
      }
      t.height_m[i] = depth[i] > 0.0 ? h : t.height_m[i];
    }
  });
}

}  // namespace

void cut_troughs(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t) {
  cut(block, w, spacing_m, {channel_pieces(), 26e3, 0.75, 0.25, 30.0, false}, t);
  cut(block, w, spacing_m, {valles_pieces(), 17e3, 10.0, 0.37, 200.0, true}, t);
}

}  // namespace mars::embedded
