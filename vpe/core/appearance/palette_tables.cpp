#include "vpe/core/appearance/palette_tables.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vpe::core {

namespace {

// Stop at n / of, with a colour in whole steps of 255.
struct Knot {
  int at;
  int r;
  int g;
  int b;
};

// Published tables have 256 colours. The knots here are chosen so that straight lines between them stay within
// 1/255 of the published table; they are a tenth of its size.

// viridis: S. van der Walt and N. Smith, 2015, matplotlib; CC0.
constexpr Knot kViridis[] = {{0, 68, 1, 84},      {13, 72, 20, 103},   {26, 72, 37, 118},   {41, 69, 56, 130},
                             {50, 65, 66, 135},   {58, 62, 76, 138},   {82, 50, 101, 142},  {119, 35, 136, 142},
                             {139, 30, 155, 138}, {147, 31, 162, 135}, {157, 37, 172, 130}, {166, 47, 180, 124},
                             {178, 66, 190, 113}, {192, 94, 201, 98},  {200, 112, 207, 87}, {213, 144, 215, 67},
                             {233, 197, 224, 33}, {239, 213, 226, 26}, {244, 226, 228, 24}, {250, 241, 229, 29},
                             {255, 253, 231, 37}};

// cividis: J. R. Nunez, C. R. Anderton and R. S. Renslow, PLoS ONE 13(7) e0199239, 2018; the article is free of
// all copyright (CC0).
constexpr Knot kCividis[] = {
    {0, 0, 34, 78},       {1, 0, 35, 79},       {19, 0, 48, 111},     {23, 1, 50, 113},
    {24, 5, 51, 113},     {28, 18, 53, 112},    {33, 28, 57, 111},    {39, 38, 61, 110},
    {53, 56, 71, 108},    {76, 79, 87, 108},    {105, 105, 107, 113}, {124, 121, 121, 119},
    {134, 130, 128, 121}, {155, 150, 144, 119}, {178, 173, 162, 114}, {203, 199, 183, 103},
    {224, 222, 201, 88},  {239, 239, 215, 72},  {244, 245, 220, 65},  {251, 253, 227, 52},
    {252, 254, 228, 52},  {255, 254, 232, 56}};

// inferno: N. Smith and S. van der Walt, 2015, matplotlib; CC0.
constexpr Knot kInferno[] = {
    {0, 0, 0, 4},         {2, 1, 1, 6},         {9, 4, 3, 20},        {17, 12, 8, 38},     {23, 20, 11, 52},
    {31, 31, 12, 72},     {38, 43, 11, 87},     {44, 54, 9, 97},      {53, 69, 10, 105},   {64, 87, 16, 110},
    {78, 109, 24, 110},   {91, 130, 32, 108},   {110, 160, 42, 99},   {126, 185, 53, 86},  {142, 207, 68, 70},
    {153, 221, 81, 58},   {167, 235, 100, 41},  {182, 245, 125, 21},  {193, 250, 144, 8},  {198, 251, 153, 6},
    {203, 252, 163, 9},   {209, 252, 174, 18},  {220, 250, 196, 42},  {227, 247, 209, 61}, {235, 244, 225, 86},
    {241, 241, 236, 109}, {246, 242, 244, 130}, {251, 246, 250, 150}, {255, 252, 255, 164}};

// turbo: A. Mikhailov, Google, 2019; the published table is under Apache-2.0.
constexpr Knot kTurbo[] = {
    {0, 48, 18, 59},     {7, 56, 39, 109},    {14, 63, 59, 151},   {21, 67, 78, 186},   {27, 69, 94, 211},
    {34, 71, 113, 233},  {41, 70, 130, 248},  {46, 68, 143, 254},  {52, 61, 158, 254},  {60, 47, 178, 244},
    {69, 32, 199, 223},  {76, 25, 213, 205},  {84, 25, 227, 185},  {89, 32, 234, 172},  {94, 44, 240, 158},
    {102, 70, 248, 132}, {114, 117, 254, 92}, {123, 150, 254, 68}, {130, 169, 251, 57}, {136, 185, 246, 53},
    {145, 208, 234, 52}, {154, 227, 219, 56}, {162, 241, 203, 58}, {169, 249, 188, 57}, {176, 253, 172, 52},
    {186, 254, 144, 41}, {198, 246, 108, 25}, {208, 235, 80, 14},  {215, 225, 65, 9},   {225, 206, 45, 4},
    {235, 183, 29, 2},   {246, 152, 14, 1},   {255, 122, 4, 3}};

// black-body, as in visualization programs: straight lines between black, red, yellow and white.
constexpr Knot kBlackBody[] = {{0, 0, 0, 0}, {2, 230, 0, 0}, {4, 230, 230, 0}, {5, 255, 255, 255}};

constexpr Knot kGrey[] = {{0, 0, 0, 0}, {1, 255, 255, 255}};

// aspect: made for this program, on a circle of OKLab (B. Ottosson, 2020) of radius 0.135 about the grey of lightness 0.68: light
// to the north, orange (hue 65 degrees) to the east, dark to the south, blue to the west. Lightness and blue against orange are
// what colour-blind eyes tell apart.
constexpr Knot kAspect[] = {
    {0, 194, 194, 194},  {1, 206, 191, 176},  {2, 215, 185, 157},  {3, 221, 178, 136},  {4, 224, 169, 116},
    {5, 225, 160, 95},   {6, 222, 151, 76},   {7, 216, 141, 58},   {8, 208, 133, 45},   {9, 199, 125, 38},
    {10, 187, 119, 39},  {11, 175, 114, 47},  {12, 162, 111, 58},  {13, 149, 109, 70},  {14, 137, 109, 83},
    {15, 124, 110, 97},  {16, 112, 112, 112}, {17, 100, 115, 128}, {18, 90, 119, 144},  {19, 80, 123, 160},
    {20, 71, 129, 177},  {21, 64, 136, 192},  {22, 60, 143, 207},  {23, 61, 151, 219},  {24, 68, 159, 230},
    {25, 79, 168, 237},  {26, 94, 176, 241},  {27, 111, 183, 242}, {28, 129, 189, 239}, {29, 147, 193, 233},
    {30, 164, 195, 223}, {31, 180, 196, 210}, {32, 194, 194, 194}};

// relief: made for this program, hypsometric, in metres. Lightness rises all the way, and values a tenth of the range apart
// differ for colour-blind eyes too.
constexpr Knot kRelief[] = {{-8200, 34, 17, 85},    {-6000, 24, 53, 121},  {-4500, 17, 83, 134},
                            {-3000, 39, 112, 137},  {-1500, 93, 136, 112}, {0, 153, 153, 88},
                            {1500, 211, 161, 85},   {3500, 249, 178, 123}, {7000, 255, 202, 174},
                            {12000, 255, 226, 209}, {21500, 252, 251, 249}};

// mola: made for this program, in metres, with the order of colours that is familiar from maps of the Mars
// Orbiter Laser Altimeter: purple and blue basins, green and yellow about the datum, red highlands, brown to
// white volcanoes.
constexpr Knot kMola[] = {{-8200, 110, 0, 170},   {-6000, 40, 20, 230},  {-4500, 0, 110, 255},
                          {-3000, 0, 215, 225},   {-2000, 0, 200, 90},   {-1000, 110, 220, 40},
                          {0, 250, 240, 50},      {1000, 255, 190, 30},  {2000, 255, 120, 20},
                          {3500, 220, 30, 20},    {5500, 150, 50, 30},   {8000, 150, 110, 90},
                          {12000, 205, 195, 190}, {21300, 255, 255, 255}};

// diverging: made for this program, in metres. At s = |z| / 8000 m: OKLab lightness 0.97 - 0.55 s, chroma 0.155
// s^0.85, hue 262 degrees below and 29 above 0; equally light at equal distances from 0.
constexpr Knot kDiverging[] = {{-8000, 24, 70, 160},   {-7000, 50, 92, 173},   {-6000, 75, 114, 186},
                               {-5000, 101, 136, 199}, {-4000, 128, 157, 211}, {-3000, 155, 179, 222},
                               {-2000, 183, 201, 232}, {-1000, 213, 223, 241}, {0, 245, 245, 245},
                               {1000, 240, 216, 212},  {2000, 230, 189, 183},  {3000, 218, 163, 154},
                               {4000, 205, 137, 126},  {5000, 191, 111, 99},   {6000, 176, 84, 73},
                               {7000, 160, 57, 46},    {8000, 143, 23, 17}};

Palette made(Palette::Scale scale, std::span<const Knot> knots) {
  const double unit = scale == Palette::Scale::kFraction ? knots.back().at : 1.0;
  std::vector<PaletteStop> stops;
  stops.reserve(knots.size());
  for (const Knot& k : knots) stops.push_back({k.at / unit, glm::dvec3(k.r, k.g, k.b)});
  return {scale, std::move(stops)};
}

constexpr std::array<std::string_view, 10> kNames{"relief", "mola",       "viridis", "cividis",   "inferno",
                                                  "turbo",  "black-body", "grey",    "diverging", "aspect"};

}  // namespace

