#include "vpe/explore/drawing/sketch.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace vpe::explore {

std::optional<VertexRef> nearest_vertex(std::span<const Drawings::Shared> drawings,
                                        const std::function<std::optional<glm::dvec2>(mars::LonLat)>& position,
                                        glm::dvec2 xy, double reach_px) {
  std::optional<VertexRef> nearest;
  double nearest_px = reach_px;
  for (const Drawings::Shared& drawing : drawings) {
    if (!drawing->visible) continue;
    for (std::size_t n = 0; n < drawing->vertices.size(); ++n) {
      const std::optional<glm::dvec2> seen = position(drawing->vertices[n]);
      const double off_px = seen ? glm::length(*seen - xy) : reach_px + 1;
      if (!(off_px <= nearest_px)) continue;
      nearest = VertexRef{drawing->id, n};
      nearest_px = off_px;
    }
  }
  return nearest;
}

void Sketch::choose(std::optional<DrawingKind> tool) {
  tool_ = tool;
  vertices_.clear();
  taken_back_.clear();
}

Sketch::Problem Sketch::add(Drawing drawing) {
  Problem problem = drawings_.add(std::move(drawing));
  if (problem.empty()) selected_ = drawings_.all().back()->id;
  return problem;
}

Sketch::Problem Sketch::click(mars::LonLat place) {
  if (!tool_) return "choose Point, Line or Polygon first";
  Drawing drawing{0, *tool_, "", colour_, true, {place}};
  if (*tool_ == DrawingKind::kPoint) return add(std::move(drawing));
  if (Problem problem = problem_of_place(place); !problem.empty()) return problem;
  place.lon_deg = mars::normalize_lon_deg(place.lon_deg);
  if (!vertices_.empty()) {
    // As a line, whose rules hold for the edges of polygons too.
    drawing.kind = DrawingKind::kLine;
    drawing.vertices = {vertices_.back(), place};
    if (Problem problem = problem_of(drawing); !problem.empty()) return problem;
  }
  if (vertices_.size() >= DrawingLimits::kMostVertices)
    return "a drawing has at most " + std::to_string(DrawingLimits::kMostVertices) +
           " vertices: finish this one";
  vertices_.push_back(place);
  taken_back_.clear();
  return "";
}

Sketch::Problem Sketch::finish() {
  if (!tool_ || vertices_.empty()) return "nothing is being drawn";
  Problem problem = add({0, *tool_, "", colour_, true, vertices_});
  if (!problem.empty()) return problem;
  vertices_.clear();
  taken_back_.clear();
  return "";
}

bool Sketch::take_back() {
  if (vertices_.empty()) return false;
  taken_back_.push_back(vertices_.back());
  vertices_.pop_back();
  return true;
}

bool Sketch::place_again() {
  if (taken_back_.empty()) return false;
  vertices_.push_back(taken_back_.back());
  taken_back_.pop_back();
  return true;
}

bool Sketch::cancel() {
  if (!tool_) return false;
  if (vertices_.empty()) tool_.reset();
  vertices_.clear();
  taken_back_.clear();
  return true;
}

std::optional<Drawing> Sketch::unfinished_drawing() const {
  if (!tool_ || vertices_.size() < 2) return std::nullopt;
  Drawing drawing{0, *tool_, "unfinished", colour_, true, vertices_};
  if (!problem_of(drawing).empty()) drawing.kind = DrawingKind::kLine;
  return drawing;
}

void Sketch::press(VertexRef vertex) {
  held_ = vertex;
  moved_ = false;
  selected_ = vertex.id;
}

Sketch::Problem Sketch::drag(mars::LonLat place) {
  if (!held_) return "no vertex is held";
  Problem problem = drawings_.move_vertex(held_->id, held_->index, place, moved_);
  moved_ = moved_ || problem.empty();
  return problem;
}

}  // namespace vpe::explore
