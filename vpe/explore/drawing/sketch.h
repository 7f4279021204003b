// Drawing by hand: clicks that place vertices, keys that end or take back, drags that move vertices.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vpe/explore/drawing/drawings.h"

namespace vpe::explore {

// Names a vertex of a drawing.
struct VertexRef {
  std::uint64_t id = 0;
  std::size_t index = 0;
  bool operator==(const VertexRef&) const = default;
};

// Returns the vertex of a visible drawing that is nearest to a position and within reach, the topmost of equal
// ones. `position` returns where a place is seen, or nullopt if it is not.
std::optional<VertexRef> nearest_vertex(std::span<const Drawings::Shared> drawings,
                                        const std::function<std::optional<glm::dvec2>(mars::LonLat)>& position,
                                        glm::dvec2 xy, double reach_px);

// Holds the tool that is chosen and the vertices that are placed and not finished. For one thread at a time.
//
// Typical usage:
//   sketch.choose(DrawingKind::kPolygon);
//   problem = sketch.click(place);          // a vertex for each click
//   problem = sketch.finish();              // double click or Enter: the polygon is in `drawings`
//   sketch.press(*nearest_vertex(...)); problem = sketch.drag(place); sketch.release();
class Sketch {
 public:
  using Problem = Drawings::Problem;

  explicit Sketch(Drawings& drawings) : drawings_(drawings) {}

  // Chooses what the next clicks draw; nullopt: nothing. Vertices that are not finished are dropped.
  void choose(std::optional<DrawingKind> tool);
  std::optional<DrawingKind> tool() const { return tool_; }
  // Sets the colour of what is drawn from now on.
  void set_colour(base::Rgb colour) { colour_ = colour; }
  base::Rgb colour() const { return colour_; }

  // Places a vertex. A point is finished at once. Returns what is wrong with the place, or "".
  [[nodiscard]] Problem click(mars::LonLat place);
  // Ends the line or polygon, and keeps the tool. Returns what is missing, or "".
  [[nodiscard]] Problem finish();
  // Takes the last vertex back, or places it again. Return false if there is none.
  bool take_back();
  bool place_again();
  // Drops the vertices that are not finished; if there are none, puts the tool away. Returns false if there was
  // nothing to cancel.
  bool cancel();
  std::span<const mars::LonLat> unfinished() const { return vertices_; }
  // Returns the unfinished line or polygon as a drawing, or nullopt if it has too few vertices for one.
  std::optional<Drawing> unfinished_drawing() const;

  // Begin, continue and end the move of a vertex. One move is one step of undo.
  void press(VertexRef vertex);
  [[nodiscard]] Problem drag(mars::LonLat place);
  void release() { held_.reset(); }
  const std::optional<VertexRef>& held() const { return held_; }

  // Returns the drawing that was made, moved or selected last, or 0. It may be gone.
  std::uint64_t selected() const { return selected_; }
  void select(std::uint64_t id) { selected_ = id; }

 private:
  Problem add(Drawing drawing);

  Drawings& drawings_;
  std::optional<DrawingKind> tool_;
  base::Rgb colour_ = Drawing().colour;
  std::vector<mars::LonLat> vertices_;
  std::vector<mars::LonLat> taken_back_;
  std::optional<VertexRef> held_;
  bool moved_ = false;
  std::uint64_t selected_ = 0;
};

}  // namespace vpe::explore
