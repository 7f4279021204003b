#include "vpe/app/planet/build_sources.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "mars/geodesy/bodies.h"
#include "mars/sources/adjusted.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

using Source = std::shared_ptr<const mars::ElevationSource>;

mars::VerticalDatum checked_datum(const std::string& option, const std::string& text, double radius_m) {
  const auto datum = mars::parse_datum(text, radius_m);
  if (datum) return *datum;
  throw UsageError(option + " '" + text +
                   "': expected areoid, radius, sphere, sphere:RADIUS_M or ellipsoid:EQUATORIAL_M,POLAR_M");
}

double body_radius_m(const std::vector<Source>& sources) {
  for (const Source& source : sources) {
    for (const mars::SourceInfo& info : source->infos()) {
      if (info.body_radius_m > 0) return info.body_radius_m;
    }
  }
  return mars::kMarsRadius_m;
}

void choose_body(const SourceArguments& arguments, const std::vector<Source>& sources,
                 paging::BuildOptions& options) {
  const mars::Body* body = nullptr;
  if (!arguments.body.empty()) {
    body = mars::find_body(std::string_view(arguments.body));
    if (body == nullptr && arguments.radius_m <= 0) {
      throw UsageError("--body " + arguments.body + ": its radius is not known here; give --radius too");
    }
  } else {
    body = mars::find_body(arguments.radius_m > 0 ? arguments.radius_m : body_radius_m(sources));
  }
  options.body = !arguments.body.empty() ? arguments.body
                 : body != nullptr       ? std::string(body->name)
                                         : "unnamed";
  options.radius_m = arguments.radius_m > 0 ? arguments.radius_m
                     : body != nullptr      ? body->radius_m
                                            : body_radius_m(sources);
}

bool is_named(const std::string& path, const std::string& name) {
  return path == name || std::filesystem::path(path).filename().string() == name;
}

// Gives sources the datum that --datum names: those that are called so, or all that do not say their own.
void name_datums(const SourceArguments& arguments, std::vector<Source>& sources) {
  std::vector<bool> named(sources.size(), false);
  for (const std::string& text : arguments.datums) {
    const std::size_t equals = text.rfind('=');
    const std::string name = equals == std::string::npos ? std::string() : text.substr(0, equals);
    const std::string words = equals == std::string::npos ? text : text.substr(equals + 1);
    bool found = false;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const mars::SourceInfo info = sources[i]->infos().front();
      if (name.empty() ? info.datum.is_known() || named[i] : !is_named(info.name, name)) continue;
      found = true;
      named[i] = true;
      const double sphere_m = info.body_radius_m > 0 ? info.body_radius_m : mars::kMarsRadius_m;
      const mars::VerticalDatum datum = checked_datum("--datum", words, sphere_m);
      if (datum == info.datum) continue;
      std::string treatment = "datum named as " + to_string(datum);
      if (info.datum.is_known())
        treatment += " against the product's own words (" + to_string(info.datum) + ")";
      const mars::Adjust nothing = [](std::span<const glm::dvec3>, std::span<double>) {};
      sources[i] = mars::adjusted(sources[i], nothing, datum, treatment);
    }
    if (!found && !name.empty()) throw UsageError("--datum " + text + ": no raster is called '" + name + "'");
  }
}

std::string number(double value, const char* format = "%.4g") {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

// Where the ground of an inset rises against its base: size in metres a kilometre, and towards where.
std::string tilt_words(const mars::VerticalAlignment& level) {
  const double tilt = std::hypot(level.tilt_east, level.tilt_north);
  double azimuth = std::atan2(level.tilt_east, level.tilt_north) / mars::kRadiansPerDegree;
  if (azimuth < 0) azimuth += 360;
  return number(1000 * tilt) + " m/km rising towards " + number(azimuth, "%.0f") + " degrees";
}

}  // namespace

void add_source_options(CLI::App& command, SourceArguments& a) {
  command
      .add_option(
          "--datum", a.datums,
          "[NAME=]DATUM of rasters that do not say their own (or of NAME alone): areoid, radius, sphere, "
          "sphere:RADIUS_M, ellipsoid:EQUATORIAL_M,POLAR_M (repeatable)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_flag("--convert{base}", a.convert,
                   "Bring all rasters to one datum, that of the coarsest; --convert=DATUM names another");
  command.add_option("--areoid", a.areoid, "Raster of the areoid's radii (as MOLA's MEGA), to convert through");
  command
      .add_option("--shape", a.shape,
                  "sphere: heights stand on the sphere, whatever their datum; radius: true radii")
      ->check(CLI::IsMember({"sphere", "radius"}))
      ->capture_default_str();
  command
      .add_option(
          "--level", a.level,
          "fit: take offset and tilt out of every inset, by its rim; bend: bend what lies below around every "
          "inset, so that it meets it and the inset keeps its heights")
      ->check(CLI::IsMember({"none", "fit", "bend"}))
      ->capture_default_str();
  command
      .add_option(
          "--feather", a.feather_m,
          "Width over which insets fade into what lies below, metres (default: 16 of their posts, at least 2 "
          "of what lies below)")
      ->check(number_within(0.001, 1e7));
  command.add_flag("--mask-blunders", a.reject_outliers,
                   "Drop posts that what lies below shows to be impossible");
  command
      .add_option("--blunder", a.blunder_m,
                  "Difference to what lies below that is always taken as terrain, metres")
      ->check(number_within(0.001, 1e6))
      ->capture_default_str();
  command.add_option("--body", a.body, "Name of the body (default: as the rasters say)");
  command.add_option("--radius", a.radius_m, "Radius of the sphere, metres (default: the body's)")
      ->check(number_within(100.0, 1e9));
}

