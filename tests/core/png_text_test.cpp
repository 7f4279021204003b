// Text in PNG files, and files that are not whole.
#include "vpe/core/image/png_text.h"

#include "tests/support/support.h"
#include "vpe/core/image/image.h"

namespace {

using vpe::core::PngText;

std::vector<std::uint8_t> image() {
  std::vector<vpe::base::Rgb> pixels(31 * 17);
  for (std::size_t n = 0; n < pixels.size(); ++n) pixels[n] = {static_cast<std::uint8_t>(n * 7), 40, 200};
  return vpe::core::encode_png(pixels, 31, 17);
}

TEST(PngText, IsReadBackAndLeavesThePixels) {
  const std::vector<PngText> texts{{"vpe:a", "{\"x\":1}"}, {"Software", ""}, {"b", std::string(5000, 'z')}};
  const auto bytes = vpe::core::with_png_text(image(), texts);
  EXPECT_EQ(vpe::core::read_png_text(bytes), texts);
  EXPECT_EQ(vpe::core::decode_png(bytes).pixels, vpe::core::decode_png(image()).pixels);
  EXPECT_EQ(vpe::core::read_png_text(image()), std::vector<PngText>{});
}

TEST(PngText, AnyFlippedBitAndAnyCutIsSeen) {
  const auto whole = vpe::core::with_png_text(image(), std::vector<PngText>{{"key", "value"}});
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    auto bytes = whole;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    EXPECT_FALSE(vpe::core::read_png_text(bytes)) << "bit " << bit;
  }
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(vpe::core::read_png_text(std::span(whole).first(size))) << size;
  }
  auto longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(vpe::core::read_png_text(longer));
}

TEST(PngText, NeedsAPng) {
  const std::vector<std::uint8_t> other(100, 7);
  EXPECT_THROW(vpe::core::with_png_text(other, std::vector<PngText>{}), vpe::core::ImageError);
}

}  // namespace
