// Parts of ray_figures: the scene that all figures show, side views of the ground, and an SVG writer.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/range_caster.h"

namespace bench {

// Colours that most people can distinguish, after Okabe and Ito.
inline constexpr const char* kBlue = "#0072b2";
inline constexpr const char* kRed = "#d55e00";
inline constexpr const char* kGreen = "#009e73";
inline constexpr const char* kPink = "#b0508a";
inline constexpr const char* kGrey = "#8c8c8c";
inline constexpr const char* kInk = "#222";
inline constexpr const char* kSoil = "#ead9c4";
inline constexpr const char* kSoilEdge = "#7a5a36";

// Describes how a shape is drawn. nullptr: no stroke, no fill, no dashes.
struct Style {
  const char* stroke = nullptr;
  double width_px = 1;
  const char* fill = nullptr;
  const char* dashes = nullptr;
};

// Describes how a text is drawn.
struct TextStyle {
  const char* anchor = "start";
  const char* colour = kInk;
  double size_px = 13;
  bool bold = false;
  bool halo = true;  // draws a white border, so that lines behind do not hide the text
};

// Maps values to a rectangle of the drawing.
struct Panel {
  double x_px = 0;
  double y_px = 0;
  double width_px = 0;
  double height_px = 0;
  glm::dvec2 low{0, 0};   // values at the lower left corner
  glm::dvec2 high{1, 1};  // values at the upper right corner

  glm::dvec2 at(const glm::dvec2& value) const;
  // Returns pixels for each unit across and up.
  glm::dvec2 scale() const;
};

// Returns a panel that shows the middle with equal scales across and up, `width` units wide.
Panel square_panel(double x_px, double y_px, double width_px, double height_px, const glm::dvec2& middle,
                   double width);

// Writes an SVG file with a white background. Coordinates are pixels, rounded to a tenth.
class Drawing {
 public:
  Drawing(double width_px, double height_px, const std::string& title);

  void line(const glm::dvec2& a, const glm::dvec2& b, const Style& style);
  void path(const std::vector<glm::dvec2>& points, const Style& style, bool closed = false);
  void circle(const glm::dvec2& centre, double radius_px, const Style& style);
  void rectangle(const glm::dvec2& corner, const glm::dvec2& size, const Style& style);
  void text(const glm::dvec2& at, const std::string& text, const TextStyle& style = {});
  // Draws a line with a short bar across each end.
  void bracket(const glm::dvec2& a, const glm::dvec2& b, const Style& style);

  // Draws a bar of a round length across a panel, and says its length in metres.
  void scale_bar(const Panel& panel, const glm::dvec2& at);

  // Clips what is drawn until end_clip() to a panel.
  void begin_clip(const Panel& panel);
  void end_clip();

  // Draws ticks with numbers below and left of a panel, and its border.
  void axes(const Panel& panel, const std::string& x_label, const std::string& y_label, int x_ticks,
            int y_ticks);

  // Writes the file. Throws std::runtime_error.
  void write(const std::string& file) const;

 private:
  std::string text_;
};

// Returns a number with a fixed count of decimals, without a negative zero.
std::string fixed(double value, int decimals = 0);

// Holds a small planet and what casts it: the embedded Mars, fine over a few kilometres about a place.
struct Scene {
  mars::LonLat place;
  double spacing_m = 0;  // of the posts about the place
  std::unique_ptr<vpe::voxel::RangeCaster> caster;
  std::unique_ptr<vpe::base::ThreadPool> pool;

  const paging::Surface& surface() const { return caster->surface(); }
};

// Describes a camera of the scene.
struct CameraSpec {
  double east_m = 0;  // from the scene's place
  double north_m = 0;
  double above_ground_m = 0;
  double yaw_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;
};
vpe::core::View make_view(const Scene& scene, const CameraSpec& camera, int width, int height, double fov_deg);

// Casts an image by the columns of the ray backend, all posts exact.
std::vector<float> cast_image(const Scene& scene, const vpe::core::View& view);

// Describes the vertical plane through the camera and a ray: places are (distance, height) from the camera.
struct SidePlane {
  glm::dvec3 camera_m{0, 0, 0};
  glm::dvec3 ahead{1, 0, 0};
  glm::dvec3 up{0, 0, 1};

  SidePlane(const vpe::core::View& view, const glm::dvec3& ray);
  glm::dvec2 at(const glm::dvec3& point_m) const;
};

// Returns the corners of the ground in the plane from one distance to another.
std::vector<glm::dvec2> ground_line(const paging::Surface& surface, const SidePlane& plane, double begin_m,
                                    double end_m);

// Draws the ground of a panel: filled down to the panel's lower border.
void draw_ground(Drawing& out, const Panel& panel, const std::vector<glm::dvec2>& ground);

// Draw one figure each, and return a line that says what it shows.
std::string draw_footprint(const Scene& scene, const std::string& file);
std::string draw_column(const Scene& scene, const std::string& file);
std::string draw_sectors(const Scene& scene, const std::string& file);
std::string draw_hints(const Scene& scene, const std::string& file);
std::string draw_discrete(const Scene& scene, const std::string& file);
std::string draw_sticks(const Scene& scene, const std::string& file);
std::string draw_gaps(const Scene& scene, const std::string& file);  // of a scene of its own

}  // namespace bench
