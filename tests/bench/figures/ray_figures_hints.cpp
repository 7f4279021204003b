// Figure: how a pixel between two samples of columns finds its own range, and the retrace from the camera.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "tests/bench/figures/ray_figures.h"
#include "tests/bench/figures/ray_figures_samples.h"

namespace bench {

namespace {

namespace core = vpe::core;

constexpr CameraSpec kCamera{
    .north_m = 1600, .above_ground_m = 260, .yaw_deg = 72, .pitch_deg = -8, .roll_deg = 6};
constexpr int kWidth = 40;
constexpr int kHeight = 30;
constexpr double kFov_deg = 60;
// The pixel that is refined in the figure, and the one that is cast again from the camera.
constexpr int kRefined[] = {29, 16};
constexpr double kRoundsRise = 3;
constexpr double kRetraceRise = 5;
constexpr int kRetraced[] = {26, 10};

// Describes a place of the pixel's ray in one round of the refinement.
struct Round {
  double range_m = 0;
  glm::dvec3 ground_m{0, 0, 0};  // the facet above or below the place
  glm::dvec3 normal{0, 0, 1};
};

// Returns the inverse range between the hints: on one facet it changes almost linearly from sample to sample.
double inverse_estimate(const HintedPixel& pixel) {
  return 1 / pixel.hint_m[0] + pixel.share * (1 / pixel.hint_m[1] - 1 / pixel.hint_m[0]);
}

// Returns the ranges at which the ray meets the facet at its estimate, then the facet at that place, until the
// facet stays the same: the rounds of refine_row(), in double.
std::vector<Round> rounds_of(const paging::Surface& surface, const glm::dvec3& camera_m, const glm::dvec3& ray,
                             const HintedPixel& pixel) {
  std::vector<Round> rounds;
  double t = 1 / inverse_estimate(pixel);
  for (int n = 0; n < 8; ++n) {
    const glm::dvec3 place = camera_m + t * ray;
    const paging::SurfacePoint at = surface.at(place);
    const glm::dvec3 ground = at.radius_m * glm::normalize(place);
    const bool same = !rounds.empty() && glm::dot(at.normal, rounds.back().normal) > 1 - 1e-13;
    rounds.push_back({t, ground, at.normal});
    if (same) return rounds;
    const double fall = glm::dot(at.normal, ray);
    if (!(fall < 0)) return {};
    t = glm::dot(at.normal, ground - camera_m) / fall;
  }
  return {};
}

const HintedPixel& pixel_at(const std::vector<HintedPixel>& pixels, const int (&xy)[2]) {
  for (const HintedPixel& pixel : pixels) {
    if (pixel.x == xy[0] && pixel.y == xy[1]) return pixel;
  }
  throw std::runtime_error("a pixel of the figure of hints is not in the sector above V");
}

glm::dvec3 ray_of(const core::View& view, const glm::dvec2& at) { return core::pixel_ray(view, at.x, at.y); }
glm::dvec2 centre_of(const HintedPixel& pixel) { return {pixel.x + 0.5, pixel.y + 0.5}; }

// Draws the pixel in the image, with the lines of its two columns.
void draw_pixel(Drawing& out, const core::View& view, const HintedPixel& pixel) {
  constexpr double kShown_px = 5.6;
  const Panel image{14, 62, 240, 150, {0, 0}, {1, 1}};
  const double cell = image.width_px / kShown_px;
  const glm::dvec2 middle{image.x_px + 0.5 * image.width_px, image.y_px + 0.5 * image.height_px};
  const auto at = [&](const glm::dvec2& position) { return middle + cell * (position - centre_of(pixel)); };
  out.begin_clip(image);
  out.rectangle(at({pixel.x, pixel.y}), {cell, cell}, {.fill = "#cfe3f3"});
  for (int k = -3; k <= 4; ++k) {
    out.line(at({pixel.x + k, pixel.y - 3}), at({pixel.x + k, pixel.y + 4}), {.stroke = "#ccc"});
    out.line(at({pixel.x - 3, pixel.y + k}), at({pixel.x + 4, pixel.y + k}), {.stroke = "#ccc"});
  }
  // Columns are images of vertical lines: towards the point below the camera.
  const glm::dvec3 camera = view.camera.position_m;
  for (const glm::dvec2& sample : pixel.sample) {
    const glm::dvec2 along = glm::normalize(
        core::project(view, camera + 1e3 * ray_of(view, sample) - glm::normalize(camera)).xy - sample);
    out.line(at(sample - 5.0 * along), at(sample + 5.0 * along), {.stroke = kGreen, .width_px = 1.5});
  }
  for (int side = 0; side < 2; ++side) {
    const glm::dvec2 dot = at(pixel.sample[side]);
    out.circle(dot, 5, {.stroke = "#fff", .fill = kGreen});
    out.text(dot + glm::dvec2(side == 0 ? -10 : 10, -12), fixed(pixel.hint_m[side], 1) + " m",
             {.anchor = side == 0 ? "end" : "start", .bold = true});
  }
  out.circle(at(centre_of(pixel)), 4, {.stroke = "#fff", .fill = kBlue});
  out.end_clip();
  out.rectangle({image.x_px, image.y_px}, {image.width_px, image.height_px}, {.stroke = "#777"});
  out.text({14, 52}, "1. In the image", {.bold = true});
  const glm::dvec2 corner{272, 74};
  const std::string lines[] = {
      "Green: images of two columns, " + fixed(pixel.sample[1].x - pixel.sample[0].x, 2) +
          " px apart here. Each",
      "has a sample in the pixel's row, whose range is a hint.",
      "Blue: the pixel and its own ray, which lies " + fixed(100 * pixel.share) + " % of the way",
      "from the left hint to the right one. In inverse ranges,",
      "that is an estimate of " + fixed(1 / inverse_estimate(pixel), 1) + " m.",
      "The ray is met with the facet at that place (2), then with",
      "the facet at the new place, until the facet stays the same."};
  for (int k = 0; k < 7; ++k) out.text(corner + glm::dvec2(0, 21 * k), lines[k]);
}

// Stretches a panel's heights about its middle.
void exaggerate(Panel& panel, double factor) {
  const double middle = 0.5 * (panel.low.y + panel.high.y);
  panel.low.y = middle + (panel.low.y - middle) / factor;
  panel.high.y = middle + (panel.high.y - middle) / factor;
}

void draw_rounds(Drawing& out, const Scene& scene, const core::View& view, const HintedPixel& pixel,
                 const std::vector<Round>& rounds) {
  const glm::dvec3 ray = ray_of(view, centre_of(pixel));
  const SidePlane plane(view, ray);
  const auto on_ray = [&](double range_m) { return plane.at(view.camera.position_m + range_m * ray); };
  double low = rounds[0].range_m;
  double high = low;
  for (const Round& round : rounds) {
    low = std::min(low, round.range_m);
    high = std::max(high, round.range_m);
  }
  const double width = 3.0 * (high - low);
  const glm::dvec2 middle = on_ray(0.5 * (low + high)) + glm::dvec2(0.15 * width, 0);
  Panel side = square_panel(14, 262, 692, 200, middle, width);
  exaggerate(side, kRoundsRise);
  out.begin_clip(side);
  draw_ground(out, side, ground_line(scene.surface(), plane, middle.x - 0.6 * width, middle.x + 0.6 * width));
  out.line(side.at({0, 0}), side.at(on_ray(rounds.back().range_m)), {.stroke = kBlue, .width_px = 1.8});
  out.line(side.at(on_ray(rounds.back().range_m)), side.at(on_ray(2 * high)),
           {.stroke = kBlue, .width_px = 1, .dashes = "3 4"});
  for (std::size_t k = 0; k + 1 < rounds.size(); ++k) {
    const glm::dvec2 place = side.at(on_ray(rounds[k].range_m));
    const glm::dvec2 below = side.at(plane.at(rounds[k].ground_m));
    out.line(place, below, {.stroke = kRed, .dashes = "2 3"});
    out.line(below, side.at(on_ray(rounds[k + 1].range_m)), {.stroke = kRed, .width_px = 1.6, .dashes = "7 4"});
  }
  const auto mark = [&](std::size_t k, const char* colour, const glm::dvec2& move, const std::string& text) {
    const glm::dvec2 place = side.at(on_ray(rounds[k].range_m));
    out.circle(place, 5, {.stroke = "#fff", .fill = colour});
    out.text(place + move, fixed(rounds[k].range_m, 1) + " m: " + text, {.halo = false});
  };
  mark(0, kRed, {12, 2}, "estimate from the hints");
  mark(1, kRed, {12, 2}, "met with the facet below the estimate");
  mark(rounds.size() - 1, kBlue, {16, -31}, "met with the facet there");
  out.scale_bar(side, {side.x_px + 12, side.y_px + side.height_px - 14});
  out.end_clip();
  out.rectangle({side.x_px, side.y_px}, {side.width_px, side.height_px}, {.stroke = "#777"});
  out.text({14, 252}, "2. The pixel's ray and the facets, from the side (heights x " + fixed(kRoundsRise) + ")",
           {.bold = true});
}

// Draws the pixel whose ray meets a ridge that neither sample met.
void draw_retrace(Drawing& out, const Scene& scene, const core::View& view, const HintedPixel& pixel) {
  const glm::dvec3 ray = ray_of(view, centre_of(pixel));
  const SidePlane plane(view, ray);
  const auto on_ray = [&](double range_m) { return plane.at(view.camera.position_m + range_m * ray); };
  const double near_m = pixel.near_m();
  const double begin_m = 0.86 * pixel.range_m;
  const double end_m = 1.08 * std::max(pixel.hint_m[0], pixel.hint_m[1]);
  const std::vector<glm::dvec2> ground = ground_line(scene.surface(), plane, begin_m, end_m);
  const double width = end_m - begin_m;
  const glm::dvec2 met_at = on_ray(pixel.range_m);
  Panel side = square_panel(64, 634, 642, 170, {begin_m + 0.5 * width, met_at.y + 6}, width);
  exaggerate(side, kRetraceRise);
  out.begin_clip(side);
  draw_ground(out, side, ground);
  for (int k = 0; k < 2; ++k) {
    const glm::dvec3 sample_ray = ray_of(view, pixel.sample[k]);
    const SidePlane own(view, sample_ray);
    std::vector<glm::dvec2> line;
    for (const glm::dvec2& corner : ground_line(scene.surface(), own, begin_m, end_m))
      line.push_back(side.at(corner));
    const char* const colour = k == 0 ? kGreen : kPink;
    out.path(line, {.stroke = colour, .width_px = 1.5});
    const glm::dvec2 place = side.at(own.at(view.camera.position_m + pixel.hint_m[k] * sample_ray));
    out.line(side.at({0, 0}), place, {.stroke = colour, .width_px = 0.8, .dashes = "4 4"});
    out.circle(place, 5, {.stroke = "#fff", .fill = colour});
  }
  const glm::dvec2 met = side.at(met_at);
  out.line(side.at({0, 0}), met, {.stroke = kBlue, .width_px = 1.8});
  out.line(side.at(on_ray((1 - kApart) * near_m)), side.at(on_ray((1 + kApart) * near_m)),
           {.stroke = kRed, .width_px = 4});
  out.circle(met, 5, {.stroke = "#fff", .fill = kBlue});
  out.end_clip();
  out.axes(side, "horizontal distance from the camera, m", "height from the camera, m", 8, 5);
  out.text({14, 492}, "3. Another pixel, with a ridge before its hints (heights x " + fixed(kRetraceRise) + ")",
           {.bold = true});
  const std::string share = fixed(100 * kApart);
  const std::pair<const char*, std::string> lines[] = {
      {kSoilEdge, "ground below the pixel's own ray"},
      {kGreen, "ground below the left sample's line; its hint: " + fixed(pixel.hint_m[0], 1) + " m"},
      {kPink, "ground below the right sample's line; its hint: " + fixed(pixel.hint_m[1], 1) + " m"},
      {kRed, "cast " + share + " % before and behind the nearer hint: begins below ground, so"},
      {kBlue, "retrace: the pixel's ray is cast from the camera, and meets the ridge at " +
                  fixed(pixel.range_m, 1) + " m"}};
  double y = 514;
  for (const auto& [colour, text] : lines) {
    out.line({64, y - 4.5}, {90, y - 4.5}, {.stroke = colour, .width_px = 3});
    out.text({98, y}, text);
    y += 21;
  }
}

}  // namespace

std::string draw_hints(const Scene& scene, const std::string& file) {
  const core::View view = make_view(scene, kCamera, kWidth, kHeight, kFov_deg);
  const std::vector<HintedPixel> pixels = hinted_pixels(scene, view);
  const HintedPixel& refined = pixel_at(pixels, kRefined);
  const HintedPixel& retraced = pixel_at(pixels, kRetraced);
  const glm::dvec3 camera = view.camera.position_m;
  const std::vector<Round> rounds =
      rounds_of(scene.surface(), camera, ray_of(view, centre_of(refined)), refined);
  constexpr double kRounding = 1e-5;
  if (!refined.refined || rounds.size() < 3 ||
      std::abs(rounds.back().range_m - refined.range_m) > kRounding * refined.range_m)
    throw std::runtime_error("the refined pixel of the figure of hints is not refined in rounds");
  // The cast about the nearer hint begins below ground, so the ray is cast from the camera.
  const double begin_m = (1 - kApart) * retraced.near_m();
  const double about_m = scene.surface().cast(camera, ray_of(view, centre_of(retraced)), 1,
                                              {begin_m, (1 + kApart) * retraced.near_m()});
  if (retraced.refined || about_m != begin_m || !(retraced.range_m < begin_m))
    throw std::runtime_error("the retraced pixel of the figure of hints has no ridge before its hints");

  Drawing out(720, 852, "From the samples of columns to a pixel's own ray");
  draw_pixel(out, view, refined);
  draw_rounds(out, scene, view, refined, rounds);
  draw_retrace(out, scene, view, retraced);
  out.write(file);
  std::string steps;
  for (const Round& round : rounds) steps += (steps.empty() ? "" : " ") + fixed(round.range_m, 1);
  return "refined in rounds: " + steps + " m; retraced: hints " + fixed(retraced.hint_m[0], 1) + " and " +
         fixed(retraced.hint_m[1], 1) + " m, ridge at " + fixed(retraced.range_m, 1) + " m";
}

}  // namespace bench
