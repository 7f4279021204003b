#include "vpe/base/json_integer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace vpe::base {
namespace {

using nlohmann::json;

TEST(JsonInteger, TakesWholeNumbersThatFit) {
  EXPECT_EQ(json_integer<int>(json::parse("-12")), -12);
  EXPECT_EQ(json_integer<int>(json(2147483647)), 2147483647);
  EXPECT_EQ(json_integer<std::int64_t>(json::parse("-9223372036854775808")),
            std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(json_integer<std::uint64_t>(json::parse("18446744073709551615")),
            std::numeric_limits<std::uint64_t>::max());
}

TEST(JsonInteger, RefusesAllElse) {
  for (const char* bad : {"1e300", "-1e300", "2.5", "7.0", "2147483648", "-2147483649", "99999999999999999999",
                          "true", "null", "\"7\"", "[7]"})
    EXPECT_THROW((void)json_integer<int>(json::parse(bad)), json::type_error) << bad;
  EXPECT_THROW((void)json_integer<std::uint64_t>(json(-1)), json::type_error);
  EXPECT_THROW((void)json_integer<std::int64_t>(json::parse("9223372036854775808")), json::type_error);
}

}  // namespace
}  // namespace vpe::base
