#include "mars/sources/combine.h"

#include <algorithm>
#include <cmath>

#include "mars/sources/convert.h"
#include "mars/sources/source_checks.h"
#include "mars/sources/stack_walk.h"
#include "vpe/base/number.h"
#include "vpe/base/quantile.h"

namespace mars {
namespace {

using Source = std::shared_ptr<const ElevationSource>;

constexpr std::size_t kComparedPosts = 20'000;
constexpr int kMaskMargin_posts = 2;  // posts beside an outlier often lie on its flanks

std::string metres(double value, int decimals = 1) { return vpe::base::format_fixed(value, decimals) + " m"; }

// Describes the median of a - b where both have data. b is the finer one: its posts are compared.
std::string difference(const ElevationSource& a, const ElevationSource& b) {
  std::vector<double> off;
  std::vector<double> other;
  b.visit_means(kComparedPosts, [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
    other.resize(directions.size());
    a.sample(directions, 0, other);
    for (std::size_t i = 0; i < other.size(); ++i) {
      if (std::isfinite(other[i] - heights_m[i])) off.push_back(other[i] - heights_m[i]);
    }
  });
  if (off.empty()) return "they have no place in common";
  return "where both have data the first lies " + metres(vpe::base::median_upper(off)) +
         " above the second (median of " + std::to_string(off.size()) + " places)";
}

// Returns the datum of the planet.
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
          known->infos().front().name + " has heights of datum '" + to_string(first) + "', but " + info.name +
          " has heights of datum '" + to_string(info.datum) + "'; " + difference(*known, *source) +
          ". Give --to-datum to convert all rasters to the datum of the first (to or from the areoid also "
          "--areoid FILE), or build without one of them");
    }
  }
  // Radii become heights above the planet's sphere, without loss.
  return first.kind == DatumKind::kRadius ? sphere : first;
}

// Returns true if the user states that this source has the datum of the others, whichever that is.
bool is_of_any_datum(const SourceInfo& info, const CombineOptions& options) {
  return !info.datum.is_known() && !options.convert && !options.true_radii &&
         options.same_datum.contains(info.name);
}

// Returns the conversion of one source. Adds a note if its datum is only assumed.
Conversion conversion_of(const SourceInfo& info, const VerticalDatum& datum, const CombineOptions& options,
                         std::vector<std::string>& notes) {
  if (is_of_any_datum(info, options)) return {};
  if (!info.datum.is_known() && !options.convert && !options.true_radii) {
    notes.push_back(info.name + " does not state its vertical datum" +
                    (datum.is_known() ? "; '" + to_string(datum) + "' is assumed, as for the others" : "") +
                    " (name it with --datum)");
    return {};
  }
  return conversion(info, datum, options.areoid);
}

// Returns the treatment of a masked inset. Planet files store this text: it must not change.
std::string mask_treatment(const OutlierOptions& options) {
  const auto digits = [](double value) { return vpe::base::format_general(value, 12); };
  return "posts dropped that lie more than " + digits(options.floor_m) + " m, " + digits(options.relief_share) +
         " of the relief and a slope of " + digits(options.slope) + " off what is below";
}

// Returns the source with heights of the given datum.
Source in_datum(const Source& source, const Conversion& conversion, const VerticalDatum& datum) {
  if (conversion.adjustment) return adjusted(source, conversion.adjustment, datum, conversion.treatment);
  if (source->infos().front().datum == datum) return source;
  return adjusted(
      source, [](std::span<const glm::dvec3>, std::span<double>) {}, datum, "");
}

CombineOptions::Alignment alignment_of(const std::string& name, const CombineOptions& options) {
  const auto own = options.alignments.find(name);
  return own != options.alignments.end() ? own->second : options.alignment;
}

