// Figure: rays of an image's rows, the places that they meet, and the footprint of one pixel.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "paging/surface/section.h"
#include "tests/bench/figures/ray_figures.h"

namespace bench {

namespace {

namespace core = vpe::core;

constexpr CameraSpec kCamera{.above_ground_m = 300, .pitch_deg = -14};
constexpr int kWidth = 31;
constexpr int kHeight = 24;
constexpr double kFov_deg = 32;
constexpr int kPixelRow = 11;  // whose footprint is measured

// Holds what the figure says about one pixel.
struct Footprint {
  double range_m = 0;
  double angle_rad = 0;    // between the pixel's upper and lower border
  double across_m = 0;     // of the pixel at that range, across the ray
  double on_ground_m = 0;  // along the facets between the borders
  double grazing_deg = 0;  // between ray and facet
  glm::dvec2 place{0, 0};
  glm::dvec2 border[2];  // where the lower and the upper border meet the ground
};

glm::dvec3 hit(const core::View& view, const glm::dvec3& ray, double range_m) {
  return view.camera.position_m + range_m * ray;
}

Footprint measure(const Scene& scene, const core::View& view, const SidePlane& plane, int row, double range_m) {
  const paging::Surface& surface = scene.surface();
  const double x = 0.5 * kWidth;
  Footprint f;
  f.range_m = range_m;
  const glm::dvec3 ray = core::pixel_ray(view, x, row + 0.5);
  const glm::dvec3 place = hit(view, ray, range_m);
  f.place = plane.at(place);
  glm::dvec3 border[2];
  glm::dvec3 rays[2];
  for (int k = 0; k < 2; ++k) {
    rays[k] = core::pixel_ray(view, x, row + 1 - k);
    border[k] = hit(view, rays[k], surface.cast(view.camera.position_m, rays[k]));
    f.border[k] = plane.at(border[k]);
  }
  f.angle_rad = mars::angle_between_rad(rays[0], rays[1]);
  f.across_m = f.angle_rad * range_m;
  f.on_ground_m = paging::section_figures(surface, border[0], border[1]).length_m;
  f.grazing_deg = std::asin(-glm::dot(ray, surface.at(place).normal)) / mars::kRadiansPerDegree;
  return f;
}

// Returns the ground between the pixel's borders.
std::vector<glm::dvec2> foot_line(const Panel& panel, const Footprint& f,
                                  const std::vector<glm::dvec2>& ground) {
  std::vector<glm::dvec2> foot{panel.at(f.border[0])};
  for (const glm::dvec2& corner : ground) {
    if (corner.x > f.border[0].x && corner.x < f.border[1].x) foot.push_back(panel.at(corner));
  }
  foot.push_back(panel.at(f.border[1]));
  return foot;
}

void draw_zoom(Drawing& out, const Footprint& f, const std::vector<glm::dvec2>& ground) {
  const Panel zoom = square_panel(14, 326, 400, 220, f.place + glm::dvec2(0, 0.03 * f.on_ground_m),
                                  1.75 * std::abs(f.border[1].x - f.border[0].x));
  out.begin_clip(zoom);
  draw_ground(out, zoom, ground);
  for (const glm::dvec2& corner : ground) out.circle(zoom.at(corner), 2.5, {.fill = kSoilEdge});
  for (const glm::dvec2& end : f.border)
    out.line(zoom.at({0, 0}), zoom.at(end), {.stroke = kRed, .width_px = 1.5, .dashes = "6 4"});
  out.line(zoom.at({0, 0}), zoom.at(f.place), {.stroke = kBlue, .width_px = 1.5});
  out.path(foot_line(zoom, f, ground), {.stroke = kRed, .width_px = 4});
  out.circle(zoom.at(f.place), 4.5, {.stroke = "#fff", .fill = kBlue});
  // The pixel's height at the hit, across the ray.
  const glm::dvec2 along = glm::normalize(f.place);
  const glm::dvec2 half = 0.5 * f.across_m * glm::dvec2(-along.y, along.x);
  out.bracket(zoom.at(f.place - half), zoom.at(f.place + half), {.stroke = kInk, .width_px = 1.5});
  out.text(zoom.at(f.place + half) + glm::dvec2(4, -8), fixed(f.across_m, 1) + " m");
  const glm::dvec2 below = zoom.at(0.5 * (f.border[0] + f.border[1]));
  out.text({below.x, zoom.y_px + zoom.height_px - 34}, fixed(f.on_ground_m, 1) + " m on the ground",
           {.anchor = "middle", .colour = "#a03c00", .bold = true, .halo = false});
  out.scale_bar(zoom, {zoom.x_px + 12, zoom.y_px + zoom.height_px - 12});
  out.end_clip();
  out.rectangle({zoom.x_px, zoom.y_px}, {zoom.width_px, zoom.height_px}, {.stroke = "#777"});
}

void draw_lengths(Drawing& out, const Footprint& f, double focal_px, double spacing_m) {
  const std::string lines[] = {
      "Row " + fixed(kPixelRow + 1) + " from the top. f = " + fixed(focal_px, 1) + " px.",
      "Range to the ground: " + fixed(f.range_m) + " m.",
      "The pixel is " + fixed(1e3 * f.angle_rad, 1) + " mrad high: across the",
      "ray, " + fixed(f.across_m, 1) + " m at that range.",
      "The ray meets its facet at " + fixed(f.grazing_deg, 1) + "\u00b0, so the",
      "pixel covers much more of the ground:",
      fixed(f.on_ground_m, 1) + " m along the facets.",
      "",
      "Dashed: the pixel's borders.",
      "Dots: edges of facets (posts " + fixed(spacing_m) + " m apart)."};
  for (int k = 0; k < 10; ++k) out.text({430, 344.0 + 21 * k}, lines[k]);
  out.text({14, 316}, "The ground that the pixel of one row covers", {.bold = true});
}

}  // namespace

std::string draw_footprint(const Scene& scene, const std::string& file) {
  const core::View view = make_view(scene, kCamera, kWidth, kHeight, kFov_deg);
  const std::vector<float> range_m = cast_image(scene, view);
  const auto range_of = [&](int row) {
    return static_cast<double>(range_m[static_cast<std::size_t>(row) * kWidth + kWidth / 2]);
  };
  // The middle column of pixels lies in a vertical plane, because the camera is not rolled.
  const auto ray_of = [&](int row) { return core::pixel_ray(view, 0.5 * kWidth, row + 0.5); };
  const SidePlane plane(view, ray_of(0));
  const Footprint f = measure(scene, view, plane, kPixelRow, range_of(kPixelRow));
  double farthest_m = 0;
  int hits = 0;
  double difference = 0;
  for (int row = 0; row < kHeight; ++row) {
    if (!std::isfinite(range_of(row))) continue;
    ++hits;
    farthest_m = std::max(farthest_m, plane.at(hit(view, ray_of(row), range_of(row))).x);
    const double single = scene.surface().cast(view.camera.position_m, ray_of(row));
    difference = std::max(difference, std::abs(range_of(row) / single - 1));
  }
  const double reach_m = 1.12 * farthest_m;
  const std::vector<glm::dvec2> ground = ground_line(scene.surface(), plane, 0, 1.02 * reach_m);
  double lowest_m = 0;
  for (const glm::dvec2& corner : ground) lowest_m = std::min(lowest_m, corner.y);

  Drawing out(720, 560, "The footprint of a pixel on the ground");
  Panel side = square_panel(14, 60, 692, 216, {0, 0}, reach_m * 1.04);
  const glm::dvec2 move{0.5 * reach_m * 1.04 - 0.03 * reach_m, lowest_m + 0.84 * side.high.y};
  side.low += move;
  side.high += move;
  out.begin_clip(side);
  draw_ground(out, side, ground);
  for (int row = 0; row < kHeight; ++row) {
    const bool ground_met = std::isfinite(range_of(row));
    const double end_m = ground_met ? range_of(row) : 2 * reach_m;
    const glm::dvec2 end = side.at(plane.at(hit(view, ray_of(row), end_m)));
    const bool chosen = row == kPixelRow;
    out.line(side.at({0, 0}), end, {.stroke = ground_met ? kBlue : "#b8b8b8", .width_px = chosen ? 2.0 : 0.8});
    if (ground_met) out.circle(end, chosen ? 4.5 : 2.5, {.fill = kBlue});
  }
  out.path(foot_line(side, f, ground), {.stroke = kRed, .width_px = 5});
  out.circle(side.at(f.place), 4.5, {.stroke = "#fff", .fill = kBlue});
  out.circle(side.at({0, 0}), 5, {.fill = kInk});
  out.text(side.at({0, 0}) + glm::dvec2(-4, -12),
           "camera, " + fixed(kCamera.above_ground_m) + " m above ground");
  out.scale_bar(side, {side.x_px + 500, side.y_px + side.height_px - 14});
  out.end_clip();
  out.rectangle({side.x_px, side.y_px}, {side.width_px, side.height_px}, {.stroke = "#777"});
  out.text({14, 50}, "The rays of the " + fixed(kHeight) +
                         " rows of an image, from the side (equal scales), and where they meet the ground");
  draw_zoom(out, f, ground);
  draw_lengths(out, f, core::focal_px(view), scene.spacing_m);
  out.write(file);
  return fixed(hits) + " of " + fixed(kHeight) + " rows meet ground, as single casts do within " +
         fixed(difference * 1e6, 2) + "e-6; row " + fixed(kPixelRow + 1) + ": range " + fixed(f.range_m) +
         " m, " + fixed(f.across_m, 1) + " m across the ray, " + fixed(f.on_ground_m, 1) + " m on the ground";
}

}  // namespace bench
