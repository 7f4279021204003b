#include "vpe/app/planet/build_sources.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "mars/embedded/detail_below.h"
#include "mars/geodesy/bodies.h"
#include "mars/sources/adjusted.h"
#include "vpe/app/planet/source_mask.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

using Source = std::shared_ptr<const mars::ElevationSource>;

constexpr const char* kSameDatum = "same";

mars::VerticalDatum checked_datum(const std::string& option, const std::string& text, double radius_m) {
  const auto datum = mars::parse_datum(text, radius_m);
  if (datum) return *datum;
  throw UsageError(option + " '" + text +
                   "': expected areoid, radius, sphere, sphere:RADIUS_M or ellipsoid:EQUATORIAL_M,POLAR_M" +
                   (option == "--datum" ? ", or same" : ""));
}

double body_radius_m(const std::vector<Source>& sources) {
  for (const Source& source : sources) {
    for (const mars::SourceInfo& info : source->infos()) {
      if (info.body_radius_m > 0) return info.body_radius_m;
    }
  }
  return mars::kMarsRadius_m;
}

// Returns the name of the body that the first of these states, "" if none does.
std::string stated_body(const std::vector<Source>& sources) {
  for (const Source& source : sources) {
    for (const mars::SourceInfo& info : source->infos()) {
      if (!info.body.empty()) return info.body;
    }
  }
  return "";
}

void choose_body(const SourceArguments& arguments, const std::vector<Source>& sources,
                 paging::BuildOptions& options) {
  const double own_m = body_radius_m(sources);
  const mars::Body* body = nullptr;
  if (!arguments.body.empty()) {
    body = mars::find_body(std::string_view(arguments.body));
    if (body == nullptr && arguments.radius_m <= 0) {
      throw UsageError("--body " + arguments.body + ": its radius is not known here; give --radius too");
    }
  } else {
    body = mars::find_body(arguments.radius_m > 0 ? arguments.radius_m : own_m);
  }
  options.body = !arguments.body.empty() ? arguments.body
                 : body != nullptr       ? std::string(body->name)
                                         : "unnamed";
  options.radius_m = arguments.radius_m > 0 ? arguments.radius_m : body != nullptr ? body->radius_m : own_m;
  // Small bodies have maps on spheres of any radius; their products name them.
  const std::string stated = stated_body(sources);
  if (arguments.body.empty() && arguments.radius_m <= 0 && !stated.empty()) options.body = stated;
}

// Sets how single sources, or all, are aligned.
void name_alignments(const SourceArguments& arguments, const std::vector<Source>& sources,
                     mars::CombineOptions& combine) {
  using Alignment = mars::CombineOptions::Alignment;
  static const std::map<std::string, Alignment> kAlignments{
      {"none", Alignment::kNone}, {"plane", Alignment::kPlane}, {"edges", Alignment::kEdges}};
  for (const std::string& text : arguments.alignments) {
    const NamedValue option = named_value(text);
    const auto alignment = kAlignments.find(option.value);
    if (alignment == kAlignments.end()) throw UsageError("--align " + text + ": expected none, plane or edges");
    if (option.name.empty()) {
      combine.alignment = alignment->second;
      continue;
    }
    const std::vector<std::size_t> found = named_sources(sources, option.name);
    if (found.empty()) throw UsageError("--align " + text + ": no raster is called '" + option.name + "'");
    combine.alignments[sources[found.front()]->infos().front().name] = alignment->second;
  }
}

// Returns the source with the datum that the user states.
Source with_datum(const Source& source, const mars::VerticalDatum& datum) {
  const mars::SourceInfo info = source->infos().front();
  if (datum == info.datum) return source;
  // Planet files store this text: it must not change.
  std::string treatment = "datum named as " + to_string(datum);
  if (info.datum.is_known()) treatment += " against the product's own words (" + to_string(info.datum) + ")";
  const mars::HeightAdjustment nothing = [](std::span<const glm::dvec3>, std::span<double>) {};
  return mars::adjusted(source, nothing, datum, treatment);
}

// Sets the datum that --datum states: of the source of that name, or of all sources without a datum of their
// own.
void name_datums(const SourceArguments& arguments, std::vector<Source>& sources) {
  std::vector<bool> named(sources.size(), false);
  for (const std::string& text : arguments.datums) {
    const NamedValue option = named_value(text);
    if (option.value == kSameDatum) continue;
    const std::vector<std::size_t> means = named_sources(sources, option.name);
    bool found = false;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const mars::SourceInfo info = sources[i]->infos().front();
      if (option.name.empty() ? info.datum.is_known() || named[i] : !std::ranges::count(means, i)) continue;
      found = true;
      named[i] = true;
      const double sphere_m = info.body_radius_m > 0 ? info.body_radius_m : mars::kMarsRadius_m;
      sources[i] = with_datum(sources[i], checked_datum("--datum", option.value, sphere_m));
    }
    if (!found && !option.name.empty())
      throw UsageError("--datum " + text + ": no raster is called '" + option.name + "'");
  }
}

