#include "mars/sources/own_light.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>
#include <system_error>

namespace mars {
namespace {

using Words = std::set<std::string, std::less<>>;

constexpr std::array<std::string_view, 27> kCameraWords{
    "CAMERA", "CAMERAS", "IMAGER", "IMAGING", "AMIE",  "CASSIS", "CTX",  "FC1",   "FC2",
    "HIRISE", "HRSC",    "ISS",    "ISSNA",   "ISSWA", "LORRI",  "LROC", "MARCI", "MDIS",
    "MOC",    "MSI",     "MVIC",   "NACL",    "NACR",  "OHRC",   "SSI",  "TMC",   "UVVIS"};
// Instruments that bring their own waves, or that receive none of the sun.
constexpr std::array<std::string_view, 15> kSunlessWords{"RADAR", "SAR",  "ALTIMETER", "LASER", "LIDAR",
                                                         "RDRS",  "RF",   "MICROWAVE", "GAMMA", "NEUTRON",
                                                         "MOLA",  "LOLA", "MLA",       "LWIR",  "DIVINER"};
constexpr std::array<std::string_view, 2> kHeatWords{"THERMAL", "THEMIS"};
constexpr std::array<std::string_view, 2> kVisibleWords{"VIS", "VISIBLE"};
constexpr std::array<std::string_view, 10> kHeightWords{"DEM",       "DTM",        "TOPOGRAPHY", "TOPOGRAPHIC",
                                                        "ELEVATION", "ELEVATIONS", "ALTIMETRY",  "TERRAIN",
                                                        "AREOID",    "RADIUS"};
constexpr std::array<std::string_view, 4> kNormalisedParts{"ALBEDO", "NORMALIZ", "NORMALIS", "PHOTOMETRICALLY"};
constexpr std::array<std::string_view, 9> kNotCorrected{"",   "NONE", "NO",  "N",      "FALSE",
                                                        "NA", "NULL", "UNK", "UNKNOWN"};
constexpr std::array<std::string_view, 9> kLengths{"M",  "METER",     "METERS",     "METRE",     "METRES",
                                                   "KM", "KILOMETER", "KILOMETERS", "KILOMETRES"};
constexpr std::array<std::string_view, 3> kInstrumentNames{"INSTRUMENTNAME", "INSTRUMENTID", "DETECTORID"};
constexpr std::array<std::string_view, 3> kSunAngleNames{"INCIDENCEANGLE", "SOLARINCIDENCEANGLE",
                                                         "SUBSOLARAZIMUTH"};
constexpr std::array<std::string_view, 2> kTimeNames{"STARTTIME", "STARTDATETIME"};
constexpr std::array<std::string_view, 4> kProductNames{"NAME", "TITLE", "PRODUCTNAME", "PRODUCTTYPE"};
constexpr std::array<std::string_view, 3> kProseNames{"DATASETNAME", "DESCRIPTION", "NOTE"};

template <std::size_t n>
bool is_one_of(std::string_view text, const std::array<std::string_view, n>& all) {
  return std::ranges::find(all, text) != all.end();
}

template <std::size_t n>
bool has_one_of(const Words& words, const std::array<std::string_view, n>& wanted) {
  return std::ranges::any_of(wanted, [&](std::string_view word) { return words.contains(word); });
}

// Returns the letters and digits of a text in capitals.
std::string bare(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) out += static_cast<char>(std::toupper(byte));
  }
  return out;
}

// Adds the runs of letters and digits of a text, in capitals.
void add_words(std::string_view text, Words& words) {
  std::string word;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) {
      word += static_cast<char>(std::toupper(byte));
    } else if (!word.empty()) {
      words.insert(std::move(word));
      word.clear();
    }
  }
  if (!word.empty()) words.insert(std::move(word));
}

// Labels write constants far outside of the circle for angles that are not known.
bool is_angle(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of("({\"+ "), text.size()));
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && std::abs(value) <= 360;
}

bool is_time(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of("\" "), text.size()));
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0;
}

struct Statements {
  Words instrument;
  Words product;
  bool has_sun_angle = false;
  bool has_season = false;
  bool has_time = false;
  bool is_normalised = false;
  bool has_heights = false;

  void add(std::string_view name, const std::string& value) {
    if (is_one_of(name, kInstrumentNames)) add_words(value, instrument);
    if (is_one_of(name, kProductNames)) add_words(value, product);
    if (is_one_of(name, kProductNames) || is_one_of(name, kProseNames)) {
      const std::string text = bare(value);
      is_normalised = is_normalised || std::ranges::any_of(kNormalisedParts, [&](std::string_view part) {
                        return text.find(part) != std::string::npos;
                      });
    }
    if (name.starts_with("PHOTOMETRICCORRECTION") || name.starts_with("PHOTOMETRICNORMALI"))
      is_normalised = is_normalised || !is_one_of(bare(value), kNotCorrected);
    has_sun_angle = has_sun_angle || (is_one_of(name, kSunAngleNames) && is_angle(value));
    has_season = has_season || (name == "SOLARLONGITUDE" && is_angle(value));
    has_time = has_time || (is_one_of(name, kTimeNames) && is_time(value));
    has_heights = has_heights || name == "DTMMISSINGDN" || (name == "UNIT" && is_one_of(bare(value), kLengths));
  }
};

}  // namespace

bool says_own_light(std::span<const LabelKeyword> keywords) {
  Statements said;
  for (const auto& [name, value] : keywords) {
    const std::size_t point = name.rfind('.');
    said.add(bare(std::string_view(name).substr(point == std::string::npos ? 0 : point + 1)), value);
  }
  if (said.is_normalised || said.has_heights || has_one_of(said.product, kHeightWords)) return false;
  if (has_one_of(said.instrument, kSunlessWords)) return false;
  if (has_one_of(said.instrument, kHeatWords) && !has_one_of(said.instrument, kVisibleWords)) return false;
  return has_one_of(said.instrument, kCameraWords) || said.has_sun_angle || (said.has_season && said.has_time);
}

}  // namespace mars
