#include "vpe/app/picture/view_palette.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <stdexcept>

#include "paging/planet/planet_user.h"
#include "paging/shading/terrain_shader.h"
#include "paging/surface/height_difference.h"
#include "vpe/app/picture/comparison.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/base/nice_ticks.h"
#include "vpe/base/number.h"
#include "vpe/base/quantile.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {

namespace {

constexpr std::size_t kMostSampleBytes = std::size_t{192} << 20;
// Slopes are read from a picture of reds: three levels a degree. Nodata ground is grey.
constexpr double kMostSlope_deg = 85;

// Returns the settings of a picture whose reds are slopes.
core::SettingsValues sample_settings(const core::SettingsValues& shown) {
  core::SettingsValues out;
  out.exaggeration = shown.exaggeration;
  out.shading = shown.shading;
  out.mode = core::Mode::kUnlit;
  out.colour = core::Colour::kSlope;
  out.palette = "hsv";
  out.palette_low = 0;
  out.palette_high = kMostSlope_deg;
  out.low_hue_deg = out.high_hue_deg = 0;
  out.low_saturation = out.high_saturation = 1;
  out.low_value = 0;
  out.high_value = 1;
  out.background = core::Background::kBlack;
  out.smooth_edges = false;
  out.ray_mode = core::RayMode::kMultires;
  return out;
}

}  // namespace

bool needs_view_palette(const core::SettingsValues& settings, const paging::PlanetFile& planet) {
  const bool is_value = settings.colour == core::Colour::kElevation ||
                        settings.colour == core::Colour::kSlope || settings.colour == core::Colour::kAspect ||
                        settings.colour == core::Colour::kDifference;
  return core::has_auto_ends(settings) && is_value &&
         (settings.legend || paging::needs_scale(settings, planet.meta().finest_image_level >= 0));
}

core::DrawRequest reduced(core::DrawRequest request) {
  core::View& view = request.view;
  if (view.part.width != 0) throw std::logic_error("reduced: the view has a part");
  const double factor = std::min(1.0, static_cast<double>(kReducedSide_px) / std::max(view.width, view.height));
  const auto side = [&](int px) { return std::max(1, static_cast<int>(std::lround(px * factor))); };
  view.width = side(view.width);
  view.height = side(view.height);
  view.principal_offset_px *= factor;
  return request;
}

std::optional<core::PaletteEnds> palette_ends(std::vector<double>& values) {
  constexpr double kSteps = 20;
  if (values.empty()) return std::nullopt;
  const double low = base::quantile_round(values, kBeyondPaletteEnd);
  const double high = base::quantile_round(values, 1 - kBeyondPaletteEnd);
  // Noise of flat ground is not stretched to the whole palette.
  constexpr double kLeastSpan = 1;
  const double step = base::nice_step_below(std::max(high - low, kLeastSpan) / kSteps);
  const auto multiple = [&](double n) {
    const std::string text = base::format_fixed(n * step, base::step_decimals(step));
    return base::parse_number(text).value_or(n * step) + 0.0;  // no negative zero
  };
  core::PaletteEnds ends{multiple(std::floor(low / step)), multiple(std::ceil(high / step))};
  if (ends.high - ends.low < kLeastSpan) ends.high = multiple(std::round(ends.low / step) + kSteps);
  return ends;
}

// Values of the tiles that pixels fall into, with posts about as far apart as the pixels.
class ViewPalette::Differences {
 public:
  Differences(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes)
      : later_(planet, budget_bytes / 2), earlier_(planet->earlier(), budget_bytes / 2) {}

  // Returns the difference at the post nearest to a direction, or nullopt where it has no data.
  std::optional<double> at(const glm::dvec3& direction, double footprint_m) {
    const paging::PlanetFile& planet = later_.planet();
    const int intervals = planet.meta().tile.intervals();
    const mars::ChartPoint place = mars::chart_point(direction);
    const double root_m = lod::nominal_side_m(0, planet.radius_m()) / intervals;
    const int level = static_cast<int>(std::ceil(std::log2(root_m / footprint_m)));
    const lod::TileKey key =
        planet.tree().deepest(lod::tile_at(place, std::clamp(level, 0, lod::kMaxLevel))).key;
    const Tile& tile = tiles_.try_emplace(lod::pack(key)).first->second;
    if (tile.lines.u.empty()) fill(key, intervals, tiles_.at(lod::pack(key)));
    const std::size_t post =
        nearest(tile.lines.v, place.v) * tile.lines.u.size() + nearest(tile.lines.u, place.u);
    const double difference = tile.difference_m[post];
    return std::isnan(difference) ? std::nullopt : std::optional(difference);
  }

 private:
  struct Tile {
    lod::GridLines lines;
    std::vector<double> difference_m;  // NaN at nodata
  };

