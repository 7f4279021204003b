#include "mars/embedded/ground.h"

#include <algorithm>

#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

// Sets everything that does not come from data: a sphere of gentle hills.
void lay_plain_ground(const Block& block, Ground& out) {
  const std::size_t n = block.padded;
  const auto fill = [n](auto& lane, auto value) { std::fill_n(lane.begin(), n, value); };
  fill(out.roughness_m, 20.0F);
  fill(out.cratered, 0.4F);
  fill(out.wall, 0.0F);
  fill(out.trough, 0.0F);
  fill(out.lowland, 0.5F);
  fill(out.volcanic, 0.0F);
}

// Sets places, distances and the measured height of `out`, and the height's derivatives by column and row.
void lay_heights(const Block& block, const MeasuredMars& mars, Ground& out, GlobeSpline::Values& h) {
  grid_places(block, kMeasuredColumns, out.places);
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double around = std::sqrt(block.x[i] * block.x[i] + block.y[i] * block.y[i]);
      out.column_m[i] = std::max(1e-3, around) * kMeasuredPost_m;
      out.post_m[i] = post_distance_m(out.places.column[i], out.places.row[i], out.column_m[i]);
    }
  });
  if (!mars.has_heights()) {
    std::fill_n(out.height_m.begin(), block.padded, 0.0);
    return;
  }
  GridCells cells;
  grid_cells(block, out.places, kMeasuredColumns, 1, cells);
  mars.heights().evaluate(block, cells, h);
  std::copy_n(h.value.begin(), block.padded, out.height_m.begin());
}

}  // namespace

void lay_measured(const Block& block, const MeasuredMars& mars, Ground& out) {
  GlobeSpline::Values slopes;
  lay_heights(block, mars, out, slopes);
}

void lay_ground(const Block& block, const MeasuredMars& mars, Ground& out) {
  GlobeSpline::Values h;
  lay_heights(block, mars, out, h);
  out.has_walls = false;
  Lane<float> tone, white;
  tone.fill(0.45F);
  white.fill(0.5F);
  const Character& c = mars.character();
  GridCells coarse;
  grid_cells(block, out.places, kMeasuredColumns / Character::kCoarser, Character::kCoarser, coarse);
  if (mars.has_colours()) {
    c.tone.evaluate(block, coarse, tone);
    c.white.evaluate(block, coarse, white);
  }
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const float polar = ramp(0.94F, 0.98F, magnitude(static_cast<float>(block.z[i])));
      out.ice[i] = polar * ramp(0.52F, 0.78F, white[i]);
      out.dark[i] = ramp(0.36F, 0.24F, tone[i]) * (1.0F - out.ice[i]);
    }
  });
  if (!mars.has_heights()) return lay_plain_ground(block, out);

  Lane<float> broad_m, roughness_m, pits;
  c.broad.evaluate(block, coarse, broad_m);
  c.relief.evaluate(block, coarse, roughness_m);
  c.pits.evaluate(block, coarse, pits);
  Lane<double> east, north;
  std::int32_t any = 0;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const auto height = static_cast<float>(h.value[i]);
      // Columns near a pole are closer together than rows: the slope there is that of the rows.
      east[i] = h.by_column[i] / std::max(out.column_m[i], 0.02 * kMeasuredPost_m);
      north[i] = -h.by_row[i] / kMeasuredPost_m;
      const auto steep = static_cast<float>(std::sqrt(east[i] * east[i] + north[i] * north[i]));
      const float depth_m = broad_m[i] - height;
      const float smooth = ramp(45.0F, 12.0F, roughness_m[i]);
      out.roughness_m[i] = std::max(1.0F, roughness_m[i]);
      out.wall[i] = ramp(0.07F, 0.22F, steep) * (1.0F - 0.8F * out.ice[i]);
      out.trough[i] = ramp(900.0F, 2200.0F, depth_m) * (1.0F - out.wall[i]);
      out.lowland[i] = ramp(-1800.0F, -3200.0F, height) * smooth;
      out.volcanic[i] = ramp(800.0F, 2200.0F, height) * ramp(0.35F, 0.10F, pits[i]) * (1.0F - out.ice[i]);
      out.cratered[i] = std::min(1.3F, pits[i]) * (1.0F - 0.97F * out.ice[i]);
      any |= static_cast<std::int32_t>(out.wall[i] > 0.0F);
    }
  });
  if (any == 0) return;
  out.has_walls = true;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double x = block.x[i], y = block.y[i], z = block.z[i];
      const double around = std::max(1e-6, std::sqrt(x * x + y * y));
      const double slope = std::sqrt(east[i] * east[i] + north[i] * north[i]);
      const double e = east[i] / std::max(1e-9, slope), n = north[i] / std::max(1e-9, slope);
      out.fall_east[i] = e;
      out.fall_north[i] = n;
      out.fall_x[i] = (-y * e - z * x * n) / around;
      out.fall_y[i] = (x * e - z * y * n) / around;
      out.fall_z[i] = around * n;
    }
  });
}

}  // namespace mars::embedded
