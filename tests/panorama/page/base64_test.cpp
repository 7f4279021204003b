#include "panorama/page/base64.h"

#include "tests/panorama/page/page_fixture.h"

namespace {

TEST(PageBase64, IsThatOfRfc4648) {
  const auto encoded = [](const std::string& text) {
    return panorama::to_base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(PageBase64, ComesBackForAllBytes) {
  test_support::Random random(4);
  for (int length = 0; length < 300; ++length) {
    std::vector<std::uint8_t> bytes;
    for (int n = 0; n < length; ++n) bytes.push_back(static_cast<std::uint8_t>(random.integer(0, 255)));
    ASSERT_EQ(page_test::from_base64(panorama::to_base64(bytes)), bytes);
  }
}

}  // namespace