std::span<const std::string_view> palette_names() { return kNames; }

const Palette* built_in_palette(std::string_view name) {
  using Scale = Palette::Scale;
  static const std::array<Palette, kNames.size()> all{
      made(Scale::kValue, kRelief),       made(Scale::kValue, kMola),       made(Scale::kFraction, kViridis),
      made(Scale::kFraction, kCividis),   made(Scale::kFraction, kInferno), made(Scale::kFraction, kTurbo),
      made(Scale::kFraction, kBlackBody), made(Scale::kFraction, kGrey),    made(Scale::kValue, kDiverging),
      made(Scale::kFraction, kAspect)};
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  return found == kNames.end() ? nullptr : &all[static_cast<std::size_t>(found - kNames.begin())];
}

Palette hsv_palette(const HsvRamp& ramp) {
  constexpr int kSteps = 256;
  constexpr double kCornerDeg = 60;  // the RGB components have corners where hue is a multiple of this
  std::vector<double> places;
  for (int n = 0; n <= kSteps; ++n) places.push_back(static_cast<double>(n) / kSteps);
  const double turn = ramp.high_hue_deg - ramp.low_hue_deg;
  const auto [least, most] = std::minmax(ramp.low_hue_deg, ramp.high_hue_deg);
  for (double corner = std::ceil(least / kCornerDeg) * kCornerDeg; turn != 0 && corner <= most;
       corner += kCornerDeg) {
    places.push_back(std::clamp((corner - ramp.low_hue_deg) / turn, 0.0, 1.0));
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<PaletteStop> stops;
  for (const double t : places) {
    const auto mix = [t](double low, double high) { return low * (1 - t) + high * t; };
    stops.push_back(
        {t, to_rgb({mix(ramp.low_hue_deg, ramp.high_hue_deg), mix(ramp.low_saturation, ramp.high_saturation),
                    mix(ramp.low_value, ramp.high_value)})});
  }
  return {Palette::Scale::kFraction, std::move(stops)};
}

}  // namespace vpe::core
