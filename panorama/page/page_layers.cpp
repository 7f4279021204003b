#include "panorama/page/page_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "panorama/page/band_reader.h"
#include "panorama/page/base64.h"
#include "panorama/viewer/pixel_probe.h"
#include "vpe/core/json_text.h"

namespace panorama {

namespace {

struct KnownBand {
  std::string_view name;
  double step;
  bool is_log;
};
// A step of 2e-4 of the logarithm keeps range within 0.01 percent; one of 2e-7 degrees keeps places within 6 mm
// on Mars.
constexpr std::array<KnownBand, 7> kKnownBands{{{"range_m", 2e-4, true},
                                                {"lon_deg", 2e-7, false},
                                                {"lat_deg", 2e-7, false},
                                                {"elevation_m", 0.02, false},
                                                {"slope_deg", 0.02, false},
                                                {"incidence_deg", 0.02, false},
                                                {"synthetic", 1.0, false}}};
// Bytes of numbers of other bands.
constexpr double kBandSteps = (1 << 24) - 2;

PageBand band_named(const std::string& name) {
  const auto* found = std::find_if(kKnownBands.begin(), kKnownBands.end(),
                                   [&](const KnownBand& band) { return band.name == name; });
  if (found == kKnownBands.end()) return {name, 0.0, false};
  return {name, found->step, found->is_log};
}

// Returns the number of columns or rows c for which c * step + step / 2 is inside.
std::int64_t thinned_px(std::int64_t side_px, int step) {
  return std::max<std::int64_t>((side_px - 1 - step / 2 + step) / step, 1);
}

}  // namespace

PageLayers layers_of(const PanoramaDescription& description, int step) {
  PageLayers layers;
  const PanoramaMap& map = description.map;
  layers.step = std::max(step, 1);
  if (step == 0) {
    while (thinned_px(map.width_px, layers.step) * thinned_px(map.height_px, layers.step) > kMostLayerPixels)
      layers.step *= 2;
  }
  layers.width_px = thinned_px(map.width_px, layers.step);
  layers.height_px = thinned_px(map.height_px, layers.step);
  if (description.planes.empty()) return layers;
  if (const auto result = PixelProbe(description).at_pixel(0.5, 0.5)) {
    for (const PlaneValue& value : result->values) layers.bands.push_back(band_named(value.name));
  }
  return layers;
}

PackedBand pack_band(std::span<const double> values, const PageBand& band) {
  const auto is_value = [&](double value) { return std::isfinite(value) && (!band.is_log || value > 0.0); };
  const auto shown = [&](double value) { return band.is_log ? std::log(value) : value; };
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : values) {
    if (!is_value(value)) continue;
    low = std::min(low, shown(value));
    high = std::max(high, shown(value));
  }
  PackedBand packed;
  if (!(low <= high)) return packed;
  packed.offset = low;
  packed.step = band.step > 0.0 ? band.step : (high - low) / kBandSteps;
  if (!(packed.step > 0.0)) packed.step = 1.0;
  // Numbers of six bytes are exact in JavaScript; values that would need more get a larger step.
  constexpr int kMostBytes = 6;
  constexpr double kMostNumber = 281474976710654.0;  // 2^48 - 2
  packed.step = std::max(packed.step, (high - low) / kMostNumber);
  const auto number_of = [&](double value) {
    return static_cast<std::uint64_t>(std::llround((shown(value) - low) / packed.step)) + 1;
  };
  const std::uint64_t most = static_cast<std::uint64_t>(std::llround((high - low) / packed.step)) + 1;
  packed.bytes = 1;
  while (packed.bytes < kMostBytes && most >> (8 * packed.bytes) != 0) ++packed.bytes;
  packed.data.reserve(values.size() * static_cast<std::size_t>(packed.bytes));
  for (const double value : values) {
    const std::uint64_t number = is_value(value) ? number_of(value) : 0;
    for (int n = 0; n < packed.bytes; ++n)
      packed.data.push_back(static_cast<std::uint8_t>(number >> (8 * n) & 255));
  }
  return packed;
}

struct LayerPacker::Readers {
  std::vector<BandReader> planes;
};

LayerPacker::LayerPacker(const PanoramaDescription& description, PageLayers layers)
    : description_(description), layers_(std::move(layers)), readers_([this] {
        auto readers = std::make_unique<Readers>();
        for (const PlaneName& plane : description_.planes)
          readers->planes.emplace_back(description_.image.parent_path() / plane.file);
        return readers;
      }) {}

LayerPacker::~LayerPacker() = default;

std::string LayerPacker::tile_script(std::int64_t column, std::int64_t row) const {
  const std::int64_t x = column * kLayerTile_px;
  const std::int64_t y = row * kLayerTile_px;
  const std::int64_t width_px = std::min(kLayerTile_px, layers_.width_px - x);
  const std::int64_t height_px = std::min(kLayerTile_px, layers_.height_px - y);
  const std::int64_t step = layers_.step;
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  const auto readers = readers_.acquire();
  std::size_t first_band = 0;
  for (BandReader& plane : readers->planes) {
    const std::size_t bands = plane.bands();
    const std::size_t row_numbers = static_cast<std::size_t>(width_px) * bands;
    std::vector<double> numbers(row_numbers * static_cast<std::size_t>(height_px));
    for (std::int64_t n = 0; n < height_px; ++n) {
      plane.read_row(x * step + step / 2, (y + n) * step + step / 2, step, width_px,
                     numbers.data() + static_cast<std::size_t>(n) * row_numbers);
    }
    std::vector<double> values(numbers.size() / bands);
    for (std::size_t band = 0; band < bands; ++band) {
      for (std::size_t n = 0; n < values.size(); ++n) values[n] = numbers[n * bands + band];
      const PageBand& known = layers_.bands.at(first_band + band);
      const PackedBand packed = pack_band(values, known);
      json[known.name] = {{"bytes", packed.bytes},
                          {"offset", packed.offset},
                          {"scale", packed.step},
                          {"log", known.is_log},
                          {"data", to_base64(packed.data)}};
    }
    first_band += bands;
  }
  const std::string name = std::to_string(column) + "_" + std::to_string(row);
  return "vpeLayers(\"" + name + "\"," + vpe::core::json_text(json) + ");\n";
}

}  // namespace panorama
