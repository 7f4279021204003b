// Numbers as text: parsing and formatting.

#include "vpe/base/number.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <limits>

// After GoogleTest, which it does not include.
#include <rapidcheck/gtest.h>

#include "tests/support/support.h"

namespace vpe::base {
namespace {

const double kNaN = std::nan("");
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using test_support::Random;

TEST(Number, ReadsWhatItWritesToTheBit) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double sign = random.integer(0, 1) == 0 ? -1.0 : 1.0;
    const double value = sign * random.log_uniform(1e-300, 1e300);
    const std::optional<double> read = parse_number(format_number(value));
    ASSERT_TRUE(read.has_value()) << format_number(value);
    ASSERT_EQ(*read, value);
  }
  for (const double value : {0.0, -0.0, 1e-6, 1e16, 123456789.0, std::numeric_limits<double>::denorm_min(),
                             std::numeric_limits<double>::max()}) {
    EXPECT_EQ(parse_number(format_number(value)), value);
  }
}

TEST(Number, IsPlainWherePeopleRead) {
  EXPECT_EQ(format_number(1000000), "1000000");
  EXPECT_EQ(format_number(-74.25), "-74.25");
  EXPECT_EQ(format_number(0.1), "0.1");
  EXPECT_EQ(format_number(0), "0");
  EXPECT_EQ(format_number(1e20), "1e+20");
}

TEST(Number, TakesOnlyWholeFiniteDecimals) {
  EXPECT_EQ(parse_number("+1.5"), 1.5);
  EXPECT_EQ(parse_number("-.5e1"), -5.0);
  for (const char* text : {"", "+", "-", "+-1", "-+1", "++1", "1 ", " 1", "1,5", "1.5m", "nan", "inf", "-inf",
                           "infinity", "0x10", "1e999", "1e", "--1", "1_000"}) {
    EXPECT_FALSE(parse_number(text).has_value()) << text;
  }
  EXPECT_EQ(parse_integer("+3"), 3);
  for (const char* text : {"", "3.0", "1e3", "99999999999999999999", "0x1"}) {
    EXPECT_FALSE(parse_integer(text).has_value()) << text;
  }
}

TEST(FormatShortest, PrefersAnExponentWhereThatIsShorter) {
  EXPECT_EQ(format_shortest(3396190), "3396190");
  EXPECT_EQ(format_shortest(3e6), "3e+06");
  EXPECT_EQ(format_shortest(0.1), "0.1");
  EXPECT_EQ(format_shortest(1e-5), "1e-05");
  EXPECT_EQ(format_shortest(-0.0), "-0");
  EXPECT_EQ(format_number(3e6), "3000000");
}

TEST(FormatFixed, KeepsTheSignOfZero) {
  EXPECT_EQ(format_fixed(-0.001, 2), "-0.00");
  EXPECT_EQ(format_fixed(2.5, 0), "2");  // ties go to the even digit
  EXPECT_EQ(format_fixed(0.125, 2), "0.12");
  EXPECT_EQ(format_fixed(12, 3), "12.000");
  EXPECT_EQ(format_fixed(kNaN, 3), "nan");
  EXPECT_EQ(format_fixed(-kInfinity, 3), "-inf");
  EXPECT_EQ(format_fixed(std::numeric_limits<double>::max(), 1).size(), 311U);
}

TEST(FormatDisplay, HasNoNegativeZero) {
  EXPECT_EQ(format_display(-0.001, 2), "0.00");
  EXPECT_EQ(format_display(-0.0, 0), "0");
  EXPECT_EQ(format_display(-12.5, 2), "-12.50");
  EXPECT_EQ(format_display(1e15, 2), "1.00e+15");
  EXPECT_EQ(format_display(999'999'999'999'999.0, 1), "999999999999999.0");
  EXPECT_EQ(format_display(kNaN, 2), "nan");
  EXPECT_EQ(format_display(-kInfinity, 2), "-inf");
}

TEST(FormatRounded, HasNoTrailingDigits) {
  EXPECT_EQ(format_rounded(0.35, 2), "0.35");  // 35 * 0.01 is 0.35000000000000003
  EXPECT_EQ(format_rounded(1.0009, 3), "1.001");
  EXPECT_EQ(format_rounded(1.0001, 3), "1");
  EXPECT_EQ(format_rounded(-7.5, 0), "-8");
  EXPECT_EQ(format_significant(41707.1, 4), "41710");
  EXPECT_EQ(format_significant(3489.6, 3), "3490");
  EXPECT_EQ(format_significant(-20.532597351137156, 4), "-20.53");
  EXPECT_EQ(format_significant(0.09151, 2), "0.092");
  EXPECT_EQ(format_significant(0, 3), "0");
  for (int n = -10'000; n < 10'000; ++n) {
    const double value = n * 0.001;
    EXPECT_LE(format_rounded(value, 3).size(), 7U) << n;
  }
}

TEST(FormatGeneral, LimitsTheDigits) {
  EXPECT_EQ(format_general(1234.56, 4), "1235");
  EXPECT_EQ(format_general(0.00001234, 2), "1.2e-05");
  EXPECT_EQ(format_general(20, 4), "20");
}

double any_bits() { return std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>()); }

double any_number() {
  return *rc::gen::oneOf(
      rc::gen::map(rc::gen::inRange(-10'000'000, 10'000'000), [](int n) { return n / 1024.0; }),
      rc::gen::exec([] { return any_bits(); }));
}

// In the "C" locale, which tests run in.
std::string printed(const char* format, int precision, double value) {
  char text[512];
  std::snprintf(text, sizeof text, format, precision, value);
  return text;
}

RC_GTEST_PROP(FormatProperty, IsWhatPrintfWrites, ()) {
  const double value = any_number();
  const int digits = *rc::gen::inRange(0, 15);
  RC_ASSERT(format_fixed(value, digits) == printed("%.*f", digits, value));
  RC_ASSERT(format_general(value, digits) == printed("%.*g", digits, value));
}

RC_GTEST_PROP(FormatProperty, ShortestIsReadBackToTheSameBits, ()) {
  const double value = any_number();
  RC_PRE(std::isfinite(value));
  for (const std::string& text : {format_shortest(value), format_number(value)}) {
    double back = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), back);
    RC_ASSERT(error == std::errc() && end == text.data() + text.size());
    RC_ASSERT(std::bit_cast<std::uint64_t>(back) == std::bit_cast<std::uint64_t>(value));
  }
  RC_ASSERT(format_shortest(value).size() <= format_number(value).size());
}

RC_GTEST_PROP(FormatProperty, DisplayIsFixedButForZeroAndLargeNumbers, ()) {
  const double value = *rc::gen::inRange(-10'000'000, 10'000'000) / 1024.0;
  const int digits = *rc::gen::inRange(0, 8);
  const std::string text = format_display(value, digits);
  const std::string fixed = format_fixed(value, digits);
  RC_ASSERT(text == fixed || fixed == "-" + text);
}

}  // namespace
}  // namespace vpe::base
