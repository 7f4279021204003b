// Photographs of made-up skylines, with what spoils real ones.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "panorama/match/photo_camera.h"
#include "panorama/match/skyline_profile.h"
#include "vpe/core/image/image.h"

namespace match_test {

using panorama::PhotoPose;
using panorama::PhotoShape;
using panorama::SkylineProfile;
using vpe::core::RgbImage;

// Portable numbers: the library's distributions differ between implementations.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double within(double low, double high) { return low + (high - low) * (next() / 4294967296.0); }
  double normal() {
    const double u = (next() + 1.0) / 4294967297.0;
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * within(0, 1));
  }

 private:
  double next() { return static_cast<double>(engine_()); }

  std::mt19937 engine_;
};

// Returns the skyline of ridges: waves of 1 to 200 periods round the circle, amplitudes falling with their number.
inline SkylineProfile ridges(std::uint32_t seed, double size_deg = 1.5, std::size_t samples = 7200) {
  Random random(seed);
  std::vector<double> elevations(samples, 1.5);
  for (int k = 1; k <= 200; ++k) {
    const double amplitude = size_deg * random.normal() / std::pow(k, 1.1);
    const double phase = random.within(0, 2 * std::numbers::pi);
    for (std::size_t n = 0; n < samples; ++n) {
      const double turn = static_cast<double>(n) / static_cast<double>(samples);
      elevations[n] += amplitude * std::sin(2 * std::numbers::pi * k * turn + phase);
    }
  }
  return SkylineProfile(std::move(elevations));
}

inline SkylineProfile flat() { return SkylineProfile(std::vector<double>(720, 0.3)); }

// Describes faults of a photograph.
struct Spoiling {
  double noise = 5;          // standard deviation of the pixels, of 255
  double vignetting = 0.35;  // loss of light in the corners
  double missing_deg = 10;   // azimuths without sky
  bool black = false;        // these have no data; else ground up to the upper edge
  double texture = 12;       // of the ground
};

namespace detail {

inline double lattice(std::uint32_t x, std::uint32_t y) {
  std::uint32_t h = x * 0x9E3779B1U ^ (y * 0x85EBCA77U + 0x27D4EB2FU);
  h ^= h >> 15U;
  h *= 0x2C1B3C6DU;
  h ^= h >> 12U;
  return (h & 0xFFFFU) / 65535.0;
}

// Smooth blotches of `size` pixels.
inline double blotch(double x, double y, double size) {
  const double u = x / size;
  const double v = y / size;
  const auto i = static_cast<std::uint32_t>(u);
  const auto j = static_cast<std::uint32_t>(v);
  const double s = u - i;
  const double t = v - j;
  return (lattice(i, j) * (1 - s) + lattice(i + 1, j) * s) * (1 - t) +
         (lattice(i, j + 1) * (1 - s) + lattice(i + 1, j + 1) * s) * t;
}

}  // namespace detail

// Returns a photograph of a skyline: 8 samples of each pixel from top to bottom.
inline RgbImage photograph(const SkylineProfile& profile, const PhotoShape& shape, const PhotoPose& pose,
                           const Spoiling& spoiling, std::uint32_t seed) {
  constexpr int kSamples = 8;
  Random random(seed);
  const panorama::DirectionFinder finder(shape, pose);
  const double pixels_per_degree = panorama::pixels_per_radian(shape, pose.fov_deg) * std::numbers::pi / 180;
  const double gap_px = spoiling.missing_deg * pixels_per_degree;
  const double gap = random.within(0, std::max(0.0, shape.width_px - gap_px));
  RgbImage image{shape.width_px, shape.height_px, {}};
  image.pixels.reserve(static_cast<std::size_t>(shape.width_px) * static_cast<std::size_t>(shape.height_px));
  for (int y = 0; y < shape.height_px; ++y) {
    for (int x = 0; x < shape.width_px; ++x) {
      const bool missing = x >= gap && x < gap + gap_px;
      double sky = 0;
      for (int k = 0; k < kSamples; ++k) {
        const auto d = finder.at(x + 0.5, y + (k + 0.5) / kSamples);
        if (!missing && d.elevation_deg > profile.elevation_deg(d.azimuth_deg)) sky += 1.0 / kSamples;
      }
      const double ground =
          95 + spoiling.texture * (2 * detail::blotch(x, y, 7) + 3 * detail::blotch(x, y, 40) - 2.5);
      const double u = (x - 0.5 * shape.width_px) / shape.width_px;
      const double v = (y - 0.5 * shape.height_px) / shape.height_px;
      const double light = 1 - spoiling.vignetting * 2 * (u * u + v * v);
      const double sky_level = 160 + 30.0 * y / shape.height_px;
      const double level = (sky * sky_level + (1 - sky) * ground) * light;
      const auto channel = [&](double factor) {
        const double value = spoiling.black && missing ? 0 : level * factor + spoiling.noise * random.normal();
        return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
      };
      const std::uint8_t r = channel(1.1);
      const std::uint8_t g = channel(0.95);
      image.pixels.push_back({r, g, channel(0.75)});
    }
  }
  return image;
}

}  // namespace match_test
