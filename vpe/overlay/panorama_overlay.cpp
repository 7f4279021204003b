#include "vpe/overlay/panorama_overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "vpe/overlay/compass_style.h"
#include "vpe/overlay/layer_functions.h"
#include "vpe/overlay/number_format.h"
#include "vpe/overlay/overlay.h"

namespace vpe::overlay {

namespace {

using core::CompassStrip;

struct Mark {
  CompassMark mark;
  glm::dvec2 at;
};

class PanoramaLayout {
 public:
  PanoramaLayout(const core::Overlays& overlays, const PanoramaScene& scene)
      : overlays_(overlays),
        scene_(scene),
        unit_(panorama_unit(scene)),
        ruler_(1, 1),
        size_(static_cast<double>(scene.width_px), static_cast<double>(scene.height_px)),
        sprites_(scene.width_px, scene.height_px,
                 scene.width_px == scene.full_circle_px ? scene.full_circle_px : 0),
        bottom_px_(size_.y) {}

  SpriteLayer run() {
    if (overlays_.compass != CompassStrip::kOff) compass();
    if (!overlays_.title.empty()) title();
    if (overlays_.legend) legend();
    if (!scene_.layers_legend.empty()) layers_legend();
    names();
    labels();
    // Figures along the horizon come last: they use the room that is left.
    for (const Mark& m : figures_) label(m);
    return std::move(sprites_);
  }

 private:
  double px(double at_720) const { return unit_ * at_720; }
  double line_px(double at_720) const { return std::max(px(at_720), 0.75 * at_720); }
  Font font(double at_720, bool bold = false) const { return {std::max(px(at_720), 0.7 * at_720), bold}; }

  std::vector<Mark> marks(double y) const {
    const double label_px = style_.label_px(ruler_, scene_.px_per_deg);
    const bool is_full_circle = scene_.width_px == scene_.full_circle_px;
    std::vector<Mark> placed;
    for (CompassMark& mark :
         compass_marks(scene_.left_azimuth_deg, scene_.span_deg, compass_steps(scene_.px_per_deg, label_px))) {
      // The end of a full circle is its beginning.
      constexpr double kSame_deg = 1e-9;
      if (is_full_circle && mark.azimuth_deg > scene_.left_azimuth_deg + 360 - kSame_deg) continue;
      const auto at = scene_.place(mark.azimuth_deg, 0);
      if (!at) continue;
      placed.push_back({std::move(mark), {at->x, y}});
    }
    return placed;
  }

  void compass() {
    style_.unit = unit_;
    const double height_px = std::ceil(style_.height_px());
    if (2 * height_px > size_.y) return;
    CompassStrip where = overlays_.compass;
    if (where == CompassStrip::kHorizon && (scene_.horizon_px < 0 || scene_.horizon_px + height_px > size_.y))
      where = CompassStrip::kBottom;
    style_.is_up = where == CompassStrip::kTop;
    double line_y = scene_.horizon_px;
    if (where != CompassStrip::kHorizon) {
      line_y = style_.is_up ? height_px : size_.y - height_px;
      const Box band{0, style_.is_up ? 0 : line_y, size_.x, style_.is_up ? line_y : size_.y};
      sprites_.fill(band, {0, 0, 0, static_cast<std::uint8_t>(std::lround(255 * kCompassBand.a))});
      if (style_.is_up) top_px_ = line_y;
      if (!style_.is_up) bottom_px_ = line_y;
    } else {
      // Whole pixels, thin enough not to hide the terrain.
      const double width_px = std::max(1.0, std::round(style_.line_px()));
      const double y = std::round(line_y - 0.5 * width_px);
      constexpr core::Rgba kDark{0, 0, 0, 110};
      constexpr core::Rgba kBright{255, 255, 255, 190};
      sprites_.fill({0, y - 1, size_.x, y + width_px + 1}, kDark);
      sprites_.fill({0, y, size_.x, y + width_px}, kBright);
    }
    for (Mark& m : marks(line_y)) {
      const Box tick = style_.tick_box(m.at, m.mark).grown(2 * style_.line_px());
      sprites_.add(tick, [style = style_, m](Canvas& canvas, glm::dvec2 corner) {
        style.draw_tick(canvas, m.at - corner, m.mark);
      });
      if (m.mark.rank == CompassRank::kWind) label(m);
      if (m.mark.rank == CompassRank::kFigure) figures_.push_back(std::move(m));
    }
    if (where == CompassStrip::kHorizon) {
      for (const Mark& m : figures_) figure_boxes_.push_back(style_.label_box(ruler_, m.at, m.mark));
      return;
    }
    for (const Mark& m : figures_) label(m);
    figures_.clear();
    sprites_.take({0, style_.is_up ? 0 : line_y, size_.x, style_.is_up ? line_y : size_.y});
  }

