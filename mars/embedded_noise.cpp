#include "mars/embedded_noise.h"

#include "mars/embedded_math.h"

namespace mars::embedded {

namespace {

struct Turn {
  double m[9];
};

// Rotation of an integer quaternion.
constexpr Turn turn_of(int wi, int xi, int yi, int zi) {
  const double w = wi, x = xi, y = yi, z = zi;
  const double n = w * w + x * x + y * y + z * z;
  return {{(w * w + x * x - y * y - z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n,
           2 * (x * y + w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z - w * x) / n,
           2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, (w * w - x * x - y * y + z * z) / n}};
}

// The lattice of each seed lies askew to the body's axes and to the next one's.
constexpr Turn kTurns[8] = {turn_of(5, 2, 1, 3),  turn_of(4, -3, 2, 1), turn_of(3, 1, -2, 4),
                            turn_of(6, 2, -3, 1), turn_of(2, 3, 1, -5), turn_of(7, -1, -3, -2),
                            turn_of(3, -4, 2, 2), turn_of(5, 3, 4, -1)};

// Scale that makes the standard deviation 1 for gradients with components uniform in +-511.5.
constexpr double kUnit = 1.0 / 97.9;

template <typename Real>
struct Lattice {
  alignas(64) Lane<std::int32_t> ix, iy, iz;
  alignas(64) Lane<Real> fx, fy, fz;
};

template <typename Real>
[[gnu::always_inline]] inline Real fade(Real t) {
  return t * t * t * (t * (t * Real(6) - Real(15)) + Real(10));
}

template <typename Real>
[[gnu::always_inline]] inline Real corner(std::uint32_t h, Real x, Real y, Real z) {
  h ^= h >> 15;
  h *= 0x2c1b3c6dU;
  h ^= h >> 14;
  const auto gx = static_cast<Real>(static_cast<std::int32_t>(h >> 22)) - Real(511.5);
  const auto gy = static_cast<Real>(static_cast<std::int32_t>((h >> 12) & 1023U)) - Real(511.5);
  const auto gz = static_cast<Real>(static_cast<std::int32_t>((h >> 2) & 1023U)) - Real(511.5);
  return gx * x + gy * y + gz * z;
}

template <typename Real>
[[gnu::always_inline]] inline void noise_body(const double* __restrict x, const double* __restrict y,
                                              const double* __restrict z, std::size_t padded, double scale,
                                              std::uint32_t seed, Real* __restrict out) {
  const Turn& t = kTurns[seed & 7U];
  const double shift = static_cast<double>(seed & 0xffffU) * 0.618;
  Lattice<Real> cell;
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
  constexpr std::uint32_t kX = 0x8da6b343U;
  constexpr std::uint32_t kY = 0xd8163841U;
  constexpr std::uint32_t kZ = 0xcb1ab31fU;
  const std::uint32_t salt = seed * 0x9e3779b9U;
  for (std::size_t i = 0; i < padded; ++i) {
    const std::uint32_t x0 = static_cast<std::uint32_t>(cell.ix[i]) * kX ^ salt;
    const std::uint32_t x1 = (static_cast<std::uint32_t>(cell.ix[i]) * kX + kX) ^ salt;
    const std::uint32_t y0 = static_cast<std::uint32_t>(cell.iy[i]) * kY;
    const std::uint32_t y1 = y0 + kY;
    const std::uint32_t z0 = static_cast<std::uint32_t>(cell.iz[i]) * kZ;
    const std::uint32_t z1 = z0 + kZ;
    const Real fx = cell.fx[i], fy = cell.fy[i], fz = cell.fz[i];
    const Real gx = fx - Real(1), gy = fy - Real(1), gz = fz - Real(1);
    const Real a = fade(fx), b = fade(fy), c = fade(fz);
    const Real v000 = corner(x0 ^ y0 ^ z0, fx, fy, fz);
    const Real v100 = corner(x1 ^ y0 ^ z0, gx, fy, fz);
    const Real v010 = corner(x0 ^ y1 ^ z0, fx, gy, fz);
    const Real v110 = corner(x1 ^ y1 ^ z0, gx, gy, fz);
    const Real v001 = corner(x0 ^ y0 ^ z1, fx, fy, gz);
    const Real v101 = corner(x1 ^ y0 ^ z1, gx, fy, gz);
    const Real v011 = corner(x0 ^ y1 ^ z1, fx, gy, gz);
    const Real v111 = corner(x1 ^ y1 ^ z1, gx, gy, gz);
    const Real low = mix(mix(v000, v100, a), mix(v010, v110, a), b);
    const Real high = mix(mix(v001, v101, a), mix(v011, v111, a), b);
    out[i] = mix(low, high, c) * static_cast<Real>(kUnit);
  }
}

template <typename Real>
void noise_plain(const double* x, const double* y, const double* z, std::size_t padded, double scale,
                 std::uint32_t seed, Real* out) {
  noise_body(x, y, z, padded, scale, seed, out);
}

#if defined(__x86_64__) && defined(__GNUC__)
template <typename Real>
[[gnu::target("avx2")]] void noise_avx2(const double* x, const double* y, const double* z, std::size_t padded,
                                        double scale, std::uint32_t seed, Real* out) {
  noise_body(x, y, z, padded, scale, seed, out);
}
#else
template <typename Real>
constexpr auto noise_avx2 = noise_plain<Real>;
#endif

template <typename Real>
void noise_at(const double* x, const double* y, const double* z, std::size_t padded, Simd simd, double scale,
              std::uint32_t seed, Real* out) {
  const auto run = simd == Simd::kAvx2 ? noise_avx2<Real> : noise_plain<Real>;
  run(x, y, z, padded, scale, seed, out);
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
