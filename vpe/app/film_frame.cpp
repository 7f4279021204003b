#include "vpe/app/film_frame.h"

#include <array>
#include <limits>
#include <utility>

#include "vpe/app/film_digest.h"
#include "vpe/core/palette.h"

namespace vpe::app {

namespace {

using nlohmann::json;

// Raised whenever the encoding below changes its meaning.
constexpr std::int64_t kEncoding = 3;

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

void add(Digest& digest, const glm::dvec3& v) { digest.add(v.x).add(v.y).add(v.z); }

// What a palette's file holds: its name stays when it is edited.
void add(Digest& digest, const core::Palette& palette) {
  digest.add(static_cast<std::int64_t>(palette.scale()));
  for (const core::PaletteStop& stop : palette.stops()) add(digest.add(stop.at), stop.rgb);
}

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
  field("tile_error_m", f.certificate.tile_error_m);
  field("tile_error_px", f.certificate.tile_error_px);
  field("shift_bound_px", f.certificate.shift_bound_px);
  field("tiles_substituted", f.certificate.tiles_substituted);
}

void read(const json& value, double& to) { to = value.is_null() ? kNotKnown : value.get<double>(); }
template <class T>
void read(const json& value, T& to) {
  to = value.get<T>();
}

}  // namespace

std::string fingerprint_of(const FilmBasis& basis, const core::DrawRequest& request,
                           const core::Settings& settings, double time_s) {
  const core::View& view = request.view;
  Digest digest;
  digest.add(kEncoding).add(basis.program).add(basis.planet).add(basis.backend);
  digest.add(std::int64_t{basis.memory_mb});
  digest.add(static_cast<std::int64_t>(view.projection)).add(view.fov_deg);
  digest.add(std::int64_t{view.width}).add(std::int64_t{view.height});
  digest.add(view.principal_offset_px.x).add(view.principal_offset_px.y);
  for (const int n : {view.part.x, view.part.y, view.part.width, view.part.height}) digest.add(std::int64_t{n});
  add(digest, view.eye.eye_m);
  add(digest, view.eye.axes.right);
  add(digest, view.eye.axes.up);
  add(digest, view.eye.axes.forward);
  add(digest, request.sun);
  digest.add(static_cast<std::int64_t>(request.interest.size()));
  for (const core::InterestRegion& r : request.interest) {
    digest.add(r.lon_deg).add(r.lat_deg).add(r.radius_m).add(std::int64_t{r.levels});
  }
  digest.add(request.coarsening);
  // The registry's own text of a value gives back its bits.
  for (const core::SettingInfo& info : core::Settings::list()) {
    digest.add(info.key).add(settings.get(info.key).value_or(""));
  }
  if (const auto file = core::palette_file(settings.values().palette)) add(digest, core::read_palette(*file));
  const core::SettingsValues& values = settings.values();
  if (values.time_code) digest.add("time").add(time_s);
  if (!values.names.empty()) digest.add("names").add(checksum_of(std::filesystem::path(values.names)));
  return digest.hex();
}

json to_json(const FrameFigures& figures) {
  json out = json::object();
  visit(figures, [&](const char* name, const auto& value) { out[name] = value; });
  return out;
}

std::optional<FrameFigures> figures_from(const json& from) {
  FrameFigures figures;
  try {
    visit(figures, [&](const char* name, auto& value) { read(from.at(name), value); });
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
