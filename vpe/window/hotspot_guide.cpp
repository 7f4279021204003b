#include "vpe/window/hotspot_guide.h"

#include <imgui.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace vpe::window {

namespace {

constexpr double kShownWithin_m = 50'000;
constexpr double kHiddenShare = 0.01;  // terrain nearer by this share of its distance hides a hotspot
constexpr ImU32 kMark = IM_COL32(120, 220, 255, 255);
constexpr ImU32 kDark = IM_COL32(0, 0, 0, 180);

}  // namespace

HotspotGuide::HotspotGuide(std::vector<explore::Hotspot> hotspots, OpenOverlook open)
    : hotspots_(std::move(hotspots)), open_(std::move(open)) {}

void HotspotGuide::compute_positions(const explore::Session& session) {
  const double exaggeration = session.settings().values().exaggeration;
  if (exaggeration == positions_exaggeration_) return;
  positions_exaggeration_ = exaggeration;
  const explore::TerrainQuery& ground = session.ground();
  positions_m_ = explore::hotspot_positions(
      hotspots_, ground.radius_m,
      [&](mars::LonLat place, double) { return ground.height_m(mars::direction(place)); }, exaggeration);
  tracker_.emplace(positions_m_);
}

std::string HotspotGuide::follow(const explore::Session& session, const ViewArea& area) {
  if (hotspots_.empty() || inside_ != nullptr) return {};
  compute_positions(session);
  if (ahead_ != nullptr) {
    // A large image is copied while the camera approaches.
    ahead_->place(area);
    ahead_->update(0);
  }
  const explore::HotspotTracker::State before = state_;
  state_ = tracker_->update(session.view().camera.position_m);
  if (state_ == before) return {};
  if (state_.stage == explore::HotspotStage::kFar) {
    ahead_.reset();
    return {};
  }
  if (ahead_ == nullptr || ahead_index_ != state_.hotspot.index) {
    ahead_.reset();
    ahead_index_ = state_.hotspot.index;
    try {
      ahead_ = std::make_unique<OverlookView>(open_(hotspots_[ahead_index_].panorama));
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
  }
  if (state_.stage != explore::HotspotStage::kWithinReach) return {};
  return hotspots_[ahead_index_].name + ": press Enter to open its panorama";
}

const explore::Hotspot* HotspotGuide::within_reach() const {
  return state_.stage == explore::HotspotStage::kWithinReach && ahead_ != nullptr ? &hotspots_[ahead_index_]
                                                                                  : nullptr;
}

std::string HotspotGuide::enter(const explore::Session& session) {
  if (inside_ != nullptr) return {};
  if (within_reach() == nullptr) return "no hotspot is near enough to open its panorama";
  inside_ = std::move(ahead_);
  inside_index_ = ahead_index_;
  state_ = {};
  const mars::CameraPose camera{inside_camera_m(), session.view().camera.axes};
  const mars::Pose pose = mars::to_pose(camera, session.ground().radius_m);
  inside_->look_at(pose.yaw_deg, inside_->viewer().pitch_deg());
  return {};
}

void HotspotGuide::draw_marks(ImDrawList& list, const explore::Session& session, const EyeImage& eye) const {
  const core::View& view = eye.view;
  const float size = ImGui::GetFontSize() * 0.45F;
  for (std::size_t n = 0; n < positions_m_.size(); ++n) {
    const glm::dvec3 path = positions_m_[n] - view.camera.position_m;
    const double distance_m = glm::length(path);
    if (!(distance_m < kShownWithin_m) || distance_m < 1.0) continue;
    const core::Projected at = core::project(view, positions_m_[n]);
    if (at.behind || at.xy.x < 0 || at.xy.y < 0 || at.xy.x > view.width || at.xy.y > view.height) continue;
    if (session.ground().cast_m(view.camera.position_m, path / distance_m) < distance_m * (1.0 - kHiddenShare))
      continue;
    const ImVec2 p{static_cast<float>(eye.x0 + at.xy.x), static_cast<float>(eye.y0 + at.xy.y)};
    const ImVec2 corners[4] = {{p.x, p.y - size}, {p.x + size, p.y}, {p.x, p.y + size}, {p.x - size, p.y}};
    list.AddConvexPolyFilled(corners, 4, kMark);
    list.AddPolyline(corners, 4, kDark, ImDrawFlags_Closed, 1.5F);
    const ImVec2 text{p.x + size * 1.6F, p.y - ImGui::GetFontSize() * 0.5F};
    list.AddText({text.x + 1, text.y + 1}, kDark, hotspots_[n].name.c_str());
    list.AddText(text, kMark, hotspots_[n].name.c_str());
  }
}

}  // namespace vpe::window
