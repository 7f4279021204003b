// The stretch of imagery against gdal_translate.
#include "paging/planet/image_stretch.h"

#include <gdal_priv.h>
#include <gdal_utils.h>
#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <string>

#include "vpe/base/number.h"

namespace paging {
namespace {

// Returns what GDAL makes of the values 0 to 255.
std::array<std::uint8_t, 256> by_gdal(const ImageStretch& stretch) {
  GDALAllRegister();
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const std::unique_ptr<GDALDataset> from(memory->Create("", 256, 1, 1, GDT_Byte, nullptr));
  std::array<std::uint8_t, 256> values{};
  std::iota(values.begin(), values.end(), std::uint8_t{0});
  EXPECT_EQ(
      from->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 256, 1, values.data(), 256, 1, GDT_Byte, 0, 0, nullptr),
      CE_None);
  CPLStringList words;
  for (const std::string& word :
       {std::string("-of"), std::string("MEM"), std::string("-scale"), vpe::base::format_number(stretch.low),
        vpe::base::format_number(stretch.high), std::string("0"), std::string("255")})
    words.AddString(word.c_str());
  if (stretch.gamma != 1) {
    words.AddString("-exponent");
    words.AddString(vpe::base::format_number(1 / stretch.gamma).c_str());
  }
  GDALTranslateOptions* options = GDALTranslateOptionsNew(words.List(), nullptr);
  const std::unique_ptr<GDALDataset> to(
      GDALDataset::FromHandle(GDALTranslate("", GDALDataset::ToHandle(from.get()), options, nullptr)));
  GDALTranslateOptionsFree(options);
  std::array<std::uint8_t, 256> out{};
  EXPECT_EQ(to->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 256, 1, out.data(), 256, 1, GDT_Byte, 0, 0, nullptr),
            CE_None);
  return out;
}

TEST(ImageStretches, AreThoseOfGdal) {
  for (const ImageStretch& stretch :
       {ImageStretch{0, 255, 1}, ImageStretch{30, 180, 1}, ImageStretch{60.5, 61.25, 1},
        ImageStretch{30, 180, 2.2}, ImageStretch{0, 255, 0.4}, ImageStretch{100, 250, 10}}) {
    const std::array<std::uint8_t, 256> here = stretch_table(stretch);
    const std::array<std::uint8_t, 256> there = by_gdal(stretch);
    for (std::size_t v = 0; v < here.size(); ++v)
      EXPECT_EQ(int{here[v]}, int{there[v]})
          << stretch.low << " " << stretch.high << " " << stretch.gamma << " at " << v;
  }
}

TEST(ImageStretches, TheDefaultChangesNothing) {
  const std::array<std::uint8_t, 256> table = stretch_table({});
  for (std::size_t v = 0; v < table.size(); ++v) EXPECT_EQ(table[v], v);
}

TEST(ImageStretches, NegativesAndStepsAreAllowed) {
  const std::array<std::uint8_t, 256> negative = stretch_table({200, 100, 1});
  EXPECT_EQ(negative[50], 255);
  EXPECT_EQ(negative[150], 128);
  EXPECT_EQ(negative[220], 0);
  const std::array<std::uint8_t, 256> step = stretch_table({100, 100, 3});
  EXPECT_EQ(step[99], 0);
  EXPECT_EQ(step[100], 255);
}

}  // namespace
}  // namespace paging
