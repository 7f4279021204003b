#include "vpe/app/planet/latitude_option.h"

#include <cstdio>
#include <string_view>

#include "mars/geodesy/datum.h"
#include "vpe/app/cli/program.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr std::string_view kPlanetocentric = "planetocentric";
constexpr std::string_view kPlanetographic = "planetographic";

bool is_flattened(const mars::Spheroid& spheroid) { return spheroid.polar_m < spheroid.equatorial_m; }

std::optional<mars::Spheroid> spheroid_of(const paging::PlanetMeta& meta) {
  if (meta.datum.kind == mars::DatumKind::kEllipsoid)
    return mars::Spheroid{meta.datum.equatorial_m, meta.datum.polar_m};
  return mars::reference_spheroid(meta.body);
}

// Returns the ellipsoid of "planetographic:EQUATORIAL_M,POLAR_M", nullopt for other texts.
std::optional<mars::Spheroid> named_spheroid(const std::string& option) {
  if (!option.starts_with(std::string(kPlanetographic) + ":")) return std::nullopt;
  const auto datum = mars::parse_datum("ellipsoid" + option.substr(kPlanetographic.size()), 0);
  if (!datum) return std::nullopt;
  return mars::Spheroid{datum->equatorial_m, datum->polar_m};
}

// Notes that a latitude of the other kind lies elsewhere.
void note_latitudes(const paging::PlanetMeta& meta) {
  const bool is_likely = meta.datum.kind == mars::DatumKind::kEllipsoid || meta.body == "Earth";
  const auto spheroid = spheroid_of(meta);
  if (!is_likely || !spheroid || !is_flattened(*spheroid)) return;
  constexpr double kMiddle_deg = 45;
  const double off_km = 1e-3 * meta.radius_m * mars::kRadiansPerDegree *
                        (kMiddle_deg - mars::planetocentric_lat_deg(kMiddle_deg, *spheroid));
  std::fprintf(
      stderr,
      "vpe: note: latitudes are taken for planetocentric ones; planetographic (geodetic) ones would lie up "
      "to %s km from there (--latitude planetographic converts them)\n",
      base::format_rounded(off_km, 1).c_str());
}

}  // namespace

void add_latitude_option(CLI::App& command, std::string& text) {
  command
      .add_option("--latitude", text,
                  "Latitudes of the given places: planetocentric (default), planetographic (geodetic), or "
                  "planetographic:EQUATORIAL_M,POLAR_M; answers are planetocentric")
      ->check([](const std::string& given) {
        if (given == kPlanetocentric || given == kPlanetographic || named_spheroid(given)) return std::string();
        return "expected planetocentric, planetographic or planetographic:EQUATORIAL_M,POLAR_M, found '" +
               given + "'";
      });
}

std::optional<mars::Spheroid> spheroid_of_places(const std::string& option, const paging::PlanetMeta& meta) {
  if (option.empty() || option == kPlanetocentric) return std::nullopt;
  if (option == kPlanetographic) {
    if (const auto spheroid = spheroid_of(meta)) return spheroid;
    throw UsageError("--latitude planetographic: no ellipsoid of revolution is known for '" + meta.body +
                     "'; name its radii: --latitude planetographic:EQUATORIAL_M,POLAR_M");
  }
  return named_spheroid(option);
}

mars::LonLat planetocentric(mars::LonLat place, const std::string& option, const paging::PlanetMeta& meta,
                            bool quiet) {
  std::vector<mars::LonLat> places{place};
  make_planetocentric(places, option, meta, quiet);
  return places.front();
}

void make_planetocentric(std::vector<mars::LonLat>& places, const std::string& option,
                         const paging::PlanetMeta& meta, bool quiet) {
  const auto spheroid = spheroid_of_places(option, meta);
  if (spheroid) {
    for (mars::LonLat& place : places) place.lat_deg = mars::planetocentric_lat_deg(place.lat_deg, *spheroid);
  } else if (option.empty() && !quiet) {
    note_latitudes(meta);
  }
}

}  // namespace vpe::app
