// Title, time, scale bar and north arrow.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/base/nice_ticks.h"
#include "vpe/overlay/layer_functions.h"
#include "vpe/overlay/number_format.h"

namespace vpe::overlay {

namespace {

// Draws a line of text in the middle of the image's width. Text that is too long gets smaller letters, then is
// cut.
void draw_middle(LabelLayout& layout, std::string text, Font font, bool at_top) {
  Canvas& canvas = layout.canvas();
  const double most_px = canvas.width() - 2 * layout.margin_px();
  TextSize size = canvas.measure(text, font);
  if (size.width > most_px) {
    font.size_px *= std::max(0.6, most_px / size.width);
    size = canvas.measure(text, font);
  }
  const std::string whole = printable_utf8(text);
  std::size_t kept = whole.size();
  while (size.width > most_px && kept > 0) {
    // One large step by proportion, then letter by letter: measuring is slow.
    kept = std::min(kept - 1, static_cast<std::size_t>(1.2 * most_px / size.width * static_cast<double>(kept)));
    while (kept > 0 && (static_cast<unsigned char>(whole[kept]) & 0xc0U) == 0x80U) --kept;
    text = whole.substr(0, kept) + "\u2026";
    size = canvas.measure(text, font);
  }
  const double y = at_top ? layout.area().top + layout.margin_px() + 0.5 * size.height
                          : layout.area().bottom - layout.margin_px() - 0.5 * size.height;
  const glm::dvec2 centre(0.5 * canvas.width(), y);
  const Box box = Box::about(centre, size);
  if (!layout.is_free(box)) return;
  layout.take(box.grown(layout.px(4)));
  canvas.clear(centre, size, 0);
  layout.label(text, centre, font);
}

// Holds the point that the image's centre shows, or the camera if it shows sky.
struct Centre {
  glm::dvec3 point_m;
  glm::dvec3 ray;
  bool is_ground;
};

Centre centre_of(const VisibleTerrain& terrain) {
  const int x = terrain.width() / 2;
  const int y = terrain.height() / 2;
  const core::View& view = terrain.scene().view;
  const core::SubRectangle part = core::drawn_part(view);
  const glm::dvec3 ray = core::pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5);
  if (terrain.is_ground(terrain.index(x, y))) return {terrain.point(x, y), ray, true};
  return {view.camera.position_m, ray, false};
}

}  // namespace

void draw_title(LabelLayout& layout, const std::string& title) {
  draw_middle(layout, title, layout.font(24, true), true);
}

void draw_time(LabelLayout& layout, double time_s) {
  draw_middle(layout, time_text(time_s), layout.font(18), false);
}

void draw_solar_time(LabelLayout& layout, const SolarTime& solar) {
  draw_middle(layout, solar_time_text(solar.true_time_h, solar.solar_longitude_deg), layout.font(18), false);
}

void draw_scale_bar(LabelLayout& layout, const VisibleTerrain& terrain) {
  Canvas& canvas = layout.canvas();
  const Centre centre = centre_of(terrain);
  if (!centre.is_ground) return;
  const core::View& view = terrain.scene().view;
  const core::SubRectangle part = core::drawn_part(view);
  const int column = terrain.width() / 2;
  const int row = terrain.height() / 2;
  const double x = part.x + column + 0.5;
  const double y = part.y + row + 0.5;
  const glm::dvec3 across = core::pixel_ray(view, x + 0.5, y) - core::pixel_ray(view, x - 0.5, y);
  const double m_per_px = glm::length(centre.point_m - view.camera.position_m) * glm::length(across);
  const double length_m = base::nice_step_below(0.22 * canvas.width() * m_per_px);
  const double length_px = length_m / m_per_px;

  const Font font = layout.font(16);
  const std::string text = scale_length_text(length_m, length_m);
  const std::string where = "at the centre";
  const Font small = layout.font(13);
  const double text_px = std::max(canvas.measure(text, font).width, canvas.measure(where, small).width);
  const double bar_px = std::max(layout.px(6), 4.0);
  const double left = layout.margin_px() + std::max(0.0, 0.5 * (text_px - length_px));
  const double bottom = layout.area().bottom - layout.margin_px();
  const double row_px = canvas.measure(where, small).height;
  const double upper_px = canvas.measure(text, font).height;
  const double top = bottom - row_px - bar_px - upper_px - 2 * layout.px(2);
  const Box box{layout.margin_px() - layout.px(2), top, left + std::max(length_px, text_px), bottom};
  if (!layout.is_free(box)) return;
  layout.take(box.grown(layout.px(6)));
  canvas.clear({0.5 * (box.left + box.right), 0.5 * (box.top + box.bottom)},
               {box.right - box.left, box.bottom - box.top}, 0);
  const double bar_bottom = bottom - row_px - layout.px(2);
  const auto field = [&](double from, double to, double grow, const Ink& ink) {
    const double l = left + from * length_px - grow;
    const double r = left + to * length_px + grow;
    const double b = bar_bottom + grow;
    const double t = bar_bottom - bar_px - grow;
    const std::vector<glm::dvec2> corners{{l, t}, {r, t}, {r, b}, {l, b}};
    canvas.polygon(corners, ink);
  };
  const double outline = layout.line_px(1.3);
  field(0, 1, 2 * outline, {0, 0, 0, 0.8});
  field(0, 1, outline, kWhite);
  for (const double from : {0.25, 0.75}) field(from, from + 0.25, 0, {0, 0, 0, 1});
  const double middle = left + 0.5 * length_px;
  layout.label(text, {middle, top + 0.5 * upper_px}, font);
  layout.label(where, {middle, bottom - 0.5 * row_px}, small);
}

