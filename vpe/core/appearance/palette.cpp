#include "vpe/core/appearance/palette.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <stdexcept>
#include <utility>

#include "vpe/core/appearance/palette_tables.h"

namespace vpe::core {

namespace {

constexpr std::size_t kBuckets = 256;
constexpr double kFarthest = 1e12;

struct Range {
  double low;
  double high;
};

Range usual_range(Colour colour) {
  switch (colour) {
    case Colour::kElevation: return {-8200, 21300};
    case Colour::kSlope: return {0, 45};
    case Colour::kAspect: return {0, 360};
    case Colour::kDifference: return {-10, 10};
    default: throw std::invalid_argument("this colour has no scale of values");
  }
}

std::string_view usual_palette(Colour colour) {
  if (colour == Colour::kSlope) return "viridis";
  if (colour == Colour::kDifference) return "diverging";
  return colour == Colour::kAspect ? "aspect" : "relief";
}

Palette palette_of(const Appearance& a) {
  if (a.palette == "hsv") return hsv_palette(a);
  if (const auto file = palette_file(a.palette)) return read_palette(*file);
  return *built_in_palette(a.palette == "auto" ? usual_palette(a.colour) : std::string_view(a.palette));
}

Range range_of(const Appearance& a, const Palette& palette) {
  const Range usual = usual_range(a.colour);
  if (!a.palette_low || !a.palette_high)
    throw std::invalid_argument("the ends of the palette were not taken from the view");
  if (*a.palette_low != *a.palette_high) return {*a.palette_low, *a.palette_high};
  const bool has_values = palette.scale() == Palette::Scale::kValue;
  const bool is_of_metres = has_values && !palette_file(a.palette);
  if (!has_values || (is_of_metres && a.colour != Colour::kElevation)) return usual;
  return {palette.stops().front().at, palette.stops().back().at};
}

// Returns the palette with its first stop at low and its last at high, in rising order.
Palette stretched(const Palette& palette, const Range& range) {
  const bool has_values = palette.scale() == Palette::Scale::kValue;
  if (has_values && palette.stops().front().at == range.low && palette.stops().back().at == range.high) {
    return palette;
  }
  std::vector<PaletteStop> stops(palette.stops().begin(), palette.stops().end());
  const double first = has_values ? stops.front().at : 0.0;
  const double last = has_values ? stops.back().at : 1.0;
  for (PaletteStop& stop : stops) {
    const double t = last > first ? (stop.at - first) / (last - first) : 0.0;
    stop.at = range.low * (1 - t) + range.high * t;
  }
  if (range.low > range.high) std::reverse(stops.begin(), stops.end());
  for (std::size_t n = 1; n < stops.size(); ++n) stops[n].at = std::max(stops[n].at, stops[n - 1].at);
  // Rounding may put several stops at one value: the outer two make the same step.
  std::vector<PaletteStop> kept;
  for (const PaletteStop& stop : stops) {
    if (kept.size() >= 2 && kept[kept.size() - 2].at == stop.at) kept.pop_back();
    kept.push_back(stop);
  }
  return {Palette::Scale::kValue, std::move(kept)};
}

}  // namespace

Palette::Palette(Scale scale, std::vector<PaletteStop> stops) : scale_(scale), stops_(std::move(stops)) {
  if (stops_.empty()) throw std::invalid_argument("a palette without colours");
  const double least = scale == Scale::kFraction ? 0.0 : -kFarthest;
  const double most = scale == Scale::kFraction ? 1.0 : kFarthest;
  for (std::size_t n = 0; n < stops_.size(); ++n) {
    const auto& [at, rgb] = stops_[n];
    if (!(at >= least && at <= most)) throw std::invalid_argument("a palette's stop is out of range");
    for (int c = 0; c < 3; ++c) {
      if (!(rgb[c] >= 0 && rgb[c] <= 255)) throw std::invalid_argument("a palette's colour is not 0 to 255");
    }
    if (n > 0 && at < stops_[n - 1].at) throw std::invalid_argument("a palette's stops do not rise");
    if (n > 1 && at == stops_[n - 2].at) throw std::invalid_argument("three of a palette's stops at one place");
  }
  const double span = stops_.back().at - stops_.front().at;
  const double per_unit = static_cast<double>(kBuckets) / span;
  buckets_per_unit_ = span > 0 && std::isfinite(per_unit) ? per_unit : 0;
  before_.assign(kBuckets + 1, 0);
  for (const PaletteStop& stop : stops_) ++before_[bucket(stop.at) + 1];
  for (std::size_t b = 1; b <= kBuckets; ++b) before_[b] += before_[b - 1];
}

// The bucket never falls as `at` rises, so a stop in an earlier bucket is below, one in a later bucket above.
std::size_t Palette::bucket(double at) const {
  const double x = (at - stops_.front().at) * buckets_per_unit_;
  return x < static_cast<double>(kBuckets - 1) ? static_cast<std::size_t>(x) : kBuckets - 1;
}

glm::dvec3 Palette::colour(double at) const {
  if (!(at >= stops_.front().at)) return stops_.front().rgb;
  if (at >= stops_.back().at) return stops_.back().rgb;
  const std::size_t b = bucket(at);
  const auto begin = stops_.begin();
  const auto above = std::upper_bound(begin + before_[b], begin + before_[b + 1], at,
                                      [](double value, const PaletteStop& stop) { return value < stop.at; });
  const auto below = above - 1;
  return glm::mix(below->rgb, above->rgb, (at - below->at) / (above->at - below->at));
}

std::optional<std::filesystem::path> palette_file(const std::string& palette) {
  const bool is_name = palette == "auto" || palette == "hsv" || built_in_palette(palette) != nullptr;
  return is_name ? std::nullopt : std::optional<std::filesystem::path>(palette);
}

std::string palette_problem(const std::string& palette) {
  const auto file = palette_file(palette);
  if (!file) return {};
  std::error_code failure;
  if (!std::filesystem::exists(*file, failure)) return "no palette and no file has this name";
  try {
    static_cast<void>(read_palette(*file));
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

std::string palette_grammar() {
  std::string text = "auto, hsv";
  for (const std::string_view name : palette_names()) text.append(", ").append(name);
  return text + ", or a file with lines 'value r g b' (as gdaldem color-relief reads) or 'fraction r g b'";
}

PaletteEnds ends_of(const Appearance& a, const PaletteEnds& view) {
  return {a.palette_low.value_or(view.low), a.palette_high.value_or(view.high)};
}

ColourScale::ColourScale(const Appearance& appearance)
    : palette_(palette_of(appearance)),
      low_(range_of(appearance, palette_).low),
      high_(range_of(appearance, palette_).high),
      unit_(appearance.colour == Colour::kElevation || appearance.colour == Colour::kDifference ? "m" : "deg") {
  palette_ = stretched(palette_, {low_, high_});
}

glm::dvec3 ColourScale::operator()(double value) const {
  return palette_.colour(std::isnan(value) ? low_ : value);
}

Hsv to_hsv(const glm::dvec3& rgb) {
  const double most = std::max({rgb.x, rgb.y, rgb.z});
  const double span = most - std::min({rgb.x, rgb.y, rgb.z});
  if (!(span > 0)) return {0, 0, most / 255};
  double sixths = 0;
  if (most == rgb.x) {
    sixths = (rgb.y - rgb.z) / span;
  } else if (most == rgb.y) {
    sixths = 2 + (rgb.z - rgb.x) / span;
  } else {
    sixths = 4 + (rgb.x - rgb.y) / span;
  }
  double hue = 60 * sixths;
  if (hue < 0) hue += 360;
  return {hue < 360 ? hue : 0, span / most, most / 255};
}

glm::dvec3 to_rgb(const Hsv& hsv) {
  const auto component = [&](double offset) {
    const double circles = hsv.hue_deg / 360 + offset;
    const double sixths = 6 * (circles - std::floor(circles));
    const double away = std::clamp(2 - std::abs(sixths - 3), 0.0, 1.0);
    return 255 * hsv.value * (1 - hsv.saturation * away);
  };
  return {component(0), component(-1.0 / 3), component(1.0 / 3)};
}

glm::dvec3 colourised(const glm::dvec3& image_rgb, const glm::dvec3& colour_rgb) {
  const double value = std::max({image_rgb.x, image_rgb.y, image_rgb.z});
  const double most = std::max({colour_rgb.x, colour_rgb.y, colour_rgb.z});
  return most > 0 ? colour_rgb * (value / most) : glm::dvec3(value);
}

}  // namespace vpe::core