  void label(const Mark& m) {
    const Box box = style_.label_box(ruler_, m.at, m.mark);
    if (!sprites_.is_free(box)) return;
    sprites_.take(box.grown(px(3)));
    sprites_.add(halo(box), [style = style_, m](Canvas& canvas, glm::dvec2 corner) {
      style.draw_label(canvas, m.at - corner, m.mark);
    });
  }

  // Adds room for the outline and for letters that extend over their box.
  Box halo(const Box& box) const { return box.grown(2 + 0.2 * (box.bottom - box.top)); }

  // Draws title or legend as in an image of the size of `box`.
  void furniture(const Box& box, const std::function<void(LabelLayout&)>& draw) {
    const auto width = static_cast<int>(box.right - box.left);
    const auto height = static_cast<int>(box.bottom - box.top);
    Canvas canvas(width, height);
    LabelLayout layout(canvas, unit_);
    draw(layout);
    if (layout.taken().empty()) return;
    const Box& b = layout.taken().front();
    const Box taken{b.left + box.left, b.top + box.top, b.right + box.left, b.bottom + box.top};
    if (!sprites_.is_free({std::max(taken.left, 0.0), std::max(taken.top, 0.0), std::min(taken.right, size_.x),
                           std::min(taken.bottom, size_.y)}))
      return;
    sprites_.take(taken);
    sprites_.add(box, [unit = unit_, draw](Canvas& part, glm::dvec2) {
      LabelLayout again(part, unit);
      draw(again);
    });
  }

  void title() {
    // Wider titles are cut.
    constexpr double kMost_px = 12000;
    const Font letters = font(24, true);
    const double margin_px = px(16);
    const double width_px =
        std::min({size_.x, kMost_px, ruler_.measure(overlays_.title, letters).width + 2 * margin_px + 8});
    const double height_px = 2 * letters.size_px + 2 * margin_px;
    const double left = std::floor(0.5 * (size_.x - width_px));
    const Box box{left, top_px_, left + std::ceil(width_px),
                  std::min(bottom_px_, top_px_ + std::ceil(height_px))};
    if (box.bottom - box.top < 1) return;
    furniture(box, [text = overlays_.title](LabelLayout& layout) { draw_title(layout, text); });
  }

  void legend() {
    Scene scene;
    scene.appearance = scene_.appearance;
    scene.has_imagery = scene_.has_imagery;
    const double left = std::max(0.0, size_.x - std::ceil(std::max(px(240), 168.0)));
    const double top = std::max(top_px_, bottom_px_ - std::ceil(std::max(px(320), 224.0)));
    furniture({left, top, size_.x, bottom_px_}, [scene](LabelLayout& layout) { draw_legend(layout, scene); });
  }

  void layers_legend() {
    const auto legend = std::make_shared<const LayersLegend>(scene_.layers_legend, ruler_, unit_);
    const auto site = legend->find_site({0, top_px_, size_.x, bottom_px_},
                                        [this](const Box& box) { return sprites_.is_free(box); });
    if (!site) return;
    const Box box{site->corner.x, site->corner.y, site->corner.x + site->plan.size.width,
                  site->corner.y + site->plan.size.height};
    sprites_.take(box.grown(px(4)));
    sprites_.add(box, [legend, plan = site->plan](Canvas& canvas, glm::dvec2) {
      legend->draw(canvas, plan, {0, 0});
    });
  }