void draw_north_arrow(LabelLayout& layout, const VisibleTerrain& terrain) {
  constexpr double kLeastTilt = 0.5;  // sine of 30 degrees
  constexpr double kPole = 1e-7;
  const Centre centre = centre_of(terrain);
  const mars::Axes& axes = terrain.scene().view.camera.axes;
  const glm::dvec3 up = glm::normalize(centre.point_m);
  if (std::hypot(up.x, up.y) < kPole) return;
  const mars::LocalFrame frame = mars::local_frame(mars::lon_lat(up));
  // Away from the camera along the ground, or upwards in the image if the camera looks straight down.
  glm::dvec3 away = centre.ray - up * glm::dot(centre.ray, up);
  if (glm::length(away) < 1e-6) away = axes.up - up * glm::dot(axes.up, up);
  away = glm::normalize(away);
  const glm::dvec3 across = glm::cross(away, up);
  const double tilt = std::max(kLeastTilt, -glm::dot(centre.ray, up));
  // `across` is perpendicular to the line of sight: the image shows it in full length, rotated by the roll.
  const glm::dvec2 roll = glm::normalize(glm::dvec2(glm::dot(across, axes.right), glm::dot(across, axes.up)));
  const double radius_px = std::max(layout.px(30), 15.0);
  const auto on_disc = [&](glm::dvec2 east_north) {
    const glm::dvec3 v = frame.east * east_north.x + frame.north * east_north.y;
    const glm::dvec2 flat(glm::dot(v, across), glm::dot(v, away) * tilt);
    // The image's y runs down.
    return glm::dvec2(flat.x * roll.x - flat.y * roll.y, -(flat.x * roll.y + flat.y * roll.x)) * radius_px;
  };
  const Font font = layout.font(18, true);
  const double letter_px = layout.canvas().measure("N", font).height;
  const double half_px = radius_px + letter_px + layout.px(2);
  const glm::dvec2 middle(layout.area().right - layout.margin_px() - half_px,
                          layout.area().top + layout.margin_px() + half_px);
  const Box box = Box::about(middle, {2 * half_px, 2 * half_px});
  if (!layout.is_free(box)) return;
  layout.take(box);
  std::vector<glm::dvec2> circle;
  for (int n = 0; n <= 48; ++n) {
    const mars::SinCos a = mars::sin_cos_deg(n * 7.5);
    circle.push_back(middle + on_disc({a.sin, a.cos}));
  }
  layout.canvas().polygon(circle, {0, 0, 0, 0.25});
  layout.outlined(circle, layout.line_px(1.5), kWhite, kShade);
  const glm::dvec2 tip = middle + on_disc({0, 0.94});
  const glm::dvec2 tail = middle + on_disc({0, -0.5});
  const auto half = [&](double side, const Ink& ink) {
    const std::vector<glm::dvec2> corners{tip, middle + on_disc({0.5 * side, -0.8}), tail};
    layout.canvas().polygon(corners, ink);
    layout.canvas().line(corners, true, layout.line_px(1), {0, 0, 0, 1});
  };
  half(-1, kWhite);
  half(1, {0.75, 0.1, 0.05, 1});
  // The letter stands upright beyond the tip, even if the arrow is short.
  const glm::dvec2 north = on_disc({0, 1});
  const double length = glm::length(north);
  layout.label("N", middle + north / length * (length + 0.5 * letter_px), font);
}

}  // namespace vpe::overlay