// Gives the sources of --datum [NAME=]same the datum of the coarsest raster that has one. Where none has, returns
// their names.
std::set<std::string> name_same_datums(const SourceArguments& arguments, std::vector<Source>& sources) {
  const mars::ElevationSource* coarsest = nullptr;
  for (const Source& source : sources) {
    if (source->infos().front().datum.is_known() &&
        (coarsest == nullptr ||
         source->infos().front().resolution_m > coarsest->infos().front().resolution_m)) {
      coarsest = source.get();
    }
  }
  const mars::VerticalDatum datum =
      coarsest != nullptr ? coarsest->infos().front().datum : mars::VerticalDatum();
  std::set<std::string> same;
  for (const std::string& text : arguments.datums) {
    const NamedValue option = named_value(text);
    if (option.value != kSameDatum) continue;
    bool found = false;
    const std::vector<std::size_t> means = named_sources(sources, option.name);
    for (std::size_t i = 0; i < sources.size(); ++i) {
      Source& source = sources[i];
      const mars::SourceInfo info = source->infos().front();
      if (option.name.empty() ? info.datum.is_known() : !std::ranges::count(means, i)) continue;
      found = true;
      if (datum.is_known()) {
        source = with_datum(source, datum);
      } else {
        same.insert(info.name);
      }
    }
    if (!found && !option.name.empty())
      throw UsageError("--datum " + text + ": no raster is called '" + option.name + "'");
  }
  return same;
}

std::string number(double value) { return base::format_significant(value, 4); }

std::string coordinates(const mars::LonLat& at) {
  constexpr int kDecimals = 4;  // 6 m on Mars
  return base::format_rounded(at.lon_deg, kDecimals) + "," + base::format_rounded(at.lat_deg, kDecimals);
}

std::string percentage(const mars::OutlierReport& report) {
  const double percent = 100.0 * static_cast<double>(report.implausible) / static_cast<double>(report.posts);
  return percent < 10 ? base::format_significant(percent, 2) : base::format_rounded(percent, 0);
}

// Describes the tilt of an inset against its base: metres per kilometre, and the azimuth towards which it
// rises.
std::string tilt_text(const mars::VerticalAlignment& alignment) {
  const double tilt = std::hypot(alignment.tilt_east, alignment.tilt_north);
  double azimuth = std::atan2(alignment.tilt_east, alignment.tilt_north) / mars::kRadiansPerDegree;
  if (azimuth < 0) azimuth += 360;
  return number(1000 * tilt) + " m/km rising towards " + base::format_rounded(azimuth, 0) + " degrees";
}

}  // namespace

void add_source_options(CLI::App& command, SourceArguments& a) {
  command
      .add_option(
          "--datum", a.datums,
          "[NAME=]DATUM: vertical datum of the rasters that do not state one, or of the raster NAME alone: "
          "areoid, radius, sphere, sphere:RADIUS_M, ellipsoid:EQUATORIAL_M,POLAR_M, or same: that of the other "
          "rasters, whatever they differ by (repeatable)")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_flag(
      "--to-datum{base}", a.to_datum,
      "Convert all rasters to one vertical datum: that of the coarsest, or DATUM in --to-datum=DATUM");
  command.add_option(
      "--areoid", a.areoid,
      "Raster of the areoid's radii, such as MOLA's MEGA, for conversions to and from the areoid");
  command
      .add_option(
          "--shape", a.shape,
          "sphere: heights stand on the sphere, whatever their datum; radius: heights become true radii")
      ->check(CLI::IsMember({"sphere", "radius"}))
      ->capture_default_str();
  command
      .add_option(
          "--align", a.alignments,
          "[NAME=]WAY: plane: remove offset and tilt of each inset, or of the raster NAME alone, fitted along its "
          "boundary; edges: warp the base to meet it, so that it keeps its heights; none (default) (repeatable)")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option(
          "--mask", a.masks,
          "NAME=RASTER: leave out posts of the raster NAME where RASTER, a mask of any grid, is below 0.5 or "
          "has no data (repeatable)")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--feather", a.feather_m,
                  "Width over which insets fade into the base, metres (default: 16 posts of the inset, but at "
                  "least 2 of the base)")
      ->check(number_within(0.001, 1e7));
  command.add_flag("--reject-outliers", a.reject_outliers,
                   "Reject posts that deviate implausibly from the underlying raster");
  command
      .add_option("--blunder", a.outlier_floor_m,
                  "Deviation from the underlying raster that is always accepted as terrain, metres")
      ->check(number_within(0.001, 1e6))
      ->capture_default_str();
  command.add_option("--body", a.body, "Name of the body (default: the body of the rasters)");
  command.add_option("--radius", a.radius_m, "Radius of the sphere, metres (default: the body's)")
      ->check(number_within(100.0, 1e9));
}

