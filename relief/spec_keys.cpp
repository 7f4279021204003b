// The declaration of all keys of reliefs.
#include <array>
#include <cmath>

#include "relief/spec.h"
#include "relief/spec_polygon.h"

namespace relief {

namespace {

using vpe::core::KeyMember;
using vpe::core::KeyMembers;
using vpe::core::KeyRegistry;
using vpe::core::KeyType;
using vpe::core::KeyValue;
using vpe::core::word;
using Declare = KeyMembers<ReliefSpec>;

constexpr unsigned bit(ReliefKind kind) { return 1U << static_cast<unsigned>(kind); }
constexpr unsigned kCrater = bit(ReliefKind::kCrater);
constexpr unsigned kRamp = bit(ReliefKind::kRamp);
constexpr unsigned kPad = bit(ReliefKind::kPad);
constexpr unsigned kTrench = bit(ReliefKind::kTrench);
constexpr unsigned kDune = bit(ReliefKind::kDune);
constexpr unsigned kDam = bit(ReliefKind::kDam);
constexpr unsigned kFlood = bit(ReliefKind::kFlood);
constexpr unsigned kNoise = bit(ReliefKind::kNoise);
constexpr unsigned kAll = 0xff;

struct DeclaredKey {
  KeyRegistry<ReliefSpec>::Declaration declaration;
  unsigned kinds = kAll;  // that have the key
  unsigned needed = 0;    // kinds that must have it
};

std::string problem_of_name(const std::string& name) {
  if (name.size() <= kMostNameBytes) return "";
  return "expected at most " + std::to_string(kMostNameBytes) + " bytes";
}

std::string problem_of_polygon(const std::string& text) {
  std::string problem;
  parse_polygon(text, problem);
  return problem;
}

// A length that may be left out.
template <auto... path>
KeyMember<ReliefSpec> length(double least = kLeastLength_m) {
  return Declare::number_or_word<path...>(least, kMostLength_m, "auto");
}
template <auto... path>
KeyMember<ReliefSpec> height(double least) {
  return Declare::number_or_word<path...>(least, kMostHeight_m, "auto");
}

// The mode is a word, and "auto" stands for none.
KeyMember<ReliefSpec> mode_member() {
  KeyType type = vpe::core::ChoiceKey{{{"auto", -1},
                                       word("add", Mode::kAdd),
                                       word("replace", Mode::kReplace),
                                       word("max", Mode::kMax),
                                       word("min", Mode::kMin)}};
  return {std::move(type),
          [](const ReliefSpec& spec) { return KeyValue(spec.mode ? static_cast<int>(*spec.mode) : -1); },
          [](ReliefSpec& spec, const KeyValue& value) {
            const int number = std::get<int>(value);
            spec.mode = number < 0 ? std::nullopt : std::optional(static_cast<Mode>(number));
          }};
}

KeyMember<ReliefSpec> polygon_member() {
  return {vpe::core::TextKey{"LON,LAT;LON,LAT;LON,LAT and so on", problem_of_polygon},
          [](const ReliefSpec& spec) { return KeyValue(format_polygon(spec.polygon)); },
          [](ReliefSpec& spec, const KeyValue& value) {
            std::string problem;
            spec.polygon = parse_polygon(std::get<std::string>(value), problem);
          }};
}

std::vector<DeclaredKey> common_keys() {
  using S = ReliefSpec;
  return {
      {{"name", Declare::text<&S::name>("a text of at most 200 bytes", problem_of_name), "",
        "by which messages and flights name the relief"}},
      {{"kind",
        Declare::choice<&S::kind>({word("crater", ReliefKind::kCrater), word("ramp", ReliefKind::kRamp),
                                   word("pad", ReliefKind::kPad), word("trench", ReliefKind::kTrench),
                                   word("dune", ReliefKind::kDune), word("dam", ReliefKind::kDam),
                                   word("flood", ReliefKind::kFlood), word("noise", ReliefKind::kNoise)}),
        "", "what it is"},
       kAll,
       kAll},
      {{"lon", Declare::number<&S::place, &mars::LonLat::lon_deg>(-360, 360), "deg", "longitude of its middle"},
       kAll,
       kAll},
      {{"lat", Declare::number<&S::place, &mars::LonLat::lat_deg>(-90, 90), "deg", "latitude of its middle"},
       kAll,
       kAll},
      {{"azimuth_deg", Declare::number<&S::azimuth_deg>(-360, 360), "deg",
        "heading of its length, or the heading to which the wind blows, clockwise from north"}},
      {{"mode", mode_member(), "", "how it changes the ground"}},
      {{"strength", Declare::number<&S::strength>(0, 1), "", "share of the change that is made"}},
      {{"level_m", Declare::number_or_word<&S::level_m>(-kMostHeight_m, kMostHeight_m, "auto"), "m",
        "height of its zero above the datum; auto: the ground at its middle"}},
      {{"rise_m", Declare::number<&S::rise_m>(-kMostHeight_m, kMostHeight_m), "m",
        "added to the height of its zero"}},
      {{"spacing_m", length<&S::spacing_m>(), "m",
        "distance of posts that show it; auto: a quarter of its smallest part"}},
  };
}

std::vector<DeclaredKey> size_keys() {
  using S = ReliefSpec;
  return {
      {{"radius_m", length<&S::radius_m>(), "m", "radius of the rim's crest, or of the area"},
       kCrater | kPad | kFlood | kNoise,
       kCrater},
      {{"length_m", length<&S::length_m>(), "m", "length of the floor, crest or area along the azimuth"},
       kRamp | kPad | kTrench | kDam | kNoise,
       kRamp | kTrench | kDam},
      {{"width_m", length<&S::width_m>(), "m", "width of the floor, crest or area across the azimuth"},
       kRamp | kPad | kTrench | kDune | kDam | kNoise,
       kRamp | kTrench},
      {{"height_m", height<&S::height_m>(0), "m", "height of the crest"}, kDune | kDam, kDune | kDam},
      {{"depth_m", height<&S::depth_m>(0), "m",
        "depth of the floor: below the rim's crest, or below the ground"},
       kCrater | kTrench,
       kTrench},
      {{"falloff_m", length<&S::falloff_m>(), "m", "width of the border over which the change ends"},
       kRamp | kPad | kDam | kFlood | kNoise},
      {{"slope_deg", Declare::number_or_word<&S::slope_deg>(1, 89, "auto"), "deg",
        "slope of the walls, of the sides, or of the slip face"},
       kTrench | kDam | kDune},
      {{"polygon", polygon_member(), "", "corners of the area"}, kFlood},
  };
}

std::vector<DeclaredKey> own_keys() {
  using S = ReliefSpec;
  return {
      {{"rim_m", height<&S::rim_m>(0), "m", "height of the rim's crest above the ground"}, kCrater},
      {{"floor_ratio", Declare::number_or_word<&S::floor_ratio>(0, 0.9, "auto"), "",
        "radius of the flat floor by radius_m"},
       kCrater},
      {{"peak_m", height<&S::peak_m>(0), "m", "height of the central peak above the floor"}, kCrater},
      {{"ejecta_ratio", Declare::number<&S::ejecta_ratio>(1.1, 20), "",
        "radius of the end of the ejecta by radius_m"},
       kCrater},
      {{"start_m", Declare::number<&S::start_m>(-kMostHeight_m, kMostHeight_m), "m",
        "height of the start above its zero"},
       kRamp},
      {{"end_m", Declare::number<&S::end_m>(-kMostHeight_m, kMostHeight_m), "m",
        "height of the end above its zero"},
       kRamp},
      {{"form",
        Declare::choice<&S::form>(
            {word("barchan", DuneForm::kBarchan), word("transverse", DuneForm::kTransverse)}),
        "", "a crescent or a straight ridge"},
       kDune},
      {{"stoss_m", length<&S::stoss_m>(), "m", "length of the side towards the wind"}, kDune},
      {{"horn_m", length<&S::horn_m>(0), "m", "length of the horns downwind of the crest's middle"}, kDune},
      {{"foundation_m", height<&S::foundation_m>(0), "m", "how far the sides reach below its zero"}, kDam},
      {{"amplitude_m", height<&S::amplitude_m>(0), "m", "bound of the change, up and down"}, kNoise, kNoise},
      {{"wavelength_m", length<&S::wavelength_m>(), "m", "wavelength of the coarsest octave"}, kNoise, kNoise},
      {{"octaves", Declare::integer<&S::octaves>(1, 12), "", "number of octaves, each of half the wavelength"},
       kNoise},
      {{"gain", Declare::number<&S::gain>(0, 1), "", "amplitude of an octave by that of the coarser one"},
       kNoise},
      {{"seed", Declare::integer<&S::seed>(0, 2147483647), "", "selects the noise"}, kNoise},
  };
}

struct AllKeys {
  KeyRegistry<ReliefSpec> registry{{}};
  std::vector<unsigned> kinds;
  std::vector<unsigned> needed;
};

const AllKeys& all_keys() {
  static const AllKeys kKeys = [] {
    AllKeys keys;
    std::vector<KeyRegistry<ReliefSpec>::Declaration> declarations;
    for (auto* list : {&common_keys, &size_keys, &own_keys}) {
      for (DeclaredKey& key : list()) {
        declarations.push_back(std::move(key.declaration));
        keys.kinds.push_back(key.kinds);
        keys.needed.push_back(key.needed);
      }
    }
    keys.registry = KeyRegistry<ReliefSpec>(std::move(declarations));
    return keys;
  }();
  return kKeys;
}

}  // namespace

const KeyRegistry<ReliefSpec>& relief_keys() { return all_keys().registry; }

bool has_key(ReliefKind kind, std::size_t key) { return (all_keys().kinds[key] & bit(kind)) != 0; }

bool needs_key(ReliefKind kind, std::size_t key) { return (all_keys().needed[key] & bit(kind)) != 0; }

}  // namespace relief
