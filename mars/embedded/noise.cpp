#include "mars/embedded/noise.h"

#include "mars/embedded/block.h"
#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

struct Rotation {
  double m[9];
};

// Returns the rotation of an integer quaternion.
constexpr Rotation rotation_of(int wi, int xi, int yi, int zi) {
  const double w = wi, x = xi, y = yi, z = zi;
  const double n = w * w + x * x + y * y + z * z;
  return {{(w * w + x * x - y * y - z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n,
           2 * (x * y + w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z - w * x) / n,
           2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, (w * w - x * x - y * y + z * z) / n}};
}

// The lattices of consecutive seeds are rotated against the body's axes and each other.
constexpr Rotation kRotations[8] = {
    rotation_of(5, 2, 1, 3),  rotation_of(4, -3, 2, 1),   rotation_of(3, 1, -2, 4), rotation_of(6, 2, -3, 1),
    rotation_of(2, 3, 1, -5), rotation_of(7, -1, -3, -2), rotation_of(3, -4, 2, 2), rotation_of(5, 3, 4, -1)};

// Scale that makes the standard deviation 1 for gradients with components uniform in +-511.5.
constexpr double kUnit = 1.0 / 97.9;

template <typename Real>
struct NoiseLattice {
  alignas(64) Lane<std::int32_t> ix, iy, iz;
  alignas(64) Lane<Real> fx, fy, fz;
};

template <typename Real>
[[gnu::always_inline]] inline Real fade(Real t) {
  return t * t * t * (t * (t * Real(6) - Real(15)) + Real(10));
}

template <typename Real>
struct Gradient {
  Real x, y, z;
};

template <typename Real>
[[gnu::always_inline]] inline Gradient<Real> gradient(std::uint32_t h) {
  h ^= h >> 15;
  h *= 0x2c1b3c6dU;
  h ^= h >> 14;
  return {static_cast<Real>(static_cast<std::int32_t>(h >> 22)) - Real(511.5),
          static_cast<Real>(static_cast<std::int32_t>((h >> 12) & 1023U)) - Real(511.5),
          static_cast<Real>(static_cast<std::int32_t>((h >> 2) & 1023U)) - Real(511.5)};
}

// Holds hashes of a cell's corners. The bits of the index mean: 1 upper x, 2 upper y, 4 upper z.
struct Corners {
  std::uint32_t h[8];
};
[[gnu::always_inline]] inline Corners corners(std::int32_t ix, std::int32_t iy, std::int32_t iz,
                                              std::uint32_t salt) {
  constexpr std::uint32_t kX = 0x8da6b343U;
  constexpr std::uint32_t kY = 0xd8163841U;
  constexpr std::uint32_t kZ = 0xcb1ab31fU;
  const std::uint32_t x0 = static_cast<std::uint32_t>(ix) * kX ^ salt;
  const std::uint32_t x1 = (static_cast<std::uint32_t>(ix) * kX + kX) ^ salt;
  const std::uint32_t y0 = static_cast<std::uint32_t>(iy) * kY;
  const std::uint32_t y1 = y0 + kY;
  const std::uint32_t z0 = static_cast<std::uint32_t>(iz) * kZ;
  const std::uint32_t z1 = z0 + kZ;
  return {{x0 ^ y0 ^ z0, x1 ^ y0 ^ z0, x0 ^ y1 ^ z0, x1 ^ y1 ^ z0, x0 ^ y0 ^ z1, x1 ^ y0 ^ z1, x0 ^ y1 ^ z1,
           x1 ^ y1 ^ z1}};
}

// Returns the noise at a place of a cell, from the gradients at its corners.
template <typename Real, typename GradientAt>
[[gnu::always_inline]] inline Real blend(Real fx, Real fy, Real fz, const GradientAt& gradient_at) {
  const auto slope = [&](int k, Real x, Real y, Real z) {
    const Gradient<Real> g = gradient_at(k);
    return g.x * x + g.y * y + g.z * z;
  };
  const Real gx = fx - Real(1), gy = fy - Real(1), gz = fz - Real(1);
  const Real a = fade(fx), b = fade(fy), c = fade(fz);
  const Real low = mix(mix(slope(0, fx, fy, fz), slope(1, gx, fy, fz), a),
                       mix(slope(2, fx, gy, fz), slope(3, gx, gy, fz), a), b);
  const Real high = mix(mix(slope(4, fx, fy, gz), slope(5, gx, fy, gz), a),
                        mix(slope(6, fx, gy, gz), slope(7, gx, gy, gz), a), b);
  return mix(low, high, c) * static_cast<Real>(kUnit);
}

template <typename Real>
[[gnu::always_inline]] inline void noise_body(const double* __restrict x, const double* __restrict y,
                                              const double* __restrict z, std::size_t padded, double scale,
                                              std::uint32_t seed, Real* __restrict out) {
  if (padded == 0) return;
  const Rotation& t = kRotations[seed & 7U];
  const double shift = static_cast<double>(seed & 0xffffU) * 0.618;
  NoiseLattice<Real> cell;
  for (std::size_t i = 0; i < padded; ++i) {
    const double u = (t.m[0] * x[i] + t.m[1] * y[i] + t.m[2] * z[i]) * scale + shift;
    const double v = (t.m[3] * x[i] + t.m[4] * y[i] + t.m[5] * z[i]) * scale - shift;
    const double w = (t.m[6] * x[i] + t.m[7] * y[i] + t.m[8] * z[i]) * scale + 0.5;
    cell.ix[i] = floor_int(u);
    cell.iy[i] = floor_int(v);
    cell.iz[i] = floor_int(w);
    cell.fx[i] = static_cast<Real>(u - static_cast<double>(cell.ix[i]));
    cell.fy[i] = static_cast<Real>(v - static_cast<double>(cell.iy[i]));
    cell.fz[i] = static_cast<Real>(w - static_cast<double>(cell.iz[i]));
  }
  const std::uint32_t salt = seed * 0x9e3779b9U;
  std::int32_t apart = 0;
  for (std::size_t i = 0; i < padded; ++i) {
    apart |= (cell.ix[i] ^ cell.ix[0]) | (cell.iy[i] ^ cell.iy[0]) | (cell.iz[i] ^ cell.iz[0]);
  }
  if (apart == 0) {
    // The block lies within one cell, as is usual for long wavelengths: the gradients are computed once.
    const Corners all = corners(cell.ix[0], cell.iy[0], cell.iz[0], salt);
    Gradient<Real> gradients[8];
    for (int k = 0; k < 8; ++k) gradients[k] = gradient<Real>(all.h[k]);
    for (std::size_t i = 0; i < padded; ++i)
      out[i] = blend(cell.fx[i], cell.fy[i], cell.fz[i], [&](int k) { return gradients[k]; });
    return;
  }
  for (std::size_t i = 0; i < padded; ++i) {
    const Corners own = corners(cell.ix[i], cell.iy[i], cell.iz[i], salt);
    out[i] = blend(cell.fx[i], cell.fy[i], cell.fz[i], [&](int k) { return gradient<Real>(own.h[k]); });
  }
}

template <typename Real>
void noise_at(const double* x, const double* y, const double* z, std::size_t padded, Simd simd, double scale,
              std::uint32_t seed, Real* out) {
  with_simd(simd, [&] { noise_body(x, y, z, padded, scale, seed, out); });
}

}  // namespace

void noise(const Block& block, double wavelength_m, std::uint32_t seed, Lane<float>& out) {
  noise_at(block.x.data(), block.y.data(), block.z.data(), block.padded, block.simd, kRadius_m / wavelength_m,
           seed, out.data());
}

void noise(const Block& block, double wavelength_m, std::uint32_t seed, Lane<double>& out) {
  noise_at(block.x.data(), block.y.data(), block.z.data(), block.padded, block.simd, kRadius_m / wavelength_m,
           seed, out.data());
}

void noise(const Points& points_m, std::size_t padded, Simd simd, double wavelength_m, std::uint32_t seed,
           Lane<float>& out) {
  noise_at(points_m.x.data(), points_m.y.data(), points_m.z.data(), padded, simd, 1.0 / wavelength_m, seed,
           out.data());
}

}  // namespace mars::embedded
