// The gaps of a second eye, from above: what a carried row shows, and what is left to be drawn.
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "tests/bench/figures/ray_figures.h"
#include "vpe/core/stereo.h"
#include "vpe/warp/carry.h"

namespace bench {

namespace {

using vpe::warp::Origin;

constexpr int kColumns = 36;
constexpr int kRows = 3;  // the middle one is drawn
constexpr double kFocal_px = 26;
constexpr double kBase_m = 7;

// A wall that is seen from above: metres to the right of the left eye, and ahead of it.
struct Wall {
  glm::dvec2 a;
  glm::dvec2 b;
};
constexpr std::array<Wall, 4> kWalls{
    {{{-60, 62}, {70, 96}}, {{-7, 30}, {5, 30}}, {{5, 30}, {12, 46}}, {{-7, 40}, {-7, 30}}}};

// Returns how far ahead a ray meets the first wall; infinite if it meets none.
double depth_m(const glm::dvec2& from, double slope) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : kWalls) {
    const glm::dvec2 way = wall.b - wall.a;
    const double cross = slope * way.y - way.x;
    if (std::abs(cross) < 1e-12) continue;
    const glm::dvec2 to = wall.a - from;
    const double ahead = (to.x * way.y - to.y * way.x) / cross;
    const double along = (to.x - slope * to.y) / cross;
    if (ahead > 0 && along >= 0 && along <= 1) nearest = std::min(nearest, ahead);
  }
  return nearest;
}

vpe::core::View left_view() {
  vpe::core::View view;
  view.width = kColumns;
  view.height = kRows;
  view.fov_deg = 2 * std::atan(0.5 * kRows / kFocal_px) / mars::kRadiansPerDegree;
  view.camera.position_m = {0, 0, 0};
  view.camera.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  return view;
}

double slope_of(double x) { return (x + 0.5 - 0.5 * kColumns) / kFocal_px; }

vpe::core::Frame left_frame() {
  vpe::core::Frame frame{kColumns, kRows, {}, {}};
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const double rise = (0.5 * kRows - y - 0.5) / kFocal_px;
      frame.range_m.push_back(static_cast<float>(depth_m({0, 0}, slope_of(x)) *
                                                 std::sqrt(1 + slope_of(x) * slope_of(x) + rise * rise)));
    }
  }
  return frame;
}

const char* colour_of(Origin origin) {
  return origin == Origin::kOpen ? kRed : origin == Origin::kBetween ? kGreen : kBlue;
}

}  // namespace

std::string draw_gaps(const Scene& /*scene*/, const std::string& file) {
  const vpe::core::View left = left_view();
  const vpe::core::Frame frame = left_frame();
  const vpe::core::View right = vpe::core::eye_view(left, kBase_m, std::nullopt);
  vpe::base::ThreadPool pool(1);
  vpe::warp::CarryOptions options;
  options.nearest_m = 24;
  const vpe::warp::CarriedImage carried = vpe::warp::carry(left, frame, right, options, pool);

  Drawing out(900, 640, "The gaps of a second eye, from above");
  const Panel panel = square_panel(20, 40, 860, 470, {4, 47}, 172);
  out.begin_clip(panel);
  for (int x = 0; x < kColumns; ++x) {
    const double ahead = depth_m({0, 0}, slope_of(x));
    out.line(panel.at({0, 0}), panel.at({ahead * slope_of(x), ahead}), {.stroke = kGrey, .width_px = 0.6});
  }
  int counts[4] = {0, 0, 0, 0};
  for (int x = 0; x < kColumns; ++x) {
    const Origin origin = carried.origin[static_cast<std::size_t>(kColumns + x)];
    ++counts[static_cast<int>(origin)];
    const double ahead = depth_m({kBase_m, 0}, slope_of(x));
    const glm::dvec2 end{kBase_m + ahead * slope_of(x), ahead};
    out.line(panel.at({kBase_m, 0}), panel.at(end), {.stroke = colour_of(origin), .width_px = 1.3});
    out.circle(panel.at(end), 3, {.fill = colour_of(origin)});
  }
  for (const Wall& wall : kWalls)
    out.line(panel.at(wall.a), panel.at(wall.b), {.stroke = kSoilEdge, .width_px = 3});
  out.end_clip();
  for (int x = 0; x < kColumns; ++x) {
    const double ahead = depth_m({0, 0}, slope_of(x));
    out.circle(panel.at({ahead * slope_of(x), ahead}), 2, {.fill = kInk});
  }
  out.circle(panel.at({0, 0}), 5, {.fill = kGrey});
  out.circle(panel.at({kBase_m, 0}), 5, {.fill = kInk});
  out.text(panel.at({-1.5, -1}), "left eye", {.anchor = "end"});
  out.text(panel.at({kBase_m + 1.5, -1}), "right eye");
  out.scale_bar(panel, {700, 480});

  // The row of the right eye.
  const double side_px = 860.0 / kColumns;
  for (int x = 0; x < kColumns; ++x) {
    const Origin origin = carried.origin[static_cast<std::size_t>(kColumns + x)];
    out.rectangle({20 + x * side_px, 530}, {side_px - 1, side_px - 1}, {.fill = colour_of(origin)});
  }
  out.text({20, 575}, "The right eye's row: pixels of the left one that land there or beside it",
           {.colour = kBlue});
  out.text({20, 595}, "between two that have moved apart, by at most 2 pixels: what lies between them",
           {.colour = kGreen});
  out.text({20, 615}, "open: behind what is near, or beside the left image; drawn by rays", {.colour = kRed});
  out.write(file);
  return fixed(counts[static_cast<int>(Origin::kCarried)]) + " pixels carried, " +
         fixed(counts[static_cast<int>(Origin::kBetween)]) + " between, " +
         fixed(counts[static_cast<int>(Origin::kOpen)]) + " open";
}

}  // namespace bench
