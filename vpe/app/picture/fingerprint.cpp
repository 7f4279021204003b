#include "vpe/app/picture/fingerprint.h"

#include <cstdint>
#include <filesystem>

#include "vpe/app/cli/digest.h"
#include "vpe/app/picture/scene_digests.h"
#include "vpe/core/appearance/layer_list.h"
#include "vpe/core/appearance/palette.h"

namespace vpe::app {

namespace {

// Raised whenever the encoding below changes its meaning.
constexpr std::int64_t kEncoding = 3;

void add(Digest& digest, const glm::dvec3& v) { digest.add(v.x).add(v.y).add(v.z); }

// A palette's file may be edited under the same name, so its content counts.
void add(Digest& digest, const core::Palette& palette) {
  digest.add(static_cast<std::int64_t>(palette.scale()));
  for (const core::PaletteStop& stop : palette.stops()) add(digest.add(stop.at), stop.rgb);
}

void add(Digest& digest, const std::vector<core::ObjectTrack>& tracks) {
  for (const core::ObjectTrack& track : tracks) {
    digest.add("track").add(track.name);
    for (const core::ObjectTrack::Point& point : track.points) {
      digest.add(point.time_s).add(point.place.lon_deg).add(point.place.lat_deg).add(point.place.height_m);
      digest.add(std::int64_t{point.place.heading_deg.has_value()}).add(point.place.heading_deg.value_or(0));
    }
    for (const core::ObjectTrack::Showing& change : track.showings)
      digest.add("shown").add(change.time_s).add(std::int64_t{change.is_shown});
  }
}

}  // namespace

std::string fingerprint_of(const RenderBasis& basis, const core::DrawRequest& request,
                           const core::Settings& settings, double time_s, const FingerprintOrigin& origin) {
  const core::View& view = request.view;
  Digest digest;
  digest.add(kEncoding).add(basis.program).add(basis.planet).add(core::to_string(basis.backend));
  digest.add(std::int64_t{basis.memory_mb});
  digest.add(static_cast<std::int64_t>(view.projection)).add(view.fov_deg);
  digest.add(std::int64_t{view.width}).add(std::int64_t{view.height});
  digest.add(view.principal_offset_px.x).add(view.principal_offset_px.y);
  for (const int n : {view.part.x, view.part.y, view.part.width, view.part.height}) digest.add(std::int64_t{n});
  add(digest, view.camera.position_m);
  add(digest, view.camera.axes.right);
  add(digest, view.camera.axes.up);
  add(digest, view.camera.axes.forward);
  add(digest, request.sun);
  digest.add(static_cast<std::int64_t>(request.interest.size()));
  for (const core::InterestRegion& r : request.interest) {
    digest.add(r.lon_deg).add(r.lat_deg).add(r.radius_m).add(std::int64_t{r.levels});
  }
  digest.add(request.coarsening);
  // The registry's text of a number is parsed back to the same bits.
  for (const core::SettingInfo& info : core::Settings::list()) {
    digest.add(info.key).add(settings.get(info.key).value_or(""));
  }
  if (const auto file = core::palette_file(settings.values().palette)) add(digest, core::read_palette(*file));
  const core::SettingsValues& values = settings.values();
  if (values.time_code == core::TimeCode::kFlight) digest.add("time").add(time_s);
  if (!values.names.empty()) digest.add("names").add(checksum_of(std::filesystem::path(values.names)));
  for (const core::LayerFile& layer : core::parse_layer_list(values.layers))
    digest.add("layer").add(checksum_of(std::filesystem::path(layer.path)));
  if (!values.scene.empty()) {
    const SceneDigests::Known scene =
        basis.scenes ? basis.scenes->of(values.scene) : SceneDigests().of(values.scene);
    digest.add("scene");
    for (const std::string& checksum : scene.checksums) digest.add(checksum);
    if (scene.has_paths || request.tracks) digest.add(request.time_s);
    if (request.tracks) add(digest, *request.tracks);
  }
  if (request.keeps_levels) digest.add("keeps levels");
  if (origin.stereo) {
    digest.add("stereo").add(core::to_string(origin.stereo->layout)).add(origin.stereo->eye_base_m);
    if (origin.stereo->convergence_m > 0) digest.add("convergence").add(origin.stereo->convergence_m);
  }
  if (origin.carried_gap_px) digest.add("carried").add(*origin.carried_gap_px);
  if (origin.reuse) {
    digest.add("reuse").add(origin.reuse->key).add(origin.reuse->most_added_px);
    digest.add(std::int64_t{origin.reuse->margin_px.x}).add(std::int64_t{origin.reuse->margin_px.y});
  }
  for (const std::string& line : origin.ground) digest.add("ground").add(line);
  return digest.hex();
}

}  // namespace vpe::app
