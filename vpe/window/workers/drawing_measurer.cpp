#include "vpe/window/workers/drawing_measurer.h"

#include <exception>
#include <utility>
#include <vector>

namespace vpe::window {

DrawingMeasurer::DrawingMeasurer(std::shared_ptr<const paging::Surface> surface, std::function<void()> notify)
    : surface_(std::move(surface)),
      notify_(std::move(notify)),
      worker_([this](const Request& request) { return measure(request); }, notify_) {}

void DrawingMeasurer::request(explore::Drawings::Shared drawing) {
  if (drawing == wanted_) return;
  wanted_ = std::move(drawing);
  stop_.request_stop();
  worker_.forget();
  measured_.reset();
  progress_ = 0;
  if (wanted_ == nullptr) return;
  stop_ = std::stop_source();
  worker_.request({wanted_, stop_.get_token()});
}

const MeasuredDrawing* DrawingMeasurer::measured() {
  if (auto next = worker_.take(); next && next->drawing == wanted_) measured_ = std::move(next);
  return measured_ ? &*measured_ : nullptr;
}

std::optional<MeasuredDrawing> DrawingMeasurer::measure(const Request& request) {
  MeasuredDrawing out;
  out.drawing = request.drawing;
  try {
    out.sphere = explore::sphere_measures(*request.drawing, surface_->planet_radius_m());
    explore::GroundAreaOptions options;
    options.progress = [this](double share) {
      progress_ = share;
      notify_();
    };
    out.ground = explore::ground_measures(*surface_, *request.drawing, options, request.stop);
    if (!out.ground) return std::nullopt;
    std::vector<mars::LonLat> places = request.drawing->vertices;
    if (request.drawing->kind == explore::DrawingKind::kPolygon) places.push_back(places.front());
    out.along = explore::ground_along(*surface_, places);
  } catch (const std::exception& e) {
    out.error = e.what();
  }
  return out;
}

}  // namespace vpe::window