mars::Combined combine_sources(std::vector<Source> sources, const SourceArguments& arguments,
                               paging::BuildOptions& options) {
  choose_body(arguments, sources, options);
  name_datums(arguments, sources);
  mars::CombineOptions combine;
  combine.same_datum = name_same_datums(arguments, sources);
  combine.radius_m = options.radius_m;
  combine.true_radii = arguments.shape == "radius";
  combine.convert = !arguments.to_datum.empty();
  if (combine.convert && arguments.to_datum != "base") {
    combine.datum = checked_datum("--to-datum", arguments.to_datum, options.radius_m);
  }
  if (!arguments.areoid.empty()) {
    std::vector<Source> areoid{mars::open_elevation(arguments.areoid)};
    if (!areoid[0]->infos().front().datum.is_known()) name_datums(arguments, areoid);
    combine.areoid = areoid[0];
  }
  name_alignments(arguments, sources, combine);
  combine.reject_outliers = arguments.reject_outliers;
  combine.outliers.floor_m = arguments.outlier_floor_m;
  combine.stack.feather_m = arguments.feather_m;
  if (arguments.adds_detail) {
    if (std::abs(options.radius_m - mars::kMarsRadius_m) > 0.01 * mars::kMarsRadius_m)
      throw UsageError("--detail synthetic: the detail is that of Mars; leave it out for " + options.body);
    if (!(options.finest_spacing_m > 0))
      throw UsageError(
          "--detail synthetic: say how fine posts shall be with --spacing, and where with --region");
    combine.finish = [finest_m = options.finest_spacing_m](Source source) {
      const auto infos = source->infos();
      const bool has_detail = std::ranges::any_of(infos, [](const auto& info) { return info.illustration; });
      return has_detail ? source : mars::with_detail(std::move(source), finest_m);
    };
  }
  mars::Combined combined = mars::combine_elevation(std::move(sources), combine);
  options.true_radii = combined.true_radii;
  return combined;
}

void print_findings(const mars::Combined& combined) {
  for (const std::string& note : combined.notes) std::fprintf(stderr, "vpe: note: %s\n", note.c_str());
  for (const mars::CombineFinding& f : combined.findings) {
    if (const auto& a = f.alignment) {
      std::fprintf(
          stderr,
          "vpe: %s lies %s m above the base, with a tilt of %s (%lld posts along its boundary); removed: "
          "the RMS difference there was %s m and is now %s m\n",
          f.name.c_str(), number(a->offset_m).c_str(), tilt_text(*a).c_str(), static_cast<long long>(a->posts),
          number(a->rms_before_m).c_str(), number(a->rms_after_m).c_str());
    }
    if (const auto& e = f.edge_matching) {
      std::fprintf(stderr, "vpe: the base is warped to meet %s: by %s m RMS at its boundary, over %s km\n",
                   f.name.c_str(), number(e->rms_m).c_str(), number(1e-3 * e->reach_m).c_str());
    }
    if (f.outliers && f.outliers->implausible > 0) {
      std::fprintf(stderr, "vpe: %s: %s %% of its posts are implausible, by up to %s m at %s; %s\n",
                   f.name.c_str(), percentage(*f.outliers).c_str(), number(f.outliers->worst_m).c_str(),
                   coordinates(f.outliers->worst_at).c_str(),
                   f.masked ? "rejected" : "--reject-outliers rejects them");
    }
  }
}

nlohmann::json findings_json(const mars::Combined& combined) {
  using nlohmann::json;
  json list = json::array();
  for (const mars::CombineFinding& f : combined.findings) {
    json entry{{"name", f.name}, {"level", nullptr}, {"bend", nullptr}, {"implausible", nullptr}};
    if (const auto& a = f.alignment) {
      entry["level"] = {
          {"lon_deg", a->centre.lon_deg},  {"lat_deg", a->centre.lat_deg}, {"offset_m", a->offset_m},
          {"tilt_east", a->tilt_east},     {"tilt_north", a->tilt_north},  {"rms_before_m", a->rms_before_m},
          {"rms_after_m", a->rms_after_m}, {"rim_posts", a->posts},        {"rim_posts_left_out", a->left_out}};
    }
    if (const auto& e = f.edge_matching) {
      entry["bend"] = {
          {"rms_m", e->rms_m}, {"largest_m", e->largest_m}, {"reach_m", e->reach_m}, {"rim_posts", e->posts}};
    }
    if (f.outliers) {
      entry["implausible"] = {{"posts_compared", f.outliers->posts},
                              {"posts", f.outliers->implausible},
                              {"worst_m", f.outliers->worst_m},
                              {"worst_lon_deg", f.outliers->worst_at.lon_deg},
                              {"worst_lat_deg", f.outliers->worst_at.lat_deg},
                              {"dropped", f.masked}};
    }
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace vpe::app