  void labels() {
    constexpr std::size_t kMostLayerLabels = 1000;
    std::size_t count = 0;
    for (const PanoramaLabel& own : scene_.labels) {
      const TextSize size = ruler_.measure(own.text, own.font);
      const double beside = 0.5 * size.width + own.radius_px + px(3);
      const double over = 0.5 * size.height + own.radius_px;
      for (const glm::dvec2& offset :
           {glm::dvec2{beside, 0}, glm::dvec2{-beside, 0}, glm::dvec2{0, -over}, glm::dvec2{0, over}}) {
        const glm::dvec2 centre = own.at_px + offset;
        const Box box = Box::about(centre, size);
        if (!sprites_.is_free(box)) continue;
        sprites_.take(box.grown(px(2)));
        sprites_.add(halo(box), [own, centre](Canvas& canvas, glm::dvec2 corner) {
          canvas.text(own.text, centre - corner, 0, {own.font, own.ink, {0, 0, 0, kShade.a * own.ink.a}});
        });
        if (++count == kMostLayerLabels) return;
        break;
      }
    }
  }

  void names() {
    constexpr double kSmallestName_px = 4;
    constexpr std::size_t kMost = 1000;
    std::vector<const PanoramaName*> sorted;
    for (const PanoramaName& name : scene_.names) sorted.push_back(&name);
    const auto apparent = [](const PanoramaName& name) {
      return name.diameter_m / std::max(name.distance_m, 1e-3);
    };
    std::stable_sort(sorted.begin(), sorted.end(), [&](const PanoramaName* a, const PanoramaName* b) {
      const double x = apparent(*a);
      const double y = apparent(*b);
      return x != y ? x > y : a->distance_m < b->distance_m;
    });
    const double px_per_rad = scene_.px_per_deg / mars::kRadiansPerDegree;
    std::size_t count = 0;
    for (const PanoramaName* name : sorted) {
      if (name->diameter_m > 0 && apparent(*name) * px_per_rad < px(kSmallestName_px)) continue;
      const auto at = scene_.place(name->azimuth_deg, name->elevation_deg);
      if (at && draw_name(*name, *at) && ++count == kMost) return;
    }
  }

  bool draw_name(const PanoramaName& name, glm::dvec2 at) {
    constexpr std::array<int, 10> kRows{0, 1, 2, 3, 4, 5, 6, 7, -1, -2};
    const Font letters = font(14);
    const double dot_px = line_px(2.4);
    const std::string text = overlays_.distances ? name_text(name.name, name.distance_m) : name.name;
    const TextSize size = ruler_.measure(text, letters);
    const Box dot = Box::about(at, {2 * dot_px, 2 * dot_px});
    if (!sprites_.is_free(dot)) return false;
    glm::dvec2 centre = at;
    if (scene_.width_px != scene_.full_circle_px) {
      const double half_px = 0.5 * size.width + px(2);
      if (2 * half_px > size_.x) return false;
      centre.x = std::clamp(centre.x, half_px, size_.x - half_px);
    }
    // Covers a figure of the compass only if there is no other room.
    for (const bool spares_figures : {true, false}) {
      for (const int row : kRows) {
        const double sign = row < 0 ? 1 : -1;
        const double away_px = 1.4 * letters.size_px + 1.5 * letters.size_px * (row < 0 ? -1 - row : row);
        centre.y = at.y + sign * (away_px + 0.5 * size.height);
        const Box box = Box::about(centre, size);
        const double half_px = 1.5 * line_px(1);
        const Box leader{at.x - half_px, sign < 0 ? box.bottom : dot.bottom, at.x + half_px,
                         sign < 0 ? dot.top : box.top};
        if (!sprites_.is_free(box) || !sprites_.is_free(leader)) continue;
        if (spares_figures && (meets_figure(box.grown(px(4))) || meets_figure(leader))) continue;
        sprites_.take(dot.grown(px(2)));
        sprites_.take(box.grown(px(4)));
        sprites_.take(leader);
        add_leader(at, leader, dot_px);
        sprites_.add(halo(box), [text, letters, centre](Canvas& canvas, glm::dvec2 corner) {
          canvas.text(text, centre - corner, 0, {letters, kWhite, kShade});
        });
        return true;
      }
    }
    return false;
  }

