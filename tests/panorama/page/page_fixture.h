// Panoramas on disk, and what a page's scripts hold.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "panorama/image/big_tiff.h"
#include "panorama/metadata/open_panorama.h"
#include "panorama/page/page_writer.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"
#include "vpe/core/image/image.h"

namespace page_test {

namespace fs = std::filesystem;

inline std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Decodes base64, as a browser does.
inline std::vector<std::uint8_t> from_base64(const std::string& text) {
  static const std::string kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    group = group << 6 | static_cast<std::uint32_t>(kLetters.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(group >> bits & 255));
  }
  return bytes;
}

// Returns the JSON between the first `begin` of a script and its last `end`.
inline nlohmann::json json_in(const std::string& script, const std::string& begin, const std::string& end) {
  const std::size_t from = script.find(begin) + begin.size();
  return nlohmann::json::parse(script.substr(from, script.rfind(end) - from));
}
inline nlohmann::json data_of(const fs::path& folder) {
  return json_in(text_of(folder / "data.js"), "vpeData = ", ";");
}

// Returns the decoded picture of a tile.
inline vpe::core::RgbImage tile_of(const fs::path& folder, const std::string& name) {
  const std::string script = text_of(folder / ("tiles/" + name + ".js"));
  const nlohmann::json words = nlohmann::json::parse("[" + script.substr(8, script.rfind(')') - 8) + "]");
  EXPECT_EQ(words.at(0), name);
  const auto bytes = from_base64(words.at(2).get<std::string>());
  return words.at(1) == "image/png" ? vpe::core::decode_png(bytes) : vpe::core::decode_jpeg(bytes);
}

inline vpe::base::Rgb colour_at(std::int64_t x, std::int64_t y) {
  return {static_cast<std::uint8_t>(x % 251), static_cast<std::uint8_t>(y % 241),
          static_cast<std::uint8_t>((x / 251 * 16 + y / 241) % 256)};
}
inline vpe::core::RgbImage pattern(int width, int height) {
  vpe::core::RgbImage image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.pixels.push_back(colour_at(x, y));
  return image;
}

// The range and height that the layers of a sample have at a pixel.
inline float range_at(std::int64_t x, std::int64_t y) {
  return static_cast<float>(2.0 + 37.5 * double(x) + double(y));
}
inline double lon_at(std::int64_t x, std::int64_t y) { return -59.2 + 1e-5 * double(x) - 3e-6 * double(y); }
inline bool is_sky(std::int64_t y) { return y < 20; }

template <class Value>
void write_layer(const fs::path& path, std::int64_t width_px, std::int64_t height_px, int samples,
                 const Value& value) {
  vpe::base::OutputFile file(path);
  const panorama::SampleFormat format{samples, samples == 2 ? 8 : 4};
  {
    panorama::BigTiffWriter writer(file, width_px, height_px, format, {"test", "", {}});
    for (std::int64_t row = 0; row < writer.tiles_down(); ++row) {
      for (std::int64_t column = 0; column < writer.tiles_across(); ++column) {
        std::vector<std::uint8_t> tile(format.tile_bytes());
        std::uint8_t* out = tile.data();
        for (std::int64_t n = 0; n < std::int64_t{panorama::kTile_px} * panorama::kTile_px; ++n) {
          const std::int64_t x = std::min(column * panorama::kTile_px + n % panorama::kTile_px, width_px - 1);
          const std::int64_t y = std::min(row * panorama::kTile_px + n / panorama::kTile_px, height_px - 1);
          value(x, y, out);
          out += format.pixel_bytes();
        }
        writer.put(column, row, panorama::pack_tile(tile, format));
      }
    }
    writer.finish();
  }
  file.commit();
}

// A cylinder of a full circle with range and places, and its JSON.
inline constexpr int kWidth = 1300;
inline constexpr int kHeight = 600;
inline fs::path write_sample(const fs::path& folder, const std::string& name = "a.png",
                             const std::string& more = "") {
  fs::create_directories(folder);
  vpe::core::write_image(folder / name, pattern(kWidth, kHeight).pixels, kWidth, kHeight);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  write_layer(folder / "a.range.tif", kWidth, kHeight, 1,
              [](std::int64_t x, std::int64_t y, std::uint8_t* out) {
                const float value = is_sky(y) ? kNan : range_at(x, y);
                std::memcpy(out, &value, sizeof value);
              });
  write_layer(folder / "a.lonlat.tif", kWidth, kHeight, 2,
              [](std::int64_t x, std::int64_t y, std::uint8_t* out) {
                const std::array<double, 2> place{is_sky(y) ? double{kNan} : lon_at(x, y),
                                                  is_sky(y) ? double{kNan} : 0.5};
                std::memcpy(out, place.data(), sizeof place);
              });
  std::ofstream json((folder / name).replace_extension(".json"));
  json << R"({"image": ")" << name << R"(", "projection": "cylinder", "width": 1300, "height": 600,
    "azimuth_deg_at_left": 10, "columns_per_turn": 1300, "horizon_row": 300,
    "planes": {"range": "a.range.tif", "lonlat": "a.lonlat.tif"})"
       << more << "}";
  return folder / name;
}

// A panorama that is opened in memory.
struct Opened {
  panorama::PanoramaDescription description;
  std::unique_ptr<panorama::TiledImage> image;

  explicit Opened(const fs::path& path) : description(panorama::describe(path)) {
    image = panorama::open_tiled_image(description.image, description.format, {});
  }
  panorama::PageContent content() const {
    return {"", description, {*image, {}, description.map}, std::nullopt, {}};
  }
};

inline panorama::PageOptions lossless() {
  panorama::PageOptions options;
  options.tiles = panorama::PageTileFormat::kPng;
  return options;
}

template <class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const std::exception& e) {
    return e.what();
  }
  return {};
}

}  // namespace page_test
