#include "mars/embedded_troughs.h"

#include <algorithm>
#include <array>
#include <optional>

#include "mars/embedded_landforms.h"
#include "mars/embedded_math.h"
#include "mars/embedded_noise.h"
#include "mars/embedded_spurs.h"

namespace mars::embedded {

namespace {

struct System {
  std::span<const TroughPiece> pieces;
  double scallop_m;  // how far the rim wanders
  double slope;      // depth over width of the wall
  bool spurs;        // walls with spurs and gullies, floors with landslides
};

// Smooth union of the pieces near a block.
struct Inside {
  Lane<double> depth_m;  // horizontally inwards from the rim, negative outside
  Lane<double> floor_m;
  Lane<double> to_axis_m;   // from here to the centre line
  Lane<double> gx, gy, gz;  // unit inwards
};

constexpr double kJoin_m = 18e3;
constexpr double kMargin_m = 45e3;

bool find_inside(const Block& block, std::span<const TroughPiece> pieces, Inside& out) {
  std::array<const TroughPiece*, kMostPieces> close;
  std::size_t n = 0;
  for (const TroughPiece& p : pieces) {
    const glm::dvec3 middle = (p.a + p.b) * 0.5;
    const double half = 0.5 * std::sqrt(chord2(p.a, p.b));
    const double wide = std::max(p.half_width_a_km, p.half_width_b_km) * 1000.0 + kMargin_m + kJoin_m;
    if (block.near(middle, half + wide / kRadius_m)) close[n++] = &p;
  }
  if (n == 0) return false;

  bool any = false;
  for (std::size_t i = 0; i < block.padded; ++i) {
    double depth[kMostPieces];
    double along[kMostPieces];
    glm::dvec3 inward[kMostPieces];
    double deepest = -1e9;
    const glm::dvec3 here = block.at(i);
    for (std::size_t k = 0; k < n; ++k) {
      const TroughPiece& p = *close[k];
      const glm::dvec3 ab = p.b - p.a;
      const glm::dvec3 ap = here - p.a;
      const double t =
          clamp01((ap.x * ab.x + ap.y * ab.y + ap.z * ab.z) / (ab.x * ab.x + ab.y * ab.y + ab.z * ab.z));
      // Measured along the ground where the piece is near: the part of the offset that is not radial.
      const glm::dvec3 v{p.a.x + t * ab.x - here.x, p.a.y + t * ab.y - here.y, p.a.z + t * ab.z - here.z};
      const double radial = v.x * here.x + v.y * here.y + v.z * here.z;
      const double up = radial > -0.01 && radial < 0.01 ? radial : 0.0;
      const glm::dvec3 level{v.x - up * here.x, v.y - up * here.y, v.z - up * here.z};
      const double distance = std::sqrt(level.x * level.x + level.y * level.y + level.z * level.z) + 1e-12;
      depth[k] = mix(p.half_width_a_km, p.half_width_b_km, t) * 1000.0 - distance * kRadius_m;
      along[k] = t;
      inward[k] = {level.x / distance, level.y / distance, level.z / distance};
      deepest = std::max(deepest, depth[k]);
    }
    double sum = 0.0;
    double d = 0.0;
    double floor = 0.0;
    double half = 0.0;
    glm::dvec3 g{0, 0, 0};
    for (std::size_t k = 0; k < n; ++k) {
      const double w = std::max(0.0, 1.0 - (deepest - depth[k]) / kJoin_m);
      if (w <= 0.0) continue;
      const double ww = w * w;
      sum += ww;
      d += ww * depth[k];
      half += ww * mix(close[k]->half_width_a_km, close[k]->half_width_b_km, along[k]) * 1000.0;
      floor += ww * mix(close[k]->floor_a_m, close[k]->floor_b_m, along[k]);
      g = {g.x + ww * inward[k].x, g.y + ww * inward[k].y, g.z + ww * inward[k].z};
    }
    out.depth_m[i] = d / sum;
    out.floor_m[i] = floor / sum;
    out.to_axis_m[i] = half / sum - out.depth_m[i];
    out.gx[i] = g.x / sum;
    out.gy[i] = g.y / sum;
    out.gz[i] = g.z / sum;
    any = any || out.depth_m[i] > -kMargin_m;
  }
  return any;
}

void cut(const Block& block, const Wander& w, double spacing_m, const System& system, Terrain& t) {
  Inside in;
  if (!find_inside(block, system.pieces, in)) return;

  // The rim: rounded alcoves between cusps, at several sizes.
  Lane<float> bays, coves, nicks, notches;
  nicks.fill(kMeanNoise);
  notches.fill(kMeanNoise);
  noise(block, 52e3, 0x311, bays);
  noise(block, 21e3, 0x322, coves);
  if (spacing_m <= 2048.0) noise(block, 8e3, 0x333, nicks);
  if (spacing_m <= 1024.0) noise(block, 3.1e3, 0x344, notches);

  Lane<double> depth, plain;
  Points drawn;  // each post pulled back to its rim: noise there makes spurs and gullies that run downhill
  for (std::size_t i = 0; i < block.padded; ++i) {
    plain[i] = in.depth_m[i] +
               system.scallop_m * (-0.62 * (crest(bays[i]) - 0.45) + 0.25 * static_cast<double>(w.km100[i]) -
                                   0.22 * (crest(coves[i]) - 0.45));
    depth[i] =
        plain[i] - system.scallop_m * (0.065 * (crest(nicks[i]) - 0.4) + 0.018 * (crest(notches[i]) - 0.4));
    const double back = 0.8 * std::max(0.0, std::min(22e3, in.depth_m[i] + 9e3));
    const double sway = 550.0 * static_cast<double>(nicks[i]) + 240.0 * static_cast<double>(notches[i]);
    drawn.x[i] = block.x[i] * kRadius_m - back * in.gx[i] + sway;
    drawn.y[i] = block.y[i] * kRadius_m - back * in.gy[i] - sway;
    drawn.z[i] = block.z[i] * kRadius_m - back * in.gz[i] + sway;
  }
  std::optional<Spurs> spurs;
  Lane<float> lobes{}, grooves{};
  Lane<double> chaos{};
  if (system.spurs) {
    spurs.emplace(drawn, block.padded, block.simd, spacing_m, 0x351U);
    Points far;
    static constexpr glm::dvec3 kChaos = place(317.5, -10.5);
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double back = 0.8 * std::max(0.0, std::min(32e3, in.depth_m[i] + 9e3));
      far.x[i] = block.x[i] * kRadius_m - back * in.gx[i];
      far.y[i] = block.y[i] * kRadius_m - back * in.gy[i];
      far.z[i] = block.z[i] * kRadius_m - back * in.gz[i];
      chaos[i] = ramp(km_chord(560.0) * km_chord(560.0), km_chord(300.0) * km_chord(300.0),
                      chord2(block.at(i), kChaos));
    }
    noise(far, block.padded, block.simd, 48e3, 0x3e1, lobes);
    if (spacing_m <= 1024.0) noise(far, block.padded, block.simd, 2.4e3, 0x3e2, grooves);
  }