  bool meets_figure(const Box& box) const {
    const double period = scene_.width_px == scene_.full_circle_px ? size_.x : 0;
    return std::any_of(figure_boxes_.begin(), figure_boxes_.end(), [&](const Box& other) {
      const auto meets = [&](double shift) {
        return box.meets({other.left + shift, other.top, other.right + shift, other.bottom});
      };
      return meets(0) || meets(period) || meets(-period);
    });
  }

  void add_leader(glm::dvec2 at, const Box& leader, double dot_px) {
    const double line = line_px(1);
    const double radius = dot_px + line;
    const Box box{at.x - radius, std::min(leader.top, at.y - radius), at.x + radius,
                  std::max(leader.bottom, at.y + radius)};
    sprites_.add(box.grown(1), [at, leader, line, dot_px](Canvas& canvas, glm::dvec2 corner) {
      const std::array<glm::dvec2, 2> ends{glm::dvec2{at.x, leader.top} - corner,
                                           glm::dvec2{at.x, leader.bottom} - corner};
      canvas.line(ends, false, 3 * line, kShade);
      canvas.line(ends, false, line, kWhite);
      const auto disc = [&](double radius_px, const Ink& ink) {
        std::vector<glm::dvec2> circle;
        for (int n = 0; n < 16; ++n) {
          const mars::SinCos a = mars::sin_cos_deg(n * 22.5);
          circle.push_back(at - corner + glm::dvec2(a.cos, a.sin) * radius_px);
        }
        canvas.polygon(circle, ink);
      };
      disc(dot_px + line, kShade);
      disc(dot_px, kWhite);
    });
  }

  const core::Overlays& overlays_;
  const PanoramaScene& scene_;
  double unit_;
  Canvas ruler_;
  glm::dvec2 size_;
  SpriteLayer sprites_;
  CompassStyle style_;
  std::vector<Mark> figures_;  // with labels that are not placed yet
  std::vector<Box> figure_boxes_;
  double top_px_ = 0;
  double bottom_px_;
};

}  // namespace

double panorama_unit(const PanoramaScene& scene) {
  const double side_px = static_cast<double>(std::min(scene.width_px, scene.height_px));
  return std::min({side_px / 720.0, static_cast<double>(scene.full_circle_px) / 3200.0, kMaxPanoramaUnit});
}

std::string not_for_panoramas(const core::Overlays& overlays) {
  if (overlays.graticule) return "overlay.graticule: lines on the terrain are not drawn over panoramas";
  if (overlays.contours) return "overlay.contours: lines on the terrain are not drawn over panoramas";
  if (overlays.scale_bar)
    return "overlay.scale: a panorama has no centre with one scale; see overlay.distances";
  if (overlays.north_arrow) return "overlay.north: a panorama shows all directions; see overlay.compass";
  if (overlays.inspect == core::Inspect::kSynthetic)
    return "inspect=synthetic: a panorama is not tinted; --aux-layers synthetic tells it for each pixel";
  if (overlays.time_code != core::TimeCode::kOff) return "overlay.time: a panorama is not a frame of a flight";
  return {};
}

SpriteLayer lay_out_panorama(const core::Overlays& overlays, const PanoramaScene& scene) {
  return PanoramaLayout(overlays, scene).run();
}

}  // namespace vpe::overlay