mars::Combined combine_sources(std::vector<Source> sources, const SourceArguments& arguments,
                               paging::BuildOptions& options) {
  choose_body(arguments, sources, options);
  name_datums(arguments, sources);
  mars::CombineOptions combine;
  combine.radius_m = options.radius_m;
  combine.true_radii = arguments.shape == "radius";
  combine.convert = !arguments.convert.empty();
  if (combine.convert && arguments.convert != "base") {
    combine.datum = checked_datum("--convert", arguments.convert, options.radius_m);
  }
  if (!arguments.areoid.empty()) {
    std::vector<Source> areoid{mars::open_elevation(arguments.areoid)};
    if (!areoid[0]->infos().front().datum.is_known()) name_datums(arguments, areoid);
    combine.areoid = areoid[0];
  }
  using VerticalAlignment = mars::CombineOptions::VerticalAlignment;
  combine.level = arguments.level == "fit"    ? VerticalAlignment::kPlane
                  : arguments.level == "bend" ? VerticalAlignment::kEdges
                                              : VerticalAlignment::kNone;
  combine.reject_outliers = arguments.reject_outliers;
  combine.outliers.floor_m = arguments.blunder_m;
  combine.stack.feather_m = arguments.feather_m;
  mars::Combined combined = mars::combine_elevation(std::move(sources), combine);
  options.true_radii = combined.true_radii;
  return combined;
}

void say_findings(const mars::Combined& combined) {
  for (const std::string& checkpoint : combined.notes)
    std::fprintf(stderr, "vpe: note: %s\n", checkpoint.c_str());
  for (const mars::CombineFinding& f : combined.findings) {
    if (f.level) {
      std::fprintf(
          stderr,
          "vpe: %s lies %s m above what is below it, with a tilt of %s (%lld posts of its rim); taken out: RMS "
          "there was %s m, is %s m\n",
          f.name.c_str(), number(f.level->offset_m).c_str(), tilt_words(*f.level).c_str(),
          static_cast<long long>(f.level->posts), number(f.level->rms_before_m).c_str(),
          number(f.level->rms_after_m).c_str());
    }
    if (f.bend) {
      std::fprintf(stderr, "vpe: what lies below %s is bent to meet it, by %s m RMS at its rim, over %s km\n",
                   f.name.c_str(), number(f.bend->rms_m).c_str(), number(1e-3 * f.bend->reach_m).c_str());
    }
    if (f.outliers && f.outliers->implausible > 0) {
      std::fprintf(
          stderr, "vpe: %s: %.2g %% of its posts cannot be right, by up to %s m at %s,%s; %s\n", f.name.c_str(),
          100.0 * static_cast<double>(f.outliers->implausible) / static_cast<double>(f.outliers->posts),
          number(f.outliers->worst_m).c_str(), base::format_number(f.outliers->worst_at.lon_deg).c_str(),
          base::format_number(f.outliers->worst_at.lat_deg).c_str(),
          f.masked ? "dropped" : "--mask-blunders drops them");
    }
  }
}

nlohmann::json findings_json(const mars::Combined& combined) {
  using nlohmann::json;
  json list = json::array();
  for (const mars::CombineFinding& f : combined.findings) {
    json entry{{"name", f.name}, {"level", nullptr}, {"bend", nullptr}, {"implausible", nullptr}};
    if (f.level) {
      entry["level"] = {{"lon_deg", f.level->centre.lon_deg},     {"lat_deg", f.level->centre.lat_deg},
                        {"offset_m", f.level->offset_m},          {"tilt_east", f.level->tilt_east},
                        {"tilt_north", f.level->tilt_north},      {"rms_before_m", f.level->rms_before_m},
                        {"rms_after_m", f.level->rms_after_m},    {"rim_posts", f.level->posts},
                        {"rim_posts_left_out", f.level->left_out}};
    }
    if (f.bend) {
      entry["bend"] = {{"rms_m", f.bend->rms_m},
                       {"largest_m", f.bend->largest_m},
                       {"reach_m", f.bend->reach_m},
                       {"rim_posts", f.bend->posts}};
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