  for (std::size_t i = 0; i < block.padded; ++i) {
    const double drop = t.height_m[i] - in.floor_m[i];
    if (drop <= 0.0 || plain[i] <= -4e3) continue;
    const double width = std::max(2500.0, drop / system.slope);
    // Masks follow the smooth rim, so that they are the same at every spacing.
    const auto inside = static_cast<float>(ramp(-1500.0, 1500.0, plain[i]) * ramp(200.0, 1600.0, drop));
    const auto on_floor = inside * static_cast<float>(ramp(0.75 * width, 1.15 * width, plain[i]));
    t.wall[i] = std::max(t.wall[i] * (1.0F - on_floor), inside * (1.0F - on_floor));
    t.trough[i] = std::max(t.trough[i], on_floor);
    t.cratered[i] = std::min(t.cratered[i], mix(1.0F, 0.06F, inside));
    t.rugged[i] = mix(t.rugged[i], mix(0.15F, 0.30F, on_floor), inside);
    t.rough[i] = mix(t.rough[i], mix(0.9F, 0.95F, on_floor), inside);
    t.volcanic[i] = t.volcanic[i] * (1.0F - inside);
    if (depth[i] <= 0.0) continue;

    double along = depth[i];
    double texture = 0.0;
    if (spurs) {
      const double s = clamp01(along / width);
      along -= width * spurs->shift(i, s);
      texture = spurs->rills_m(i, s);
      // Landslides run out over the floor from some alcoves, with a toe and grooves along the run.
      const double run =
          (depth[i] - 0.6 * width) / (16e3 + 9e3 * clamp01(0.5 + 0.5 * static_cast<double>(lobes[i])));
      const double lobe = ramp(0.15, 0.75, static_cast<double>(lobes[i])) * ramp(-0.35, 0.1, run) *
                          ramp(1.0, 0.93, run) * ramp(6e3, 16e3, in.to_axis_m[i]) * clamp01(depth[i] * 1e-3);
      texture += lobe * (420.0 - 250.0 * clamp01(run) + 55.0 * static_cast<double>(grooves[i]) +
                         22.0 * static_cast<double>(nicks[i]));
      // Chaos: blocks of the plateau left standing in the eastern chasmata.
      const double knob = ramp(0.25, 0.95,
                               0.55 * static_cast<double>(coves[i]) + 0.4 * static_cast<double>(w.km16[i]) +
                                   0.45 * static_cast<double>(nicks[i]));
      texture += knob * chaos[i] * static_cast<double>(on_floor) *
                 std::max(250.0, 850.0 + 350.0 * static_cast<double>(w.km40[i]));
    }
    const double s = clamp01(along / width);
    // A steep upper cliff, a talus slope that eases off, and a floor that still falls a little.
    const double wall = s * (2.0 - s);
    const double basin = ramp(0.0, 4.0 * width, depth[i]);
    const double shallow = ramp(0.0, 500.0, drop);
    double h = t.height_m[i] - shallow * drop * (0.94 * wall + 0.06 * basin) + shallow * texture;
    if (system.spurs && spacing_m <= 256.0) {
      // Beds crop out in the upper wall.
      const double bed = h * (1.0 / 260.0);
      const double phase = bed - floor_int(bed);
      h += clamp01(2.0 - 2.6 * s) * clamp01(s * 20.0) * 46.0 * phase * (1.0 - phase) * (phase - 0.35);
    }
    t.height_m[i] = h;
  }
}

}  // namespace

void cut_troughs(const Block& block, const Wander& w, double spacing_m, Terrain& t) {
  cut(block, w, spacing_m, {channel_pieces(), 9e3, 0.10, false}, t);
  cut(block, w, spacing_m, {valles_pieces(), 17e3, 0.37, true}, t);
}

}  // namespace mars::embedded
