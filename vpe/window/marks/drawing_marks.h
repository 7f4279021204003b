// Drawings over the view and on the map.
#pragma once

#include <imgui.h>

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "vpe/explore/drawing/drawings.h"
#include "vpe/explore/measure/map_view.h"
#include "vpe/explore/session.h"
#include "vpe/window/marks/ground_view.h"

namespace vpe::window {

// Holds what is drawn.
struct DrawingScene {
  std::span<const explore::Drawings::Shared> drawings;
  std::uint64_t selected = 0;                // has larger vertices
  std::span<const mars::LonLat> unfinished;  // of a line or polygon
  bool is_polygon = false;                   // that is not finished
  base::Rgb colour;                          // of the unfinished
  std::optional<mars::LonLat> cursor;        // to which the unfinished is drawn on
};

struct DrawingMarkLimits {
  static constexpr std::size_t kLinePoints = 4'000;   // of one drawing that are kept
  static constexpr int kRefinements = 600;            // of lines in the view, in one frame
  static constexpr int kDrawingCasts = 150;           // that find parts hidden by nearer ground, in one frame
  static constexpr std::size_t kNamedVertices = 400;  // of one drawing; of larger ones only lines are drawn
};

// Draws drawings, and keeps the points of their lines on the ground. For the window's thread.
class DrawingMarks {
 public:
  // Draws over the image of an eye, on the ground as drawn. Hidden parts are faint, hidden vertices hollow. Casts
  // rays, which takes one or two milliseconds.
  void draw(ImDrawList& list, const explore::Session& session, const DrawingScene& scene, const EyeImage& eye);

  // Forgets the kept points, as when the ground changes.
  void clear() { lines_.clear(); }

 private:
  const std::vector<glm::dvec3>& line_of(const explore::Drawings::Shared& drawing,
                                         const explore::Session& session);

  double exaggeration_ = 1;
  std::map<explore::Drawings::Shared, std::vector<glm::dvec3>> lines_;  // metres from the planet's centre
};

// Draws over a map.
void draw_on_map(ImDrawList& list, const explore::MapView& map, const DrawingScene& scene, double x0,
                 double y0);

}  // namespace vpe::window