// Aligns an inset to its base and finds its outliers, as the options say.
Source aligned_and_checked(Source inset, const Source& base, const CombineOptions& options,
                           CombineFinding& finding, std::vector<std::string>& notes) {
  const VerticalDatum datum = inset->infos().front().datum;
  if (alignment_of(finding.name, options) == CombineOptions::Alignment::kPlane) {
    finding.alignment = fit_alignment(*inset, *base, options.radius_m, options.stack.feather_posts);
    if (finding.alignment) {
      inset = adjusted(inset, alignment_adjustment(*finding.alignment), datum, to_string(*finding.alignment));
    } else {
      notes.push_back(finding.name +
                      " is not aligned (--align plane): too few posts along the boundary of its data "
                      "have data below them");
    }
  }
  if (!options.check_outliers && !options.reject_outliers) return inset;
  finding.outliers = find_outliers(*inset, *base, options.radius_m, options.outliers);
  if (!options.reject_outliers || finding.outliers->implausible == 0) return inset;
  const auto* maskable = dynamic_cast<const Maskable*>(inset.get());
  if (maskable == nullptr) return inset;
  Source masked = maskable->with_mask(outlier_mask(base, options.radius_m, options.outliers), kMaskMargin_posts,
                                      mask_treatment(options.outliers));
  if (masked == nullptr) return inset;
  finding.masked = true;
  return masked;
}

}  // namespace

Combined combine_elevation(std::vector<Source> sources, const CombineOptions& options) {
  std::vector<Source> order = by_resolution(std::move(sources), options.stack);
  Combined combined;
  std::set<std::string> silent;  // sources whose datum is only assumed
  for (const Source& source : order) {
    const SourceInfo info = source->infos().front();
    check_body(info, options.radius_m);
    combined.notes.insert(combined.notes.end(), info.notes.begin(), info.notes.end());
    if (!info.datum.is_known() && !is_of_any_datum(info, options)) silent.insert(info.name);
  }
  std::reverse(order.begin(), order.end());
  combined.datum = choose_datum(order, options);
  if (options.convert && options.datum.kind == DatumKind::kRadius) {
    combined.notes.push_back("distances from the centre are stored as heights above the sphere, datum '" +
                             to_string(combined.datum) + "'; 'vpe query --json' has the distance as radius_m");
  }
  for (const Source& source : order)
    check_range(*source, source->infos().front(), options.radius_m, combined.notes);
  combined.true_radii = options.true_radii || (combined.datum == VerticalDatum::sphere(options.radius_m) &&
                                               std::any_of(order.begin(), order.end(), [](const Source& s) {
                                                 return s->infos().front().datum.kind == DatumKind::kRadius;
                                               }));
  std::vector<Source> below;  // the finest first: stack_elevation() gives ties to the first
  for (const Source& source : order) {
    CombineFinding finding;
    const SourceInfo info = source->infos().front();
    finding.name = info.name;
    Source layer =
        in_datum(source, conversion_of(info, combined.datum, options, combined.notes), combined.datum);
    if (!below.empty()) {
      Source base = below.size() == 1 ? below.front() : stack_elevation(below, options.stack);
      check_silent_datums(*layer, *base, options.radius_m, silent, options.same_datum);
      layer = aligned_and_checked(std::move(layer), base, options, finding, combined.notes);
      if (alignment_of(finding.name, options) == CombineOptions::Alignment::kEdges) {
        finding.edge_matching = fit_edge_matching(*layer, *base, options.radius_m);
        if (finding.edge_matching) {
          base = adjusted(std::move(base), edge_adjustment(*finding.edge_matching), combined.datum,
                          to_string(*finding.edge_matching, finding.name));
          below = {base};
        } else {
          combined.notes.push_back("the base is not matched to " + finding.name +
                                   " (--align edges): there is no data below the boundary of its data");
        }
      }
    }
    combined.findings.push_back(std::move(finding));
    below.insert(below.begin(), std::move(layer));
  }
  if (options.finish)
    for (Source& source : below) source = options.finish(std::move(source));
  combined.source = below.size() == 1 ? below.front() : stack_elevation(below, options.stack);
  return combined;
}

}  // namespace mars
