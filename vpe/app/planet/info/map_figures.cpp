#include <algorithm>
#include <array>
#include <cmath>

#include "vpe/app/planet/info/map_readout.h"
#include "vpe/app/planet/info/polar_map.h"
#include "vpe/app/planet/info/relief_map.h"
#include "vpe/base/nice_ticks.h"
#include "vpe/base/number.h"
#include "vpe/core/image/image.h"
#include "vpe/report/plots/svg.h"

namespace vpe::app {

namespace {

using base::format_fixed;

// The colours of Okabe and Ito, as in vpe/report/plots/plot.cpp.
constexpr std::array<base::Rgb, 7> kSourceColours{{{0, 114, 178},
                                                   {213, 94, 0},
                                                   {0, 158, 115},
                                                   {204, 121, 167},
                                                   {230, 159, 0},
                                                   {86, 180, 233},
                                                   {240, 228, 66}}};
constexpr base::Rgb kNodataColour{120, 120, 120};
constexpr base::Rgb kUnknownColour{60, 60, 60};
constexpr double kNearlyAll = 0.5;  // a source of a larger share has no number on the map

base::Rgb colour_of(std::int16_t source) {
  if (source == kNoSource) return kNodataColour;
  if (source == kUnknownSource) return kUnknownColour;
  return kSourceColours[static_cast<std::size_t>(source) % kSourceColours.size()];
}

std::string css(const base::Rgb& c) {
  return "rgb(" + std::to_string(c.r) + "," + std::to_string(c.g) + "," + std::to_string(c.b) + ")";
}

std::string share_text(double share) { return base::format_significant(100 * share, 3) + " %"; }

std::string letters(double x, double y, const char* style, const char* anchor, const std::string& text) {
  return "<text class=\"" + std::string(style) + "\" x=\"" + format_fixed(x, 2) + "\" y=\"" +
         format_fixed(y, 2) + "\" text-anchor=\"" + anchor + "\">" + report::escape_markup(text) + "</text>";
}

// Lines every 30 degrees. The drawing's unit is a degree.
std::string graticule() {
  std::string path;
  std::string texts;
  for (int lon = -150; lon <= 150; lon += 30) {
    path += "M" + std::to_string(lon + 180) + " 0V180";
    texts += letters(lon + 180, 178, lon % 90 == 0 ? "m" : "m fine", "middle",
                     std::to_string(std::abs(lon)) + "\u00b0" +
                         (lon == 0  ? ""
                          : lon > 0 ? " E"
                                    : " W"));
  }
  for (int lat = -60; lat <= 60; lat += 30) {
    path += "M0 " + std::to_string(90 - lat) + "H360";
    texts += letters(1, 89 - lat, lat % 60 == 0 ? "m" : "m fine", "start",
                     std::to_string(std::abs(lat)) + "\u00b0" +
                         (lat == 0  ? ""
                          : lat > 0 ? " N"
                                    : " S"));
  }
  return "<path class=\"g\" d=\"" + path + "\"/>" + texts;
}

// Outlines the ground of one source along the borders of the map's pixels, in degrees. Equal neighbouring pieces are joined.
std::string outline(const SourceMap& map, std::int16_t source) {
  const auto is_in = [&](int x, int y) {
    const int column = (x + map.width) % map.width;
    return map.source[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
                      static_cast<std::size_t>(column)] == source;
  };
  const double degree = 360.0 / map.width;
  const auto at = [&](int n) { return base::format_rounded(n * degree, 2); };
  std::string path;
  for (int x = 0; x < map.width; ++x) {
    for (int y = 0, begin = 0; y <= map.height; ++y) {
      const bool is_edge = y < map.height && is_in(x, y) != is_in(x - 1, y);
      if (is_edge) continue;
      if (y > begin) path += "M" + at(x) + " " + at(begin) + "V" + at(y);
      begin = y + 1;
    }
  }
  for (int y = 1; y < map.height; ++y) {
    for (int x = 0, begin = 0; x <= map.width; ++x) {
      const bool is_edge = x < map.width && is_in(x, y) != is_in(x, y - 1);
      if (is_edge) continue;
      if (x > begin) path += "M" + at(begin) + " " + at(y) + "H" + at(x);
      begin = x + 1;
    }
  }
  return path;
}

std::string source_numbers(const SourceCoverage& coverage) {
  std::string out;
  for (std::size_t n = 0; n < coverage.sources.size(); ++n) {
    const CoveredArea& area = coverage.sources[n];
    if (!(area.share > 0) || area.share > kNearlyAll) continue;
    const double x = area.middle.lon_deg + 180;
    const double y = 90 - area.middle.lat_deg;
    out += "<circle class=\"s\" cx=\"" + format_fixed(x, 2) + "\" cy=\"" + format_fixed(y, 2) +
           "\" r=\"0.8\"/>" +
           letters(std::clamp(x + 1.5, 0.0, 352.0), std::clamp(y - 1.5, 6.0, 178.0), "n", "start",
                   std::to_string(n + 1));
  }
  return out;
}

std::string map_markup(const std::string& alt, const std::vector<std::uint8_t>& png, const std::string& over) {
  return "<div class=\"map\" data-map=\"plain\"><img alt=\"" + report::escape_markup(alt) + "\" src=\"" +
         report::data_uri(png) + "\"/><svg viewBox=\"0 0 360 180\" aria-hidden=\"true\">" + over +
         "</svg></div>";
}

// The drawing's unit is a hundredth of the distance from the pole to the edge.
std::string inset_markup(Pole pole, const std::vector<std::uint8_t>& png, const SourceCoverage& coverage) {
  const bool is_north = pole == Pole::kNorth;
  std::string path;
  std::string texts;
  for (int lat = 60; lat < 90; lat += 10) {
    const double r = 100 * polar_point(pole, {90, static_cast<double>(is_north ? lat : -lat)}).x;
    const std::string radius = format_fixed(r, 2);
    path += "M-" + radius + " 0a" + radius + " " + radius + " 0 1 0 " + format_fixed(2 * r, 2) + " 0a" +
            radius + " " + radius + " 0 1 0 -" + format_fixed(2 * r, 2) + " 0";
    texts += letters(1, -r + 4, "m", "start", std::to_string(lat) + "\u00b0 " + (is_north ? "N" : "S"));
  }
  for (int lon = 0; lon < 360; lon += 30) {
    const double sine = std::sin(lon * mars::kRadiansPerDegree);
    const double down = (is_north ? 1 : -1) * std::cos(lon * mars::kRadiansPerDegree);
    path += "M" + format_fixed(100 * sine, 2) + " " + format_fixed(100 * down, 2) + "L" +
            format_fixed(20 * sine, 2) + " " + format_fixed(20 * down, 2);
    if (lon % 90 == 0)
      texts += letters(92 * sine, 92 * down + 2, "m", "middle",
                       std::to_string(lon > 180 ? 360 - lon : lon) + "\u00b0" +
                           (lon % 180 == 0 ? ""
                            : lon < 180    ? " E"
                                           : " W"));
  }
  for (std::size_t n = 0; n < coverage.sources.size(); ++n) {
    const CoveredArea& area = coverage.sources[n];
    if (!(area.share > 0) || area.share > kNearlyAll) continue;
    const glm::dvec2 at = polar_point(pole, area.middle);
    if (std::hypot(at.x, at.y) > 0.97) continue;
    texts += "<circle class=\"s\" cx=\"" + format_fixed(100 * at.x, 2) + "\" cy=\"" +
             format_fixed(100 * at.y, 2) + "\" r=\"1.4\"/>" +
             letters(100 * at.x + 2.5, 100 * at.y - 2.5, "n", "start", std::to_string(n + 1));
  }
  const std::string name = is_north ? "north" : "south";
  return "<div class=\"map pole\" data-map=\"" + name + "\"><img alt=\"Shaded relief map around the " + name +
         " pole\" src=\"" + report::data_uri(png) +
         "\"/><svg viewBox=\"-100 -100 200 200\" aria-hidden=\"true\"><path class=\"g\" d=\"" + path + "\"/>" +
         texts + "</svg></div>";
}

std::string elevation_legend(const ReliefLook& look) {
  core::Appearance appearance;
  appearance.palette_low = look.low_m;
  appearance.palette_high = look.high_m;
  const core::ColourScale scale(appearance);
  constexpr int kSteps = 24;
  constexpr double kLegendWidth = 400;
  std::string stops;
  for (int n = 0; n <= kSteps; ++n) {
    const double share = static_cast<double>(n) / kSteps;
    const glm::dvec3 c = scale(look.low_m + share * (look.high_m - look.low_m));
    stops +=
        "<stop offset=\"" + format_fixed(share, 4) + "\" stop-color=\"" +
        css({static_cast<std::uint8_t>(c.x), static_cast<std::uint8_t>(c.y), static_cast<std::uint8_t>(c.z)}) +
        "\"/>";
  }
  std::string svg =
      "<svg class=\"legend\" viewBox=\"0 0 460 44\" width=\"460\" height=\"44\" role=\"img\"><title>Elevations of the "
      "map, from " +
      base::format_number(look.low_m) + " m to " + base::format_number(look.high_m) +
      " m</title><defs><linearGradient id=\"heights\">" + stops +
      "</linearGradient></defs><rect x=\"20\" y=\"2\" width=\"400\" height=\"14\" fill=\"#888\"/><rect x=\"20\" y=\"2\" "
      "width=\"400\" height=\"14\" style=\"fill:url(#heights)\"/>";
  for (const double tick : base::nice_ticks(look.low_m, look.high_m, 9).values) {
    const double x = 20 + kLegendWidth * (tick - look.low_m) / (look.high_m - look.low_m);
    svg += "<path stroke=\"currentColor\" d=\"M" + format_fixed(x, 2) + " 16v5\"/>" +
           letters(x, 36, "t", "middle", base::format_rounded(tick, 6));
  }
  return svg + letters(426, 14, "t", "start", "m") + "</svg>";
}

}  // namespace

report::Figure relief_figure(const std::vector<std::uint8_t>& png, const ReliefLook& look,
                             const SourceCoverage& coverage) {
  std::string over = graticule();
  bool has_outlines = false;
  for (std::size_t n = 0; n < coverage.sources.size(); ++n) {
    const std::string path = outline(coverage.map, static_cast<std::int16_t>(n));
    if (path.empty()) continue;
    has_outlines = true;
    over += "<path class=\"u\" d=\"" + path + "\"/><path class=\"o\" d=\"" + path + "\"/>";
  }
  const std::string numbers = source_numbers(coverage);
  std::string caption =
      "The whole planet, linear in longitude and latitude (planetocentric). Light comes from the north-west, 45 degrees "
      "up";
  caption += look.exaggeration == 1
                 ? "."
                 : ", on relief exaggerated " + base::format_number(look.exaggeration) + " times.";
  if (has_outlines) caption += " White lines bound the ground of each source.";
  if (!numbers.empty()) caption += " Numbers are those of the table of sources.";
  if (coverage.nodata_share > 0) caption += " Grey stripes: no source has data.";
  caption +=
      " Where scripts run, a pointer over a map reads places and elevations, interpolated between points " +
      base::format_number(kReadoutStep_deg) + " degrees apart.";
  const std::string alt = "Shaded relief map of the whole planet, coloured by elevation from " +
                          base::format_number(look.low_m) + " m to " + base::format_number(look.high_m) + " m";
  return {map_markup(alt, png, over + numbers) + elevation_legend(look), caption};
}

report::Figure polar_figure(const ReliefImages& images, const SourceCoverage& coverage) {
  const std::string edge = base::format_number(kPolarLat_deg);
  return {
      "<div class=\"poles\">" + inset_markup(Pole::kNorth, images.north, coverage) +
          inset_markup(Pole::kSouth, images.south, coverage) + "</div>",
      "The poles, to " + edge +
          " degrees of latitude, as seen from above each: stereographic, in the colours of the map of "
          "the whole planet. Longitude 0 is below the north pole and above the south pole. Light comes from the upper left."};
}

report::Figure coverage_figure(const SourceCoverage& coverage, const std::vector<std::string>& names) {
  core::RgbImage image{coverage.map.width, coverage.map.height, {}};
  for (const std::int16_t source : coverage.map.source) image.pixels.push_back(colour_of(source));
  std::string list = "<ul class=\"key\">";
  const auto add = [&](std::int16_t source, const std::string& name, double share) {
    list +=
        "<li><svg width=\"14\" height=\"14\" aria-hidden=\"true\"><rect width=\"14\" height=\"14\" fill=\"" +
        css(colour_of(source)) + "\"/></svg> " + report::escape_markup(name + ": " + share_text(share)) +
        "</li>";
  };
  for (std::size_t n = 0; n < names.size(); ++n)
    add(static_cast<std::int16_t>(n), std::to_string(n + 1) + "  " + names[n], coverage.sources[n].share);
  if (coverage.nodata_share > 0) add(kNoSource, "no data", coverage.nodata_share);
  if (coverage.unknown_share > 0)
    add(kUnknownSource, "one of several sources, the file does not tell which", coverage.unknown_share);
  const std::vector<std::uint8_t> png = core::encode_png(image.pixels, image.width, image.height, 9);
  return {map_markup("Map of the sources that decide the elevations; the list below it has their shares", png,
                     graticule() + source_numbers(coverage)) +
              list + "</ul>",
          "The source that decides the elevation at each place. Shares are those of the planet's area."};
}

std::string map_style() {
  return R"(
.map { position: relative; width: min(72rem, 100%); }
.map img { width: 100%; }
.map > svg { position: absolute; inset: 0; width: 100%; height: 100%; overflow: hidden; }
.poles { display: flex; flex-wrap: wrap; gap: 1rem; width: min(72rem, 100%); }
.map.pole { flex: 1 1 16rem; max-width: 30rem; }
.map.pole img { display: block; border-radius: 50%; }
.map path { fill: none; vector-effect: non-scaling-stroke; }
.map .g { stroke: #000; stroke-opacity: .3; }
.map .u { stroke: #000; stroke-width: 2.6; stroke-opacity: .7; }
.map .o { stroke: #fff; stroke-width: 1.2; }
.map .s { fill: #fff; stroke: #000; stroke-width: .3; }
.map text { font-size: 3.6px; fill: #fff; stroke: #000; stroke-width: .8px; paint-order: stroke; }
.map .n { font-size: 4.6px; font-weight: 600; }
.map.pole text { font-size: 5px; }
.map.pole .n { font-size: 6.5px; }
@media (max-width: 40rem) {
  .map text, .map .n { font-size: 9px; stroke-width: 2px; }
  .map.pole text, .map.pole .n { font-size: 8px; stroke-width: 1.4px; }
  .map .fine { display: none; }
}
svg.legend { display: block; max-width: 100%; height: auto; margin-top: .4rem; }
ul.key { list-style: none; padding: 0; margin: .5rem 0; font-size: 13px; columns: 20rem; overflow-wrap: anywhere; }
ul.key svg { vertical-align: -2px; }
figure:has(.map) { display: block; margin-right: 0; }
)";
}

}  // namespace vpe::app