  void fill(const lod::TileKey& key, int intervals, Tile& tile) const {
    const paging::PostHeights later = paging::heights_at_posts(later_, key, intervals);
    const paging::PostHeights earlier = paging::heights_at_posts(earlier_, key, intervals);
    tile.lines = lod::grid_lines(key, intervals);
    tile.difference_m.resize(later.height_m.size());
    const auto has_data = [](const paging::PostHeights& of, std::size_t n) {
      return of.nodata.empty() || !of.nodata[n];
    };
    for (std::size_t n = 0; n < tile.difference_m.size(); ++n)
      tile.difference_m[n] =
          has_data(later, n) && has_data(earlier, n) ? later.height_m[n] - earlier.height_m[n] : std::nan("");
  }

  static std::size_t nearest(const std::vector<double>& lines, double x) {
    const auto above = std::upper_bound(lines.begin() + 1, lines.end() - 1, x);
    const bool is_below_middle = x - *(above - 1) < *above - x;
    return static_cast<std::size_t>(above - lines.begin()) - (is_below_middle ? 1 : 0);
  }

  paging::Surface later_;
  paging::Surface earlier_;
  std::map<std::int64_t, Tile> tiles_;
};

core::PaletteEnds difference_ends(std::span<const double> values) {
  constexpr double kSteps = 20;
  constexpr double kLeast_m = 0.1;
  double most = kLeast_m;
  for (const double value : values) most = std::max(most, std::abs(value));
  const double step = base::nice_step_below(most / kSteps);
  // Of a decimal number, so that no end is 0.30000000000000004.
  const std::string text = base::format_fixed(std::ceil(most / step) * step, base::step_decimals(step));
  const double end = base::parse_number(text).value_or(most);
  return {-end, end};
}

ViewPalette::ViewPalette(std::shared_ptr<const paging::PlanetFile> planet, const Common& common)
    : planet_(std::move(planet)),
      rays_(voxel::make_ray_renderer(
          planet_,
          {.memory_bytes = std::min(memory_bytes(common) / 4, kMostSampleBytes), .threads = common.threads})) {}

ViewPalette::~ViewPalette() = default;

void ViewPalette::change_planet(std::shared_ptr<const paging::PlanetFile> planet) {
  if (planet == planet_) return;
  paging::change_planet(*rays_, planet);
  planet_ = std::move(planet);
}

void ViewPalette::add(const core::DrawRequest& request) {
  is_circle_ = request.settings.colour == core::Colour::kAspect;
  if (is_circle_) return;
  const bool is_slope = request.settings.colour == core::Colour::kSlope;
  is_difference_ = request.settings.colour == core::Colour::kDifference;
  std::optional<Differences> differences;
  if (is_difference_) {
    require_earlier(request.settings, *planet_);
    differences.emplace(planet_, kMostSampleBytes / 2);
  }
  core::DrawRequest sample;
  sample.view = request.view;
  sample.settings = sample_settings(request.settings);
  sample.want_range = true;
  const core::Frame frame = rays_->draw(sample).frame;
  const core::SubRectangle part = core::drawn_part(sample.view);
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x);
      const auto range_m = static_cast<double>(frame.range_m[pixel]);
      const base::Rgb colour = frame.colour[pixel];
      const bool has_data = colour.g == 0 && colour.b == 0;
      if (!(range_m > 0) || !std::isfinite(range_m) || !has_data) continue;
      if (is_slope) {
        values_.push_back(colour.r * kMostSlope_deg / 255);
        continue;
      }
      const glm::dvec3 ray = core::pixel_ray(sample.view, part.x + x + 0.5, part.y + y + 0.5);
      const glm::dvec3 place_m = sample.view.camera.position_m + ray * range_m;
      const double radius_m = glm::length(place_m);
      if (differences) {
        const auto difference = differences->at(place_m / radius_m, range_m / core::focal_px(sample.view));
        if (difference) values_.push_back(*difference);
        continue;
      }
      values_.push_back((radius_m - planet_->radius_m()) / request.settings.exaggeration);
    }
  }
}

core::PaletteEnds ViewPalette::ends() {
  if (is_circle_) return {0, 360};
  if (is_difference_) return difference_ends(values_);
  return palette_ends(values_).value_or(core::PaletteEnds());
}

void take_ends(core::SettingsValues& settings, const core::PaletteEnds& view) {
  const core::PaletteEnds ends = core::ends_of(settings, view);
  settings.palette_low = ends.low;
  settings.palette_high = ends.high;
}

void take_ends(core::Settings& settings, const core::PaletteEnds& view) {
  const core::PaletteEnds ends = core::ends_of(settings.values(), view);
  for (const auto& [key, value] : {std::pair("palette.low", ends.low), std::pair("palette.high", ends.high)}) {
    if (const std::string problem = settings.set(key, base::format_number(value)); !problem.empty())
      throw std::logic_error(problem);
  }
}

std::string palette_text(const core::SettingsValues& settings) {
  const bool is_metres =
      settings.colour == core::Colour::kElevation || settings.colour == core::Colour::kDifference;
  const char* unit = is_metres ? " m" : " degrees";
  if (settings.palette_low == settings.palette_high)
    return "palette of its usual range: the view shows no ground";
  return "palette from " + base::format_number(settings.palette_low.value_or(0)) + " to " +
         base::format_number(settings.palette_high.value_or(0)) + unit + ", by the view";
}

}  // namespace vpe::app
