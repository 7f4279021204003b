#include "vpe/app/film/film_frame.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "vpe/base/json_integer.h"

namespace vpe::app {

namespace {

using nlohmann::json;

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

template <class Figures, class Field>
void visit(Figures& f, const Field& field) {
  field("tiles_visited", f.stats.tiles_visited);
  field("tiles_culled_frustum", f.stats.tiles_culled_frustum);
  field("tiles_culled_horizon", f.stats.tiles_culled_horizon);
  field("tiles_culled_occlusion", f.stats.tiles_culled_occlusion);
  field("tiles_drawn", f.stats.tiles_drawn);
  field("tiles_missing", f.stats.tiles_missing);
  field("triangles", f.stats.triangles);
  field("skirt_triangles", f.stats.skirt_triangles);
  field("tiles_by_level", f.stats.tiles_by_level);
  field("tile_error_m", f.certificate.geometric_error_m);
  field("tile_error_px", f.certificate.screen_space_error_px);
  field("shift_bound_px", f.certificate.shift_bound_px);
  field("tiles_substituted", f.certificate.tiles_substituted);
}

// Of frames with carried pixels only.
template <class Carried, class Field>
void visit_carried(Carried& carried, const Field& field) {
  field("carrying_px", carried.added_px);
  field("carried_share", carried.carried_share);
  field("between_share", carried.between_share);
  field("drawn_share", carried.drawn_share);
}

void read(const json& value, double& to) { to = value.is_null() ? kNotKnown : value.get<double>(); }
void read(const json& value, int& to) { to = base::json_integer<int>(value); }
void read(const json& value, std::int64_t& to) { to = base::json_integer<std::int64_t>(value); }
void read(const json& value, std::vector<int>& to) {
  to.clear();
  for (const json& one : value) to.push_back(base::json_integer<int>(one));
}

}  // namespace

json to_json(const FrameFigures& figures) {
  json out = json::object();
  visit(figures, [&](const char* name, const auto& value) { out[name] = value; });
  if (const auto& carried = figures.certificate.carried)
    visit_carried(*carried, [&](const char* name, double value) { out[name] = value; });
  return out;
}

std::optional<FrameFigures> figures_from(const json& from) {
  FrameFigures figures;
  try {
    visit(figures, [&](const char* name, auto& value) { read(from.at(name), value); });
    if (from.contains("carrying_px"))
      visit_carried(figures.certificate.carried.emplace(),
                    [&](const char* name, double& value) { read(from.at(name), value); });
  } catch (const json::exception&) {
    return std::nullopt;
  }
  core::FrameStats& s = figures.stats;
  s.select_ms = s.occlude_ms = s.load_ms = s.draw_ms = s.read_ms = kNotKnown;
  s.bytes_resident = s.pages_wanted = s.pages_loading = s.pages_uploaded = s.pages_evicted = -1;
  return figures;
}

FilmCount count(std::span<const FilmFrame> frames) {
  FilmCount n;
  n.all = static_cast<std::int64_t>(frames.size());
  for (const FilmFrame& f : frames) {
    n.made += f.state == FilmFrame::State::kMade ? 1 : 0;
    n.kept += f.state == FilmFrame::State::kKept ? 1 : 0;
    n.failed += f.state == FilmFrame::State::kFailed ? 1 : 0;
  }
  return n;
}

}  // namespace vpe::app
