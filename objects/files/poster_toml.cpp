#include "objects/files/poster_toml.h"

#include "objects/files/scene_limits.h"

namespace objects {

namespace {

using vpe::base::TomlTable;

mars::LonLat poster_place(const TomlTable& table) {
  return {mars::normalize_lon_deg(table.number("lon", kLonRange_deg)), table.number("lat", kLatRange_deg)};
}

// Cameras are above the ground, so that their height has no usual value.
void read_height(const TomlTable& table, bool is_camera, PosterEntry& poster) {
  if (table.has("altitude")) {
    if (table.has("height")) table.fail(table.at("altitude"), "expected altitude or height, not both");
    poster.height_kind = HeightKind::kAltitude;
    poster.height_m = table.number("altitude", kHeightRange_m);
  } else if (table.has("height") || !is_camera) {
    poster.height_m = table.number("height", kHeightRange_m, 0);
  } else {
    table.fail("expected height or altitude of the camera in [[picture]]");
  }
}

void read_rectangle(const TomlTable& table, PosterEntry& poster) {
  poster.place = poster_place(table);
  read_height(table, false, poster);
  poster.width_m = table.number("width_m", kPosterSizeRange_m);
  if (table.has("tall_m")) poster.tall_m = table.number("tall_m", kPosterSizeRange_m);
}

void read_pane(const TomlTable& table, PosterEntry& poster) {
  table.require_known({"name", "file", "form", "opacity", "lon", "lat", "height", "altitude", "width_m",
                       "tall_m", "heading", "tilt"});
  read_rectangle(table, poster);
  poster.heading_deg = table.number("heading", kAngleRange_deg, 0);
  poster.pitch_deg = table.number("tilt", kTiltRange_deg, 0);
}

void read_billboard(const TomlTable& table, PosterEntry& poster) {
  table.require_known(
      {"name", "file", "form", "opacity", "lon", "lat", "height", "altitude", "width_m", "tall_m"});
  read_rectangle(table, poster);
}

void read_photograph(const TomlTable& table, PosterEntry& poster) {
  table.require_known({"name", "file", "form", "opacity", "lon", "lat", "height", "altitude", "yaw", "pitch",
                       "roll", "fov", "distance_m"});
  poster.place = poster_place(table);
  read_height(table, true, poster);
  poster.heading_deg = table.number("yaw", kAngleRange_deg);
  poster.pitch_deg = table.number("pitch", kAngleRange_deg, 0);
  poster.roll_deg = table.number("roll", kAngleRange_deg, 0);
  poster.fov_deg = table.number("fov", kPosterFovRange_deg);
  poster.distance_m = table.number("distance_m", kPosterSizeRange_m);
}

void read_dome(const TomlTable& table, PosterEntry& poster) {
  table.require_known({"name", "file", "form", "opacity", "lon", "lat", "height", "altitude", "radius_m",
                       "fade_m", "shape", "heading", "replaces_ground"});
  if (table.has("lon") || table.has("lat")) {
    poster.place = poster_place(table);
    read_height(table, true, poster);
  } else if (table.has("height") || table.has("altitude")) {
    table.fail(
        "expected lon and lat with the height of a dome, or none of them where the panorama's metadata "
        "state its place");
  }
  poster.radius_m = table.number("radius_m", kPosterSizeRange_m);
  poster.fade_m = table.number("fade_m", kPosterSizeRange_m, poster.radius_m);
  if (poster.fade_m > poster.radius_m)
    table.fail(table.at("fade_m"), "fade_m: expected at most radius_m, for a dome is seen from within only");
  if (table.has("shape")) poster.is_cylinder = table.choice("shape", {"sphere", "cylinder"}) == 1;
  poster.heading_deg = table.number("heading", kAngleRange_deg, 0);
  poster.replaces_ground = table.has("replaces_ground") && table.truth("replaces_ground");
}

}  // namespace

PosterEntry read_poster(const TomlTable& table, const std::filesystem::path& scene_file) {
  PosterEntry poster;
  poster.form = static_cast<PosterForm>(table.choice("form", {"pane", "billboard", "photograph", "dome"}));
  switch (poster.form) {
    case PosterForm::kPane: read_pane(table, poster); break;
    case PosterForm::kBillboard: read_billboard(table, poster); break;
    case PosterForm::kPhotograph: read_photograph(table, poster); break;
    case PosterForm::kDome: read_dome(table, poster); break;
  }
  poster.file = model_path(scene_file, table.text("file", problem_of_path));
  if (table.has("name")) poster.name = table.text("name", problem_of_name);
  poster.opacity = table.number("opacity", kShareRange, 1);
  return poster;
}

KioskEntry read_kiosk(const TomlTable& table, const std::filesystem::path& scene_file) {
  KioskEntry kiosk;
  kiosk.size_m = table.number("size_m", kPosterSizeRange_m, kiosk.size_m);
  if (table.has("hotspots")) {
    table.require_known({"hotspots", "size_m", "beside_m"});
    kiosk.hotspots = model_path(scene_file, table.text("hotspots", problem_of_path));
    kiosk.beside_m = table.number("beside_m", kLeanRange_m, kiosk.size_m);
    return kiosk;
  }
  table.require_known({"name", "lon", "lat", "heading", "size_m", "panorama"});
  kiosk.place = poster_place(table);
  kiosk.heading_deg = table.number("heading", kAngleRange_deg, 0);
  if (table.has("name")) kiosk.name = table.text("name", problem_of_name);
  if (table.has("panorama")) kiosk.panorama = model_path(scene_file, table.text("panorama", problem_of_path));
  return kiosk;
}

}  // namespace objects
