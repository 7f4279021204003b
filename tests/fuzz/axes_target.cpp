#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/iau_crs.h"
#include "tests/fuzz/targets.h"

namespace fuzz {
namespace {

// Spheres, ellipsoids, three axes, longitudes to the west, and a projected system.
constexpr std::array kCodes{49900, 49901, 49902, 49910, 49911, 49912, 2000060, 200000400, 399900, 30100};
constexpr std::size_t kNumbers = 8;

double number_at(std::span<const std::uint8_t> bytes, std::size_t n) {
  std::int16_t value = 0;
  std::memcpy(&value, bytes.data() + 2 * n, 2);
  return value / 64.0;
}

// Returns whether the outermost pixel centres have at most 90 degrees on a map axis.
bool may_be_latitudes(const std::array<double, 6>& g, std::size_t axis, const mars::PixelGrid& grid) {
  double most = 0;
  for (const double column : {0.5, grid.width - 0.5}) {
    for (const double row : {0.5, grid.height - 0.5})
      most = std::max(most, std::abs(g[3 * axis] + column * g[3 * axis + 1] + row * g[3 * axis + 2]));
  }
  return most <= 90;
}

// Bytes: code, order of the axes, then geotransform and size as 16-bit numbers.
void run_axes(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 2 + 2 * kNumbers) return;
  const mars::GdalScope scope;
  OGRSpatialReference crs;
  const std::string code = "IAU_2015:" + std::to_string(kCodes.at(bytes[0] % kCodes.size()));
  if (crs.SetFromUserInput(code.c_str()) != OGRERR_NONE) return;
  const bool is_west = code.ends_with("1") && crs.IsGeographic() != 0;
  crs.SetDataAxisToSRSAxisMapping(bytes[1] % 2 == 0 ? std::vector{1, 2} : std::vector{2, 1});
  const auto numbers = bytes.subspan(2);
  std::array<double, 6> to_map{};
  for (std::size_t n = 0; n < 6; ++n) to_map.at(n) = number_at(numbers, n);
  mars::PixelGrid grid;
  grid.width = 1 + static_cast<int>(std::abs(number_at(numbers, 6)));
  grid.height = 1 + static_cast<int>(std::abs(number_at(numbers, 7)));

  OGRSpatialReference plain = crs;
  if (mars::remove_iau_codes(plain)) {
    require(plain.IsGeographic() == crs.IsGeographic(), "the kind of system stays");
    require(std::abs(plain.GetSemiMajor() - crs.GetSemiMajor()) <= 1e-6, "the body stays");
    require(plain.GetDataAxisToSRSAxisMapping() == crs.GetDataAxisToSRSAxisMapping(), "the axes stay");
  }
  mars::restored_iau_crs(crs);
  const std::vector<int> before = crs.GetDataAxisToSRSAxisMapping();
  const bool is_decided = mars::correct_axis_order(crs, to_map, grid);
  std::vector<int> after = crs.GetDataAxisToSRSAxisMapping();
  if (!is_west) {
    require(is_decided && after == before, "only longitudes that count west are corrected");
    return;
  }
  const bool x = may_be_latitudes(to_map, 0, grid);
  const bool y = may_be_latitudes(to_map, 1, grid);
  require(is_decided == !(x && y), "both orders are possible where both axes may have latitudes");
  // The first axis of these systems is the latitude.
  if (x != y) require(after[x ? 0 : 1] == 1, "latitudes run where they can");
  std::ranges::sort(after);
  require(after == std::vector{1, 2}, "each axis once");
}

Bytes axes_seed(std::uint8_t code, std::uint8_t order, const std::array<double, kNumbers>& numbers) {
  Bytes seed{code, order};
  for (const double number : numbers) {
    const auto value = static_cast<std::int16_t>(std::lround(number * 64));
    std::array<std::uint8_t, 2> raw{};
    std::memcpy(raw.data(), &value, 2);
    seed.insert(seed.end(), raw.begin(), raw.end());
  }
  return seed;
}

std::vector<Bytes> axes_seeds() {
  std::vector<Bytes> seeds;
  for (std::uint8_t code = 0; code < kCodes.size(); ++code) {
    for (const std::uint8_t order : {std::uint8_t{0}, std::uint8_t{1}}) {
      seeds.push_back(axes_seed(code, order, {-180, 2, 0, 90, 0, -2, 180, 90}));
      seeds.push_back(axes_seed(code, order, {0, 2, 0, 90, 0, -2, 180, 90}));
      seeds.push_back(axes_seed(code, order, {90, 0, -2, -180, 2, 0, 180, 90}));
      seeds.push_back(axes_seed(code, order, {10, 0.25, 0, 20, 0, -0.25, 40, 40}));
    }
  }
  return seeds;
}

}  // namespace

const Target kAxes{"axes", run_axes, axes_seeds};

}  // namespace fuzz
