#include "panorama/page/page_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "panorama/page/page_texts.h"
#include "panorama/viewer/viewer.h"
#include "vpe/base/number.h"
#include "vpe/core/json_text.h"

namespace panorama {

namespace {

using PageJson = nlohmann::ordered_json;
using vpe::base::format_display;

const std::array<ViewerFile, 16>& files_of_viewer() {
  static const std::array<ViewerFile, 16> kFiles{{{"style.css", page_text::kStyle},
                                                  {"projection.js", page_text::kProjection},
                                                  {"view.js", page_text::kView},
                                                  {"pyramid.js", page_text::kPyramid},
                                                  {"pace.js", page_text::kPace},
                                                  {"flat_view.js", page_text::kFlatView},
                                                  {"planes.js", page_text::kPlanes},
                                                  {"text.js", page_text::kText},
                                                  {"loader.js", page_text::kLoader},
                                                  {"webgl.js", page_text::kWebgl},
                                                  {"flat_renderer.js", page_text::kFlatRenderer},
                                                  {"marks.js", page_text::kMarks},
                                                  {"input.js", page_text::kInput},
                                                  {"panel.js", page_text::kPanel},
                                                  {"page.js", page_text::kPage},
                                                  {"main.js", page_text::kMain}}};
  return kFiles;
}

// Replaces every {{key}} of a text.
std::string fill(std::string_view text, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string out;
  for (;;) {
    const std::size_t begin = text.find("{{");
    const std::size_t end = text.find("}}", begin);
    out += text.substr(0, begin);
    if (begin == std::string_view::npos || end == std::string_view::npos) return out;
    const std::string_view key = text.substr(begin + 2, end - begin - 2);
    const auto value =
        std::find_if(values.begin(), values.end(), [&](const auto& pair) { return pair.first == key; });
    if (value != values.end()) out += value->second;
    text.remove_prefix(end + 2);
  }
}

PageJson map_json(const PanoramaMap& map) {
  return {{"kind", to_string(map.kind)},
          {"width_px", map.width_px},
          {"height_px", map.height_px},
          {"turn_px", map.turn_px},
          {"turn_azimuth_deg", map.turn_azimuth_deg},
          {"crop_left_px", map.crop_left_px},
          {"horizon_px", map.horizon_px},
          {"focal_px", map.focal_px},
          {"facets", map.facets}};
}

PageJson mark_json(const PageName& name) {
  PageJson mark{{"text", name.text},
                {"azimuth_deg", name.direction.azimuth_deg},
                {"elevation_deg", name.direction.elevation_deg}};
  if (name.range_m) mark["range_m"] = *name.range_m;
  return mark;
}

// Returns a sentence about the panorama, for those who do not see it.
std::string about(const PageFacts& facts) {
  const PanoramaMap& map = facts.description.map;
  const ElevationRange seen = elevations_of(map);
  const double span_deg = std::min(map.azimuth_span_deg(), 360.0);
  std::string text = "Panorama of " + std::to_string(map.width_px) + " by " + std::to_string(map.height_px) +
                     " pixels: " + format_display(span_deg, span_deg < 360.0 ? 1 : 0) +
                     " degrees of azimuth, elevations from " + format_display(seen.low_deg, 1) + " to " +
                     format_display(seen.high_deg, 1) + " degrees";
  if (const auto& viewpoint = facts.description.viewpoint) {
    text += ", seen from longitude " + format_display(viewpoint->lon_deg, 4) + " degrees east, latitude " +
            format_display(viewpoint->lat_deg, 4) + " degrees";
  }
  return text + ".";
}

// Returns how exact the values are that the page reads out.
std::string accuracy(const PageFacts& facts) {
  if (!facts.layers) return "This panorama has no auxiliary layers, so ranges and places are not known.";
  std::string text = "Values are those of ";
  text += facts.layers->step == 1
              ? "each pixel"
              : "every " + std::to_string(facts.layers->step) + "th column and row of the picture";
  std::string steps;
  for (const PageBand& band : facts.layers->bands) {
    if (!(band.step > 0.0)) continue;
    steps += (steps.empty() ? " within " : ", ") + band.name + " ";
    steps += band.is_log ? vpe::base::format_significant(50.0 * band.step, 2) + " %"
                         : vpe::base::format_significant(0.5 * band.step, 2);
  }
  return text + steps + " of the auxiliary layers.";
}

}  // namespace

std::span<const ViewerFile> viewer_files() { return files_of_viewer(); }

std::string html_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string script_json(std::string_view json) {
  std::string out;
  for (std::size_t n = 0; n < json.size(); ++n) {
    if (json[n] == '<') {
      out += "\\u003c";
    } else if (json.substr(n, 3) == "\xE2\x80\xA8" || json.substr(n, 3) == "\xE2\x80\xA9") {
      out += json[n + 2] == '\xA8' ? "\\u2028" : "\\u2029";
      n += 2;
    } else {
      out += json[n];
    }
  }
  return out;
}

std::string index_html(const PageFacts& facts) {
  std::string scripts;
  const auto add = [&](const std::string& name) { scripts += "<script src=\"" + name + "\"></script>\n"; };
  const std::span<const ViewerFile> files = viewer_files();
  for (const ViewerFile& file : files.subspan(1, files.size() - 2))
    add(std::string(kViewerFolder) + "/" + std::string(file.name));
  add("data.js");
  // The coarsest tiles are shown at once.
  const std::string last = std::to_string(facts.pyramid.levels - 1) + "/0_0.js";
  add("tiles/left/" + last);
  if (facts.has_right_eye) add("tiles/right/" + last);
  add(std::string(kViewerFolder) + "/" + std::string(files.back().name));
  // Names of files may hold bytes that are no UTF-8.
  const std::string title = vpe::core::text_in_json(facts.title);
  return fill(page_text::kTemplate,
              {{"title", html_text(title)},
               {"about", html_text(about(facts))},
               {"generator", "vpe"},
               {"azimuths", facts.description.heading_is_known
                                ? "north"
                                : "the middle of the picture, which does not say where north is"},
               {"accuracy", html_text(accuracy(facts))},
               {"scripts", scripts}});
}

std::string data_script(const PageFacts& facts) {
  PageJson json{{"format", 1},
                {"title", facts.title},
                {"has_north", facts.description.heading_is_known},
                {"map", map_json(facts.description.map)},
                {"pyramid",
                 {{"width_px", facts.pyramid.width_px},
                  {"height_px", facts.pyramid.height_px},
                  {"tile_px", kPageTile_px},
                  {"levels", facts.pyramid.levels}}},
                {"eyes", facts.has_right_eye ? PageJson{"left", "right"} : PageJson::array({"left"})},
                {"layers", nullptr},
                {"names", PageJson::array()},
                {"hotspots", PageJson::array()},
                {"picture", facts.picture}};
  if (facts.layers) {
    PageJson bands = PageJson::array();
    for (const PageBand& band : facts.layers->bands)
      bands.push_back({{"name", band.name}, {"step", band.step}, {"log", band.is_log}});
    json["layers"] = {{"step", facts.layers->step},
                      {"tile_px", kLayerTile_px},
                      {"width", facts.layers->width_px},
                      {"height", facts.layers->height_px},
                      {"bands", bands}};
  }
  for (const PageName& name : facts.marks.names) json["names"].push_back(mark_json(name));
  for (const PageHotspot& hotspot : facts.marks.hotspots) {
    PageJson mark = mark_json(hotspot.name);
    mark["page"] = hotspot.page;
    json["hotspots"].push_back(mark);
  }
  return std::string(kPageMark) + "\nglobalThis.vpeData = " + script_json(vpe::core::json_text(json)) + ";\n";
}

}  // namespace panorama
