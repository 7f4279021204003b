// Figure: the sectors of three images about the vanishing point of the vertical, and lines of their columns.
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "tests/bench/figures/ray_figures.h"
#include "vpe/voxel/columns/view_sector.h"

namespace bench {

namespace {

namespace core = vpe::core;
namespace voxel = vpe::voxel;

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr double kFov_deg = 60;
constexpr double kScale = 0.5;     // pixels of the figure for each pixel of an image
constexpr int kEvery = 40;         // lines are drawn
constexpr double kSpacing_px = 1;  // of lines, as SectorCaster has them

struct Image {
  const char* name;
  CameraSpec camera;
  glm::dvec2 corner;  // in the drawing
};
constexpr std::array<Image, 3> kImages{{
    {"level, V at infinity", {.above_ground_m = 500}, {24, 66}},
    {"pitch \u221250\u00b0", {.above_ground_m = 500, .pitch_deg = -50}, {376, 66}},
    {"pitch \u221260\u00b0, roll 30\u00b0",
     {.above_ground_m = 500, .pitch_deg = -60, .roll_deg = 30},
     {24, 412}},
}};

struct Side {
  const char* name;
  const char* line;
  const char* fill;
};
Side side_of(const voxel::ViewSector& sector) {
  if (sector.upright) {
    if (sector.forward) return {"below V", kGreen, "#d5f0e6"};
    return {"above V", kBlue, "#dcebf7"};
  }
  if (sector.forward) return {"right of V", kPink, "#f4e2ee"};
  return {"left of V", kRed, "#fbe5d6"};
}

// Draws one image.
class SectorImage {
 public:
  SectorImage(Drawing& out, const Scene& scene, const Image& image)
      : out_(out),
        image_(image),
        view_(make_view(scene, image.camera, kWidth, kHeight, kFov_deg)),
        up_(glm::normalize(view_.camera.position_m)),
        plan_(view_, up_, kSpacing_px) {
    // A point below the camera appears at V, or its opposite does; none does in a level image.
    constexpr double kDown_m = 1e3;
    const core::Projected nadir = core::project(view_, view_.camera.position_m - kDown_m * up_);
    constexpr double kLevel = 1e-9;
    if (!nadir.behind && nadir.depth_m > kLevel * kDown_m) vanishing_ = nadir.xy;
  }

  // Draws the image. Returns the number of lines between the diagonals, and of all lines.
  std::string draw() {
    const Panel frame{image_.corner.x, image_.corner.y, kScale * kWidth, kScale * kHeight, {0, 0}, {1, 1}};
    draw_extensions();
    out_.begin_clip(frame);
    out_.rectangle(image_.corner, {frame.width_px, frame.height_px}, {.fill = "#fff"});
    for (const voxel::ViewSector& sector : plan_.sectors()) fill(sector);
    for (const voxel::ViewSector& sector : plan_.sectors()) draw_lines(sector);
    out_.end_clip();
    out_.rectangle(image_.corner, {frame.width_px, frame.height_px}, {.stroke = kInk, .width_px = 1.2});
    for (const voxel::ViewSector& sector : plan_.sectors()) draw_reference(sector);
    if (vanishing_) {
      const glm::dvec2 v = at(*vanishing_);
      out_.circle(v, 4.5, {.stroke = "#fff", .fill = kInk});
      out_.text(v + glm::dvec2(9, 5), "V", {.bold = true});
    }
    int columns = 0;
    int lines = 0;
    for (const voxel::ViewSector& sector : plan_.sectors()) {
      lines += sector.lines;
      for (int k = 0; k < sector.lines; ++k) columns += between_diagonals(sector, k) ? 1 : 0;
    }
    const auto count = static_cast<int>(plan_.sectors().size());
    out_.text(image_.corner - glm::dvec2(0, 8), std::string(image_.name) + ": " + fixed(count) +
                                                    (count == 1 ? " sector, " : " sectors, ") + fixed(columns) +
                                                    " columns");
    return fixed(columns) + " of " + fixed(lines);
  }

 private:
  glm::dvec2 at(const glm::dvec2& pixel) const { return image_.corner + kScale * pixel; }

  // Returns the image position at step coordinate t of the line that crosses the reference at s.
  glm::dvec2 on_line(const voxel::ViewSector& sector, double s_reference, int step) const {
    const voxel::ViewSector::Map& map = sector.maps[static_cast<std::size_t>(step)];
    const double s = (s_reference - map.shift) / map.scale;
    const double t = sector.first_step + step + 0.5;
    return sector.upright ? glm::dvec2(s, t) : glm::dvec2(t, s);
  }

  // Fills the wedge of a sector; the image's clip cuts it.
  void fill(const voxel::ViewSector& sector) {
    const Style style{.fill = colours(sector).fill};
    if (!vanishing_) return out_.rectangle(image_.corner, {kScale * kWidth, kScale * kHeight}, style);
    constexpr double kFar_px = 2000;
    const double t = sector.forward ? kFar_px : -kFar_px;
    const glm::dvec2 left = sector.upright ? glm::dvec2(-t, t) : glm::dvec2(t, -t);
    out_.path({at(*vanishing_), at(*vanishing_ + left), at(*vanishing_ + glm::dvec2(t, t))}, style, true);
  }

