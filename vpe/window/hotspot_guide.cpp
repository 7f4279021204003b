#include "vpe/window/hotspot_guide.h"

#include <imgui.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace vpe::window {

namespace {

constexpr double kShownWithin_m = 50'000;
constexpr double kHiddenShare = 0.01;  // of its distance: how far in front of a spot ground may be
constexpr ImU32 kMark = IM_COL32(120, 220, 255, 255);
constexpr ImU32 kDark = IM_COL32(0, 0, 0, 180);

}  // namespace

SpotGuide::SpotGuide(std::vector<explore::Spot> spots, OpenOverlook open)
    : spots_(std::move(spots)), open_(std::move(open)) {}

void SpotGuide::place(const explore::Session& session) {
  const double exaggeration = session.settings().values().exaggeration;
  if (exaggeration == placed_exaggeration_) return;
  placed_exaggeration_ = exaggeration;
  const explore::Ground& ground = session.ground();
  eyes_m_ = explore::spot_eyes(
      spots_, ground.radius_m,
      [&](mars::LonLat place, double) { return ground.height_m(mars::direction(place)); }, exaggeration);
  tracker_.emplace(eyes_m_);
}

std::string SpotGuide::follow(const explore::Session& session, const ViewArea& area) {
  if (spots_.empty() || inside_ != nullptr) return {};
  place(session);
  if (ahead_ != nullptr) {
    // What is copied once is copied on the way there.
    ahead_->place(area);
    ahead_->update(0);
  }
  const explore::SpotTracker::State before = state_;
  state_ = tracker_->update(session.view().eye.eye_m);
  if (state_ == before) return {};
  if (state_.stage == explore::SpotStage::kFar) {
    ahead_.reset();
    return {};
  }
  if (ahead_ == nullptr || ahead_index_ != state_.spot.index) {
    ahead_.reset();
    ahead_index_ = state_.spot.index;
    try {
      ahead_ = std::make_unique<OverlookView>(open_(spots_[ahead_index_].panorama));
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
  }
  if (state_.stage != explore::SpotStage::kWithinReach) return {};
  return spots_[ahead_index_].name + ": Enter looks around from there";
}

const explore::Spot* SpotGuide::within_reach() const {
  return state_.stage == explore::SpotStage::kWithinReach && ahead_ != nullptr ? &spots_[ahead_index_]
                                                                               : nullptr;
}

std::string SpotGuide::step_in() {
  if (inside_ != nullptr) return {};
  if (spots_.empty()) return "there are no spots; --spots FILE names them";
  if (within_reach() == nullptr) return "no spot is near enough to step into its panorama";
  inside_ = std::move(ahead_);
  inside_index_ = ahead_index_;
  state_ = {};
  return {};
}

void SpotGuide::draw_marks(ImDrawList& list, const explore::Session& session, double x0, double y0) const {
  const core::View view = session.view();
  const float size = ImGui::GetFontSize() * 0.45F;
  for (std::size_t n = 0; n < eyes_m_.size(); ++n) {
    const glm::dvec3 way = eyes_m_[n] - view.eye.eye_m;
    const double distance_m = glm::length(way);
    if (!(distance_m < kShownWithin_m) || distance_m < 1.0) continue;
    const core::Projected at = core::project(view, eyes_m_[n]);
    if (at.behind || at.xy.x < 0 || at.xy.y < 0 || at.xy.x > view.width || at.xy.y > view.height) continue;
    if (session.ground().cast_m(view.eye.eye_m, way / distance_m) < distance_m * (1.0 - kHiddenShare)) continue;
    const ImVec2 p{static_cast<float>(x0 + at.xy.x), static_cast<float>(y0 + at.xy.y)};
    const ImVec2 corners[4] = {{p.x, p.y - size}, {p.x + size, p.y}, {p.x, p.y + size}, {p.x - size, p.y}};
    list.AddConvexPolyFilled(corners, 4, kMark);
    list.AddPolyline(corners, 4, kDark, ImDrawFlags_Closed, 1.5F);
    const ImVec2 text{p.x + size * 1.6F, p.y - ImGui::GetFontSize() * 0.5F};
    list.AddText({text.x + 1, text.y + 1}, kDark, spots_[n].name.c_str());
    list.AddText(text, kMark, spots_[n].name.c_str());
  }
}

}  // namespace vpe::window
