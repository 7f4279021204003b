#include "mars/sources/combine.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mars/sources/convert.h"
#include "mars/sources/stack_walk.h"

namespace mars {
namespace {

using Source = std::shared_ptr<const ElevationSource>;

constexpr std::size_t kComparedPosts = 20'000;
constexpr int kMaskMargin = 2;  // posts beside a blunder lie on its flanks

std::string metres(double value, int digits = 1) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f m", digits, value);
  return text;
}

// Median of a - b where both have data, as words. b is the finer one: posts of it are looked at.
std::string difference(const ElevationSource& a, const ElevationSource& b) {
  std::vector<double> off;
  std::vector<double> other;
  b.visit_posts(kComparedPosts, [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
    other.resize(directions.size());
    a.sample(directions, 0, other);
    for (std::size_t i = 0; i < other.size(); ++i) {
      if (std::isfinite(other[i] - heights_m[i])) off.push_back(other[i] - heights_m[i]);
    }
  });
  if (off.empty()) return "they have no place in common";
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return "where both have data the first is " + metres(*middle) + " above the second (median of " +
         std::to_string(off.size()) + " places)";
}

void check_body(const SourceInfo& info, double radius_m) {
  if (info.body_radius_m <= 0 || std::abs(info.body_radius_m / radius_m - 1) <= kBodyMismatch) return;
  throw SourceError(info.name + ": is of a body of radius " + metres(info.body_radius_m, 0) +
                    ", but the planet's is " + metres(radius_m, 0) +
                    "; give the planet's (--body or --radius), or leave this raster out");
}

// The one datum that all sources get.
VerticalDatum choose_datum(const std::vector<Source>& coarsest_first, const CombineOptions& options) {
  const VerticalDatum sphere = VerticalDatum::sphere(options.radius_m);
  if (options.true_radii) return sphere;
  if (options.convert && options.datum.is_known()) {
    return options.datum.kind == DatumKind::kRadius ? sphere : options.datum;
  }
  VerticalDatum first;
  const ElevationSource* known = nullptr;
  for (const Source& source : coarsest_first) {
    const SourceInfo info = source->infos().front();
    if (!info.datum.is_known()) continue;
    if (known == nullptr) {
      known = source.get();
      first = info.datum;
    } else if (!(info.datum == first) && !options.convert) {
      throw SourceError(
          known->infos().front().name + " holds heights of datum '" + to_string(first) + "' but " + info.name +
          " of '" + to_string(info.datum) + "'; " + difference(*known, *source) +
          ". Give --convert to bring all to the first one's (between the areoid and anything else "
          "with --areoid FILE), or build without one of them");
    }
  }
  // Radii are drawn as heights above the planet's sphere, which loses nothing.
  return first.kind == DatumKind::kRadius ? sphere : first;
}

// The conversion of one source; says what is only assumed.
Conversion conversion_of(const SourceInfo& info, const VerticalDatum& datum, const CombineOptions& options,
                         std::vector<std::string>& notes) {
  if (!info.datum.is_known() && !options.convert && !options.true_radii) {
    notes.push_back(info.name + " does not say what its heights are counted from" +
                    (datum.is_known() ? "; taken as '" + to_string(datum) + "' like the others" : "") +
                    " (name it with --datum)");
    return {};
  }
  return conversion(info, datum, options.areoid);
}

// "150 m", without needless digits.
std::string masked_words(const OutlierOptions& options) {
  char text[160];
  std::snprintf(
      text, sizeof text,
      "posts dropped that lie more than %.12g m, %.12g of the relief and a slope of %.12g off what is below",
      options.floor_m, options.relief_share, options.slope);
  return text;
}

Source as_datum(const Source& source, const Conversion& conversion, const VerticalDatum& datum) {
  if (conversion.adjust) return adjusted(source, conversion.adjust, datum, conversion.treatment);
  if (source->infos().front().datum == datum) return source;
  return adjusted(
      source, [](std::span<const glm::dvec3>, std::span<double>) {}, datum, "");
}

// Levels an inset to what lies below it and looks for its blunders.
Source inspect(Source inset, const Source& base, const CombineOptions& options, CombineFinding& finding,
               std::vector<std::string>& notes) {
  const VerticalDatum datum = inset->infos().front().datum;
  if (options.level == CombineOptions::VerticalAlignment::kPlane) {
    finding.level = fit_alignment(*inset, *base, options.radius_m, options.stack.feather_posts);
    if (finding.level) {
      inset = adjusted(inset, aligning(*finding.level), datum, to_string(*finding.level));
    } else {
      notes.push_back(finding.name + " is not levelled: too few posts of its rim have data below them");
    }
  }
  if (!options.check_outliers && !options.reject_outliers) return inset;
  finding.outliers = find_blunders(*inset, *base, options.radius_m, options.outliers);
  if (!options.reject_outliers || finding.outliers->implausible == 0) return inset;
  const auto* maskable = dynamic_cast<const Maskable*>(inset.get());
  if (maskable == nullptr) return inset;
  Source masked = maskable->with_mask(blunder_mask(base, options.radius_m, options.outliers), kMaskMargin,
                                      masked_words(options.outliers));
  if (masked == nullptr) return inset;
  finding.masked = true;
  return masked;
}

}  // namespace

Combined combine_elevation(std::vector<Source> sources, const CombineOptions& options) {
  std::vector<Source> order = by_resolution(std::move(sources), options.stack);
  for (const Source& source : order) check_body(source->infos().front(), options.radius_m);
  std::reverse(order.begin(), order.end());
  Combined combined;
  combined.datum = choose_datum(order, options);
  combined.true_radii = options.true_radii || (combined.datum == VerticalDatum::sphere(options.radius_m) &&
                                               std::any_of(order.begin(), order.end(), [](const Source& s) {
                                                 return s->infos().front().datum.kind == DatumKind::kRadius;
                                               }));
  std::vector<Source> below;  // the finest first, as a stack wants ties
  for (const Source& source : order) {
    CombineFinding finding;
    const SourceInfo info = source->infos().front();
    finding.name = info.name;
    Source layer =
        as_datum(source, conversion_of(info, combined.datum, options, combined.notes), combined.datum);
    if (!below.empty()) {
      Source base = below.size() == 1 ? below.front() : stack_elevation(below, options.stack);
      layer = inspect(std::move(layer), base, options, finding, combined.notes);
      if (options.level == CombineOptions::VerticalAlignment::kEdges) {
        finding.bend = fit_edge_matching(*layer, *base, options.radius_m);
        if (finding.bend) {
          base = adjusted(std::move(base), matching_edges(*finding.bend), combined.datum,
                          to_string(*finding.bend, finding.name));
          below = {base};
        } else {
          combined.notes.push_back("nothing is bent to meet " + finding.name +
                                   ": its rim has no data below it");
        }
      }
    }
    combined.findings.push_back(std::move(finding));
    below.insert(below.begin(), std::move(layer));
  }
  combined.source = below.size() == 1 ? below.front() : stack_elevation(below, options.stack);
  return combined;
}

}  // namespace mars
