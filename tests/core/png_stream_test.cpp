// PNG files written row by row, and the chunks that they consist of.
#include "vpe/core/image/png_stream.h"

#include <stdexcept>

#include "tests/support/support.h"
#include "vpe/core/image/image.h"
#include "vpe/core/image/png_chunks.h"

namespace vpe::core {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Parts like the left neighbour, parts like the row above, parts like neither.
Bytes rows_of(std::size_t width, std::size_t height, std::size_t channels) {
  test_support::Random random(5);
  Bytes rows;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t value = y % 3 == 0 ? 4 * x : y % 3 == 1 ? 7 * y + x % 2 : x * y / 16;
        rows.push_back(static_cast<std::uint8_t>(value + c + static_cast<std::size_t>(random.integer(0, 2))));
      }
    }
  }
  return rows;
}

Bytes encoded(const Bytes& rows, std::int64_t width, std::int64_t height, PngStreamOptions options,
              std::int64_t rows_a_call) {
  Bytes file;
  const auto channels = static_cast<std::int64_t>(options.channels);
  PngStream stream(width, height, std::move(options), [&file](std::span<const std::uint8_t> bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
  });
  for (std::int64_t y = 0; y < height; y += rows_a_call) {
    const std::int64_t count = std::min(rows_a_call, height - y);
    stream.write(std::span(rows).subspan(static_cast<std::size_t>(y * width * channels),
                                         static_cast<std::size_t>(count * width * channels)));
  }
  stream.finish();
  return file;
}

std::vector<base::Rgb> colours_of(const Bytes& rows, std::size_t channels) {
  std::vector<base::Rgb> colours;
  for (std::size_t n = 0; n < rows.size(); n += channels)
    colours.push_back({rows[n], rows[n + 1], rows[n + 2]});
  return colours;
}

TEST(PngStream, KeepsPixelsHoweverTheyAreCutAndPacked) {
  constexpr std::int64_t kWidth = 1201;
  constexpr std::int64_t kHeight = 701;  // several blocks
  for (const int channels : {3, 4}) {
    const Bytes rows = rows_of(kWidth, kHeight, static_cast<std::size_t>(channels));
    for (const PngPacking packing : {PngPacking::kBlocks, PngPacking::kWhole}) {
      for (const std::int64_t rows_a_call : {std::int64_t{1}, std::int64_t{64}, kHeight}) {
        PngStreamOptions options;
        options.channels = channels;
        options.packing = packing;
        options.compression = rows_a_call == 64 ? 6 : 1;
        const RgbImage image = decode_png(encoded(rows, kWidth, kHeight, options, rows_a_call));
        EXPECT_EQ(image.width, kWidth);
        ASSERT_EQ(image.pixels, colours_of(rows, static_cast<std::size_t>(channels)));
      }
    }
  }
}

TEST(PngStream, NumberOfThreadsChangesNoByte) {
  const Bytes rows = rows_of(900, 900, 3);
  const Bytes alone = encoded(rows, 900, 900, {}, 900);
  for (const int threads : {1, 4}) {
    base::ThreadPool pool(threads);
    PngStreamOptions options;
    options.pool = &pool;
    EXPECT_EQ(encoded(rows, 900, 900, options, 900), alone) << threads;
  }
}

TEST(PngStream, RefusesRowsThatAreNotOfTheImage) {
  for (const PngPacking packing : {PngPacking::kBlocks, PngPacking::kWhole}) {
    PngStreamOptions options;
    options.packing = packing;
    PngStream stream(4, 3, options, [](std::span<const std::uint8_t>) {});
    EXPECT_THROW(stream.finish(), std::logic_error);
    EXPECT_THROW(stream.write(Bytes(11)), std::logic_error);
    stream.write(Bytes(24));
    EXPECT_THROW(stream.write(Bytes(24)), std::logic_error);
    EXPECT_THROW(stream.finish(), std::logic_error);
    stream.write(Bytes(12));
    EXPECT_NO_THROW(stream.finish());
  }
}

TEST(PngChunks, AreFoundInOrderWithTheirData) {
  PngStreamOptions options;
  options.xmp = "<packet/>";
  const Bytes file = encoded(rows_of(5, 5, 3), 5, 5, options, 5);
  PngChunks chunks(file);
  std::vector<std::string> types;
  while (const auto chunk = chunks.next()) {
    types.push_back(chunk->type);
    EXPECT_TRUE(chunks.has_right_checksum(*chunk));
    const std::string data = chunks.checked_data(*chunk);
    EXPECT_EQ(data.size(), chunk->length);
    if (chunk->type == "iTXt") {
      EXPECT_TRUE(data.starts_with(kPngXmpKeyword) && data.ends_with("<packet/>"));
    }
    if (chunk->type == "IEND") {
      EXPECT_EQ(chunk->end(), file.size());
    }
  }
  EXPECT_EQ(types, (std::vector<std::string>{"IHDR", "sRGB", "iTXt", "IDAT", "IDAT", "IEND"}));
  EXPECT_FALSE(chunks.next());
}

TEST(PngChunks, DamageIsAnError) {
  const Bytes file = encoded(rows_of(5, 5, 3), 5, 5, {}, 5);
  const auto walk = [](std::span<const std::uint8_t> bytes) {
    PngChunks chunks(bytes);
    while (const auto chunk = chunks.next()) chunks.checked_data(*chunk);
  };
  EXPECT_NO_THROW(walk(file));
  for (std::size_t size = kPngSignature.size(); size < file.size(); ++size)
    EXPECT_THROW(walk(std::span(file).first(size)), ImageError) << size;
  for (std::size_t at = kPngSignature.size(); at < file.size(); ++at) {
    Bytes bad = file;
    bad[at] ^= 0x10;
    EXPECT_THROW(walk(bad), ImageError) << at;
  }
}

}  // namespace
}  // namespace vpe::core
