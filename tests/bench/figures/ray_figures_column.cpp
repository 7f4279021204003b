// Figure: one column, the slopes of the edges that it crosses, its floating horizon and the rows that it resolves.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/bench/figures/ray_figures.h"
#include "tests/bench/figures/ray_figures_edges.h"

namespace bench {

namespace {

namespace core = vpe::core;
namespace voxel = vpe::voxel;
using voxel::LineFamily;

constexpr CameraSpec kCamera{.north_m = 1000, .above_ground_m = 230, .yaw_deg = 12};
// The image is a column of a cylinder: rows are even in slope. Only the lower rows are drawn.
constexpr int kRows = 28;
constexpr int kFullRows = 40;
constexpr double kFov_deg = 48;
constexpr double kReach_m = 2000;
constexpr double kNearest_m = 300;  // where the plots begin

// Place of the panels.
constexpr double kLeft_px = 64;
constexpr double kWide_px = 628;

constexpr const char* kHidden = "#b0a090";

const char* colour_of(const EdgeCrossing& edge) { return edge.walked ? kBlue : kRed; }

const char* name_of(LineFamily family) {
  return family == LineFamily::kColumns ? "x = k" : (family == LineFamily::kRows ? "y = k" : "x - y = k");
}

// Holds a row of the image: its ray and where the cast met the ground.
struct Row {
  double slope = 0;
  double distance_m = 0;  // infinite: sky
  int edge = -1;          // the first at or above the ray
};

// Holds what the figure shows.
struct Column {
  std::vector<EdgeCrossing> edges;
  std::vector<double> horizon;  // the largest slope up to each edge
  std::vector<Row> rows;        // from the lowest
  int agreeing = 0;             // rows whose cast lies between the edge that resolves them and the one before
};

Column make_column(const Scene& scene) {
  core::View view = make_view(scene, kCamera, 1, kFullRows, kFov_deg);
  view.part = {0, kFullRows - kRows, 1, kRows};
  view.projection = core::Projection::kCylinder;
  const std::vector<float> range_m = cast_image(scene, view);
  const SidePlane plane(view, core::pixel_ray(view, 0.5, 0.5 * kFullRows));
  const double distance_m = glm::length(view.camera.position_m);
  const voxel::ColumnCamera camera{plane.up, distance_m, scene.surface().planet_radius_m(),
                                   scene.surface().at(plane.up).radius_m};
  Column c;
  c.edges = edges_of_column(scene, camera, plane.ahead, 1.05 * kReach_m);
  double most = -std::numeric_limits<double>::infinity();
  for (const EdgeCrossing& edge : c.edges) c.horizon.push_back(most = std::max(most, edge.slope));
  for (int row = kRows - 1; row >= 0; --row) {
    const glm::dvec3 ray = core::pixel_ray(view, 0.5, view.part.y + row + 0.5);
    Row r;
    r.slope = glm::dot(ray, plane.up) / glm::dot(ray, plane.ahead);
    r.distance_m = static_cast<double>(range_m[static_cast<std::size_t>(row)]) * glm::dot(ray, plane.ahead);
    const auto reached = std::lower_bound(c.horizon.begin(), c.horizon.end(), r.slope);
    if (reached != c.horizon.end()) {
      r.edge = static_cast<int>(reached - c.horizon.begin());
      const auto at = static_cast<std::size_t>(r.edge);
      const double before_m = at == 0 ? 0 : c.edges[at - 1].distance_m;
      constexpr double kSlack = 1e-5;
      if (r.distance_m >= before_m * (1 - kSlack) && r.distance_m <= c.edges[at].distance_m * (1 + kSlack))
        ++c.agreeing;
    } else if (!(r.distance_m < c.edges.back().distance_m)) {
      ++c.agreeing;
    }
    c.rows.push_back(r);
  }
  return c;
}

bool visible(const Column& c, std::size_t edge) { return c.edges[edge].slope >= c.horizon[edge]; }

glm::dvec2 place_of(const EdgeCrossing& edge) { return {edge.distance_m, edge.slope * edge.distance_m}; }

// Returns the visible part of the ground before an edge that raises the horizon.
std::vector<glm::dvec2> visible_piece(const Column& c, std::size_t edge) {
  const glm::dvec2 end = place_of(c.edges[edge]);
  glm::dvec2 begin = place_of(c.edges[edge - 1]);
  const double before = begin.y - c.horizon[edge - 1] * begin.x;
  const double after = end.y - c.horizon[edge - 1] * end.x;
  if (before < 0 && after > before) begin += before / (before - after) * (end - begin);
  return {begin, end};
}

void draw_side(Drawing& out, const Column& c) {
  double low = 0;
  double high = -1e9;
  for (const EdgeCrossing& edge : c.edges) {
    if (edge.distance_m < kNearest_m || edge.distance_m > kReach_m) continue;
    low = std::min(low, place_of(edge).y);
    high = std::max(high, place_of(edge).y);
  }
  const Panel side = square_panel(kLeft_px, 66, kWide_px, 220,
                                  {0.5 * (kNearest_m + kReach_m), 0.5 * (low + high)}, kReach_m - kNearest_m);
  std::vector<glm::dvec2> ground;
  for (const EdgeCrossing& edge : c.edges) ground.push_back(place_of(edge));
  out.begin_clip(side);
  draw_ground(out, side, ground);
  for (const Row& row : c.rows) {
    const double end_m = std::min(row.distance_m, 2 * kReach_m);
    out.line(side.at({0, 0}), side.at({end_m, row.slope * end_m}), {.stroke = kGrey, .width_px = 0.6});
  }
  for (std::size_t k = 1; k < ground.size(); ++k) {
    if (!visible(c, k)) continue;
    const std::vector<glm::dvec2> piece = visible_piece(c, k);
    out.line(side.at(piece[0]), side.at(piece[1]), {.stroke = kGreen, .width_px = 3});
  }
  out.end_clip();
  out.axes(side, "", "height from the camera, m (equal scales); green: ground that the column sees", 8, 5);
}

// Draws a strip of the image: the rows that one edge resolves have one tone.
void draw_rows(Drawing& out, const Panel& plot, const Column& c) {
  const double half = 0.5 * (c.rows[1].slope - c.rows[0].slope);
  int tone = 0;
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    const Row& row = c.rows[k];
    if (k > 0 && row.edge != c.rows[k - 1].edge) ++tone;
    const glm::dvec2 top = plot.at({kNearest_m, row.slope + half});
    const glm::dvec2 bottom = plot.at({kNearest_m, row.slope - half});
    const char* const fill = row.edge < 0 ? "#fff" : (tone % 2 == 0 ? "#8fb8d8" : "#d5e4f0");
    out.rectangle(top, {20, bottom.y - top.y}, {.stroke = "#fff", .width_px = 0.8, .fill = fill});
  }
}

void draw_slopes(Drawing& out, const Column& c) {
  const double step = c.rows[1].slope - c.rows[0].slope;
  const Panel plot{kLeft_px,
                   344,
                   kWide_px,
                   330,
                   {kNearest_m, c.rows.front().slope - 0.5 * step},
                   {kReach_m, c.rows.back().slope + 0.5 * step}};
  out.begin_clip(plot);
  for (const Row& row : c.rows) {
    const double end_m = row.edge < 0 ? kReach_m : row.distance_m;
    out.line(plot.at({kNearest_m, row.slope}), plot.at({end_m, row.slope}), {.stroke = kGrey, .width_px = 0.6});
  }
  draw_rows(out, plot, c);
  std::vector<glm::dvec2> curve;
  std::vector<glm::dvec2> horizon;
  for (std::size_t k = 0; k < c.edges.size(); ++k) {
    const double x = c.edges[k].distance_m;
    if (x < kNearest_m) continue;
    curve.push_back(plot.at({x, c.edges[k].slope}));
    if (k > 0) horizon.push_back(plot.at({x, c.horizon[k - 1]}));
    horizon.push_back(plot.at({x, c.horizon[k]}));
  }
  out.path(curve, {.stroke = kSoilEdge, .width_px = 0.8});
  out.path(horizon, {.stroke = kGreen, .width_px = 2});
  for (std::size_t k = 0; k < c.edges.size(); ++k) {
    if (c.edges[k].distance_m < kNearest_m) continue;
    out.circle(plot.at({c.edges[k].distance_m, c.edges[k].slope}), 2.2,
               {.fill = visible(c, k) ? colour_of(c.edges[k]) : kHidden});
  }
  for (const Row& row : c.rows) {
    if (row.edge >= 0) out.circle(plot.at({row.distance_m, row.slope}), 3.5, {.stroke = kInk});
  }
  out.end_clip();
  out.axes(plot, "horizontal distance, m", "slope z / sigma", 8, 7);
}

void draw_legend(Drawing& out, const std::string& walked) {
  struct Entry {
    const char* colour;
    std::string text;
  };
  const Entry dots[] = {{kBlue, "edge on a line " + walked + ", the family walked"},
                        {kRed, "the one edge between two of these lines"},
                        {kHidden, "edge below the horizon: resolves nothing"}};
  glm::dvec2 at{372, 550};
  for (const Entry& entry : dots) {
    out.circle(at + glm::dvec2(8, -4.5), 3.5, {.fill = entry.colour});
    out.text(at + glm::dvec2(24, 0), entry.text);
    at.y += 20;
  }
  out.line(at + glm::dvec2(0, -4.5), at + glm::dvec2(17, -4.5), {.stroke = kGreen, .width_px = 2.5});
  out.text(at + glm::dvec2(24, 0), "floating horizon: the steepest so far");
  at.y += 20;
  out.circle(at + glm::dvec2(8, -4.5), 4, {.stroke = kInk});
  out.text(at + glm::dvec2(24, 0), "where the cast of a row met the ground");
  at.y += 20;
  out.rectangle(at + glm::dvec2(0, -11), {17, 6}, {.fill = "#8fb8d8"});
  out.rectangle(at + glm::dvec2(0, -5), {17, 6}, {.fill = "#d5e4f0"});
  out.text(at + glm::dvec2(24, 0), "rows of the image, one tone for an edge");
}

// Returns (k, position) of a place: its line of the walked family and its position along it.
glm::dvec2 on_lines(LineFamily walked, const glm::dvec2& in_grid) {
  if (walked == LineFamily::kColumns) return in_grid;
  if (walked == LineFamily::kRows) return {in_grid.y, in_grid.x};
  return {in_grid.x - in_grid.y, in_grid.x};
}

// Draws posts and edges about the path from above. In (k, position) the edges of the third family have slope 1.
void draw_plan(Drawing& out, const Column& c, LineFamily walked) {
  const EdgeCrossing& middle = c.edges[c.edges.size() / 2];
  std::vector<glm::dvec2> path;
  std::vector<const EdgeCrossing*> edges;
  for (const EdgeCrossing& edge : c.edges) {
    if (edge.tile != middle.tile) continue;
    edges.push_back(&edge);
    path.push_back(on_lines(walked, edge.in_grid));
  }
  constexpr int kLines = 16;
  constexpr double kCell_px = kWide_px / kLines;
  const glm::dvec2 centre = on_lines(walked, middle.in_grid);
  const glm::dvec2 low{std::floor(centre.x) - 0.5 * kLines, std::floor(centre.y) - 2};
  const Panel plan{kLeft_px, 770, kWide_px, 4.5 * kCell_px, low, low + glm::dvec2(kLines, 4.5)};
  const double bottom = low.y;
  out.begin_clip(plan);
  for (int k = 0; k <= kLines; ++k) {
    const double x = low.x + k;
    out.line(plan.at({x, bottom}), plan.at({x, bottom + 5}), {.stroke = "#7fb2d6", .width_px = 1.6});
    if (k <= 4)
      out.line(plan.at({low.x, bottom + k}), plan.at({low.x + kLines, bottom + k}), {.stroke = "#ccc"});
  }
  for (int k = -kLines; k <= 5; ++k)
    out.line(plan.at({low.x, bottom + k}), plan.at({low.x + kLines, bottom + k + kLines}), {.stroke = "#ccc"});
  for (int k = 0; k <= kLines; ++k) {
    for (int p = 0; p <= 4; ++p) out.circle(plan.at(low + glm::dvec2(k, p)), 2, {.fill = kSoilEdge});
  }
  out.line(plan.at(path.front()), plan.at(path.back()), {.stroke = kInk, .width_px = 1.6});
  for (std::size_t k = 0; k < path.size(); ++k)
    out.circle(plan.at(path[k]), 4, {.stroke = "#fff", .fill = colour_of(*edges[k])});
  out.end_clip();
  out.rectangle({plan.x_px, plan.y_px}, {plan.width_px, plan.height_px}, {.stroke = "#777"});
  out.text({14, 740}, "The middle of the path from above: posts and edges of the height grid", {.bold = true});
  out.text({14, 760}, std::string("Blue lines: ") + name_of(walked) +
                          ", two posts and an interpolation each; one edge between two of them");
}

}  // namespace

std::string draw_column(const Scene& scene, const std::string& file) {
  const Column c = make_column(scene);
  const auto on_line =
      std::find_if(c.edges.begin(), c.edges.end(), [](const EdgeCrossing& e) { return e.walked; });
  const LineFamily walked = on_line->family;
  int resolved = 0;
  for (const Row& row : c.rows) resolved += row.edge >= 0 ? 1 : 0;
  Drawing out(720, 966, "One column: edges crossed, floating horizon, rows resolved");
  draw_side(out, c);
  draw_slopes(out, c);
  draw_legend(out, name_of(walked));
  draw_plan(out, c, walked);
  out.write(file);
  return fixed(static_cast<double>(c.edges.size())) + " edges, walked by lines " + name_of(walked) + "; " +
         fixed(resolved) + " of " + fixed(kRows) + " rows resolved; the cast agrees in " + fixed(c.agreeing);
}

}  // namespace bench