  // Returns false for lines beyond the sector's diagonals: they serve pixels within a pixel or two of V.
  bool between_diagonals(const voxel::ViewSector& sector, int line) const {
    const double s = sector.first_line + sector.spacing * line;
    const voxel::SectorPlan::Side side =
        sector.upright ? plan_.side_of(s, sector.reference) : plan_.side_of(sector.reference, s);
    return side.upright == sector.upright && side.forward == sector.forward;
  }

  template <typename Draw>
  void visit_lines(const voxel::ViewSector& sector, Draw&& draw_line) {
    for (int k = kEvery / 2; k < sector.lines; k += kEvery) {
      const voxel::SectorLine line = plan_.line(sector, k);
      if (line.row_begin >= line.row_end || !between_diagonals(sector, k)) continue;
      // Rows count from the lowest slope, steps from the top or the left.
      const auto step = [&](int row) { return sector.rising ? row : sector.steps - 1 - row; };
      const double s = sector.first_line + sector.spacing * k;
      draw_line(on_line(sector, s, step(line.row_begin)), on_line(sector, s, step(line.row_end - 1)));
    }
  }

  // Returns the colours of a sector; those of a level image lie on no side of V.
  Side colours(const voxel::ViewSector& sector) const {
    return vanishing_ ? side_of(sector) : Side{"", "#555", "#eee"};
  }

  void draw_lines(const voxel::ViewSector& sector) {
    visit_lines(sector, [&](const glm::dvec2& a, const glm::dvec2& b) {
      out_.line(at(a), at(b), {.stroke = colours(sector).line});
    });
  }

  // Joins lines to V where it lies outside of the image.
  void draw_extensions() {
    if (!vanishing_) return;
    for (const voxel::ViewSector& sector : plan_.sectors()) {
      visit_lines(sector, [&](const glm::dvec2& a, const glm::dvec2& b) {
        const bool first = glm::length(a - *vanishing_) < glm::length(b - *vanishing_);
        out_.line(at(first ? a : b), at(*vanishing_), {.stroke = "#c8c8c8", .width_px = 0.7});
      });
    }
  }

  // Draws the row or column of the image at which lines are evenly spaced.
  void draw_reference(const voxel::ViewSector& sector) {
    const int step = sector.forward ? sector.steps - 1 : 0;
    int first = 0;
    int last = sector.lines - 1;
    while (first < last && !between_diagonals(sector, first)) ++first;
    while (first < last && !between_diagonals(sector, last)) --last;
    const glm::dvec2 low = on_line(sector, sector.first_line + sector.spacing * first, step);
    const glm::dvec2 high = on_line(sector, sector.first_line + sector.spacing * last, step);
    const glm::dvec2 limit(kWidth, kHeight);
    out_.line(at(glm::clamp(low, glm::dvec2(0), limit)), at(glm::clamp(high, glm::dvec2(0), limit)),
              {.stroke = colours(sector).line, .width_px = 4});
  }

  Drawing& out_;
  const Image& image_;
  core::View view_;
  glm::dvec3 up_;
  voxel::SectorPlan plan_;
  std::optional<glm::dvec2> vanishing_;
};

}  // namespace

std::string draw_sectors(const Scene& scene, const std::string& file) {
  Drawing out(720, 684, "Sectors of an image about V, the vanishing point of the vertical");
  std::string counts;
  for (const Image& image : kImages) {
    counts += (counts.empty() ? "" : ", ") + SectorImage(out, scene, image).draw();
  }
  const glm::dvec2 corner{376, 424};
  const char* const lines[] = {"Diagonals through V divide the image.",
                               "Each sector has lines through V, which are",
                               "images of vertical half-planes: columns.",
                               "Every 40th line is drawn. Left out and not counted:",
                               "lines beyond a diagonal, for the pixels next to V.",
                               "",
                               "Thick: the row or column of a sector farthest from V,",
                               "where lines are 1 px apart."};
  for (int k = 0; k < 8; ++k) out.text(corner + glm::dvec2(0, 20 * k), lines[k]);
  constexpr bool kBoth[] = {false, true};
  double y = corner.y + 180;
  for (const bool upright : kBoth) {
    for (const bool forward : kBoth) {
      voxel::ViewSector sector;
      sector.upright = upright;
      sector.forward = forward;
      const Side side = side_of(sector);
      out.rectangle({corner.x, y - 11}, {22, 13}, {.stroke = side.line, .width_px = 1.5, .fill = side.fill});
      out.text({corner.x + 30, y}, std::string(side.name) + (upright ? ": a sample in each row of pixels"
                                                                     : ": a sample in each column of pixels"));
      y += 21;
    }
  }
  out.write(file);
  return "lines between the diagonals, in images of " + fixed(kWidth) + " x " + fixed(kHeight) +
         " pixels: " + counts;
}

}  // namespace bench
