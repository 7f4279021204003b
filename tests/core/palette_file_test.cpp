// Palettes as files: both forms, bad input, and gdaldem color-relief as oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/app/support/process.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/core/image/image.h"

namespace vpe::core {
namespace {

using Scale = Palette::Scale;
using test_support::Random;
using test_support::TempDir;

Palette parsed(std::string_view text) { return parse_palette(text, "p.txt"); }

std::string problem(std::string_view text) {
  try {
    static_cast<void>(parsed(text));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

TEST(PaletteFile, TellsTheTwoFormsApart) {
  const std::vector<PaletteStop> three{{0, {1, 2, 3}}, {0.5, {4, 5, 6}}, {1, {7, 8, 9}}};
  EXPECT_EQ(parsed("0 1 2 3\n0.5 4 5 6\n1 7 8 9\n"), Palette(Scale::kFraction, three));
  EXPECT_EQ(parsed("1 7 8 9\n0.5 4 5 6\n0 1 2 3"), Palette(Scale::kFraction, three));
  EXPECT_EQ(parsed("0% 1 2 3\n50% 4 5 6\n100% 7 8 9").stops()[1], three[1]);
  EXPECT_EQ(parsed("0% 1 2 3\n50% 4 5 6\n100% 7 8 9").scale(), Scale::kFraction);
  EXPECT_EQ(parsed("20% 1 2 3\n50% 4 5 6").scale(), Scale::kFraction);
  EXPECT_EQ(parsed("0 1 2 3\n0.5 4 5 6\n0.9 7 8 9\n").scale(), Scale::kValue);
  EXPECT_EQ(parsed("0 1 2 3\n1 4 5 6\n2 7 8 9\n").scale(), Scale::kValue);
  EXPECT_EQ(parsed("nv 0 0 0\n0 1 2 3\n1 4 5 6\n").scale(), Scale::kValue);
  EXPECT_EQ(parsed("-100.5 1 2 3").stops()[0], (PaletteStop{-100.5, {1, 2, 3}}));
}

TEST(PaletteFile, ReadsWhatPeopleWrite) {
  const Palette wanted(Scale::kValue, {{-5, {1, 2, 3}}, {1e3, {255, 0, 7.5}}});
  for (const char* text :
       {"-5 1 2 3\n1000 255 0 7.5", "-5,1,2,3\r\n1000,255,0,7.5\r\n", "-5:1:2:3\n1e3:255:0:7.5\n",
        "\xEF\xBB\xBF-5\t1  2 , 3\n\n   \n# words\n1000 255 0 7.5 # white\n",
        "1000 255 0 7.5 0\n-5 1 2 3 255\nnv 9 9 9 0"}) {
    EXPECT_EQ(parsed(text), wanted) << text;
  }
}

TEST(PaletteFile, TwoLinesOfOneValueAreAStep) {
  EXPECT_EQ(parsed("0 1 1 1\n5 2 2 2\n5 3 3 3\n9 4 4 4").colour(5), glm::dvec3(3));
  EXPECT_EQ(parsed("9 4 4 4\n5 3 3 3\n5 2 2 2\n0 1 1 1").colour(5), glm::dvec3(3));
  EXPECT_EQ(
      problem("0 1 1 1\n5 2 2 2\n9 4 4 4\n5 3 3 3\n5 3 3 3"),
      "cannot read the palette 'p.txt', line 5: expected at most two lines of one value, found a third of 5");
}

TEST(PaletteFile, BadLinesAreNamed) {
  const std::string file = "cannot read the palette 'p.txt'";
  EXPECT_EQ(problem(""), file + ": it holds no colours; expected lines 'value r g b'");
  EXPECT_EQ(problem("# nothing\n\nnv 0 0 0\n"), file + ": it holds no colours; expected lines 'value r g b'");
  const auto expect = [&](const char* text, const char* line, const char* part) {
    const std::string found = problem(text);
    EXPECT_EQ(found.rfind(file + ", line " + line + ": ", 0), 0u) << found;
    EXPECT_NE(found.find(part), std::string::npos) << found;
  };
  expect("0 1 2 3\n5 1 2\n", "2",
         "expected 'value r g b [a]', numbers apart by blanks or commas, found \"5 1 2\"");
  expect("0 1 2 3 4 5\n", "1", "expected 'value r g b [a]'");
  expect("0\n", "1", "expected 'value r g b [a]'");
  expect("0;1;2;3\n", "1", "found \"0;1;2;3\"");
  expect("0 1 2 3\n\n# x\nx 1 2 3\n", "4", "expected a value, a fraction, a percentage or nv, found \"x\"");
  expect("0 red\n", "1", "expected 'value r g b [a]'");
  expect("% 1 2 3\n", "1", "found \"%\"");
  expect("nan 1 2 3\n", "1", "found \"nan\"");
  expect("inf 1 2 3\n", "1", "found \"inf\"");
  expect("1e13 1 2 3\n", "1", "found \"1e13\"");
  expect("101% 1 2 3\n", "1", "0 % to 100 %");
  expect("-1% 1 2 3\n", "1", "0 % to 100 %");
  expect("0 1 2 256\n", "1", "from 0 to 255, found \"256\"");
  expect("0 1 -2 3\n", "1", "from 0 to 255, found \"-2\"");
  expect("0 1 two 3\n", "1", "found \"two\"");
  expect("0 1 2 3 x\n", "1", "found \"x\"");
  expect("0 1 2 3 256\n", "1", "found \"256\"");
  expect("nv 1 2 x\n", "1", "found \"x\"");
  expect("0 1 2 3\n50% 1 2 3\n", "2", "expected a value as before");
  expect("0% 1 2 3\n50 1 2 3\n", "2", "expected a percentage as before");
  expect("0 1 2 3\n\x01\x02 1 2 3\n", "2", "found \"??\"");
}

TEST(PaletteFile, AnyBytesAreReadOrRefused) {
  Random random(7);
  const std::string letters = "0123456789.,:%#-+e nv\t\r\n";
  int read = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::string text = "-8000 10 20 200\n0 255 255 100\n# up\n4000,255,0,0\n";
    for (int n = random.integer(0, 6); n > 0; --n) {
      const auto any = [&](std::size_t count) {
        return static_cast<std::size_t>(random.integer(0, static_cast<int>(count) - 1));
      };
      const char letter =
          trial % 4 == 0 ? static_cast<char>(random.integer(0, 255)) : letters[any(letters.size())];
      text[any(text.size())] = letter;
    }
    try {
      const Palette p = parsed(text);
      EXPECT_FALSE(p.stops().empty());
      ++read;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("cannot read the palette 'p.txt'", 0), 0u);
    }
  }
  EXPECT_GT(read, 2000);
  EXPECT_LT(read, 18000);
}

TEST(PaletteFile, TroubleWithTheFileItselfIsTold) {
  const TempDir dir;
  EXPECT_EQ(palette_problem((dir / "none").string()), "no palette and no file has this name");
  EXPECT_EQ(palette_problem(""), "no palette and no file has this name");
  EXPECT_EQ(palette_problem("Viridis"), "no palette and no file has this name");
  EXPECT_NE(palette_problem(dir.path().string()).find("cannot read '"), std::string::npos);
  EXPECT_NE(palette_problem("/dev/zero"), "");
  const std::string file = (dir / "p.txt").string();
  base::write_file(file, std::string(2 << 20, '\n'));
  EXPECT_NE(palette_problem(file).find("are more than"), std::string::npos) << palette_problem(file);
  base::write_file(file, std::string_view("0 1 2 3\nx"));
  EXPECT_NE(palette_problem(file).find("p.txt', line 2"), std::string::npos) << palette_problem(file);
  Appearance a;
  a.palette = file;
  EXPECT_THROW(ColourScale{a}, std::runtime_error);
  base::write_file(file, std::string_view("-4000 1 2 3\n-3000 4 5 6"));
  EXPECT_EQ(palette_problem(file), "");
  const ColourScale scale(a);
  EXPECT_EQ(scale.low(), -4000);
  EXPECT_EQ(scale.high(), -3000);
  EXPECT_EQ(scale(-3500), glm::dvec3(2.5, 3.5, 4.5));
}

// Compares with gdaldem on a grid of values beyond the palette; both round to whole colours.
TEST(PaletteFile, AgreesWithGdaldem) {
  const auto gdaldem = app_test::find_program("gdaldem");
  if (gdaldem.empty()) GTEST_SKIP() << "skipped: no gdaldem";
  const TempDir dir;
  constexpr int kSide = 40;
  struct Case {
    const char* text;
    bool is_percent;
  };
  for (const Case& c :
       {Case{"-8000 10 20 200\n0, 255 255 100\n4000:255:0:0\n4000:0:0:0\n9000 255 250 240\nnv 1 1 1\n", false},
        Case{"9000 255 250 240\n0 0 0 0\n", false}, Case{"500 7 8 9\n", false},
        Case{"0% 10 20 200\n25% 0 255 0\n100% 255 0 0\n", true}}) {
    Random random(3);
    std::string grid = "ncols 40\nnrows 40\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
    std::vector<double> values;
    for (int n = 0; n < kSide * kSide; ++n) {
      // Not at the step itself, where gdaldem takes the mean of both sides.
      double value = std::round(random.uniform(-9500, 10500));
      if (value == 4000) value = 4001;
      values.push_back(value);
      grid += base::format_number(value) + ((n + 1) % kSide == 0 ? "\n" : " ");
    }
    base::write_file(dir / "z.asc", std::string_view(grid));
    base::write_file(dir / "p.txt", std::string_view(c.text));
    app_test::Command command;
    command.program = gdaldem;
    command.folder = dir.path();
    command.arguments = {"color-relief", "-q", "-of", "PNG", "z.asc", "p.txt", "out.png"};
    const app_test::Result result = app_test::run(command);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const RgbImage image = read_image(dir / "out.png");
    ASSERT_EQ(image.pixels.size(), values.size());
    Appearance a;
    a.palette = (dir / "p.txt").string();
    if (c.is_percent) {
      a.palette_low = *std::min_element(values.begin(), values.end());
      a.palette_high = *std::max_element(values.begin(), values.end());
    }
    const ColourScale scale(a);
    double most = 0;
    for (std::size_t n = 0; n < values.size(); ++n) {
      const vpe::base::Rgb& p = image.pixels[n];
      const glm::dvec3 ours = scale(values[n]);
      most = std::max({most, std::abs(ours.x - p.r), std::abs(ours.y - p.g), std::abs(ours.z - p.b)});
    }
    EXPECT_LE(most, 1.0) << c.text;
  }
}

}  // namespace
}  // namespace vpe::core
