// Wireframes and markers show all visible edges and vertices of what is drawn, and nothing else.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "tests/gl/gl_fixture.h"
#include "vpe/core/appearance/palette.h"

namespace {

namespace core = vpe::core;

constexpr int kWidth = 240;
constexpr int kHeight = 160;
const mars::LonLat kPlace{12, 7};
const glm::dvec3 kHere = mars::direction(kPlace);

// A hill some 16 km north of the place, waves all around; ground behind the hill is hidden by it.
double hilly(const glm::dvec3& d) {
  const glm::dvec3 hill = mars::direction({12, 7.27});
  const double r = glm::length(d - hill) * mars::kMarsRadius_m / 3500;
  return 250 * std::sin(900 * d.y) * std::sin(800 * d.z) + 3000 * std::exp(-r * r);
}

struct Vertex {
  double height_m = 0;
  glm::dvec3 place_m{0, 0, 0};
  core::Projected at;
};

class Lines : public test_support::GlTest {
 protected:
  void SetUp() override {
    file_ = test_support::build_fake(
        dir_ / "p.vpe",
        test_support::FakeElevation(hilly, test_support::fine_around(kHere, 70000 / mars::kMarsRadius_m, 1500)),
        60000);
    draw_ = renderer(file_);
    surface_ = std::make_unique<paging::Surface>(file_, std::size_t{1} << 26);
    request_ = test_support::request_for({kPlace.lon_deg, kPlace.lat_deg, 2200, 0, -12, 0}, file_->radius_m(),
                                         kWidth, kHeight, 55);
    request_.settings.background = core::Background::kBlack;
    // So the facets of the reference surface are drawn, which are known.
    request_.settings.lod_tolerance_px = 0;
  }

  // Calls take(vertices, side) for each finest tile, rows of side * side.
  template <typename Take>
  void visit_tiles(const Take& take) const {
    for (std::size_t n = 0; n < file_->tree().size(); ++n) {
      const lod::TileInfo& info = file_->tree()[static_cast<lod::TileTree::Index>(n)];
      const mars::Cap cap = lod::bounding_cap(info.key);
      if (info.has_children || glm::length(cap.centre - kHere) > cap.radius_rad + 0.1) continue;
      const lod::Posts posts = file_->heights(info.key).posts;
      const lod::GridLines lines = lod::grid_lines(info.key, posts.intervals);
      std::vector<Vertex> vertices;
      for (int j = 0; j <= posts.intervals; ++j) {
        for (int i = 0; i <= posts.intervals; ++i) {
          const double height_m = posts.at(i, j);
          const glm::dvec3 p = mars::chart_direction(info.key.face, lines.u[static_cast<std::size_t>(i)],
                                                     lines.v[static_cast<std::size_t>(j)]) *
                               (file_->radius_m() + height_m);
          vertices.push_back({height_m, p, core::project(request_.view, p)});
        }
      }
      take(vertices, posts.side());
    }
  }

  // Returns the depth of the ground at each pixel along the camera's axis, which decides what OpenGL hides.
  std::vector<double> depths_m(const core::Frame& frame) const {
    std::vector<double> out;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double range_m = frame.range_m[out.size()];
        out.push_back(range_m * glm::dot(core::pixel_ray(request_.view, x + 0.5, y + 0.5),
                                         request_.view.camera.axes.forward));
      }
    }
    return out;
  }
  static double farthest_m(const std::vector<double>& depths, int x, int y, int reach) {
    double out = 0;
    for (int b = std::max(0, y - reach); b <= std::min(kHeight - 1, y + reach); ++b) {
      for (int a = std::max(0, x - reach); a <= std::min(kWidth - 1, x + reach); ++a)
        out = std::max(out, depths[static_cast<std::size_t>(b * kWidth + a)]);
    }
    return out;
  }
  // Casts a ray to the place itself.
  bool can_be_seen(const glm::dvec3& place_m) const {
    const glm::dvec3 way = place_m - request_.view.camera.position_m;
    const double distance_m = glm::length(way);
    return surface_->cast(request_.view.camera.position_m, way / distance_m) > distance_m * (1 - 1e-6);
  }
  // Returns true if no crest and no edge-on ground is so near that a pixel could show either side.
  static bool is_clear(const std::vector<double>& depths, const core::Projected& at, int reach) {
    const int x = static_cast<int>(at.xy.x), y = static_cast<int>(at.xy.y);
    for (int b = y - reach; b <= y + reach; ++b) {
      for (int a = x - reach; a <= x + reach; ++a) {
        const double off = depths[static_cast<std::size_t>(b * kWidth + a)] / at.depth_m;
        if (!(off > 0.9 && off < 1.1)) return false;
      }
    }
    return true;
  }
  static bool painted(const core::Frame& frame, int x, int y) {
    const vpe::base::Rgb c = frame.colour[static_cast<std::size_t>(y * kWidth + x)];
    return c.r + c.g + c.b > 0;
  }
  static bool inside(const glm::dvec2& p, double margin) {
    return p.x >= margin && p.y >= margin && p.x <= kWidth - margin && p.y <= kHeight - margin;
  }

  std::shared_ptr<const paging::PlanetFile> file_;
  std::unique_ptr<core::Renderer> draw_;
  std::unique_ptr<paging::Surface> surface_;
  core::DrawRequest request_;
};

// Lines and dots are a little nearer than the ground, so that they show through ground that is nearer by less.
constexpr double kThrough = 1.0021;

TEST_F(Lines, WireframesAreTheEdgesThatCanBeSeen) {
  request_.settings.mode = core::Mode::kWireframe;
  const core::Frame frame = draw_->draw(request_).frame;
  const std::vector<double> depths = depths_m(frame);
  // For each pixel, the distance (px) of the nearest visible edge, and of the nearest edge at all.
  std::vector<double> visible_px(frame.colour.size(), INFINITY), any_px = visible_px;
  int edges = 0, seen = 0, missed = 0, hidden = 0;
  const auto edge = [&](const Vertex& a, const Vertex& b) {
    if (a.at.behind || b.at.behind || a.at.depth_m < 200 || b.at.depth_m < 200) return;
    const glm::dvec2 low = glm::min(a.at.xy, b.at.xy) - 2.0, high = glm::max(a.at.xy, b.at.xy) + 2.0;
    if (high.x < 0 || high.y < 0 || low.x > kWidth || low.y > kHeight) return;
    ++edges;
    const glm::dvec2 along = b.at.xy - a.at.xy;
    const double size2 = glm::dot(along, along);
    const auto depth_at = [&](double s) { return 1 / ((1 - s) / a.at.depth_m + s / b.at.depth_m); };
    for (int y = std::max(0, static_cast<int>(low.y)); y < std::min<double>(kHeight, high.y); ++y) {
      for (int x = std::max(0, static_cast<int>(low.x)); x < std::min<double>(kWidth, high.x); ++x) {
        const auto at = static_cast<std::size_t>(y * kWidth + x);
        const glm::dvec2 here(x + 0.5, y + 0.5);
        const double s = size2 > 0 ? std::clamp(glm::dot(here - a.at.xy, along) / size2, 0.0, 1.0) : 0.0;
        const double off = glm::length(here - (a.at.xy + s * along));
        any_px[at] = std::min(any_px[at], off);
        if (off <= 1.5 && depth_at(s) <= kThrough * farthest_m(depths, x, y, 2))
          visible_px[at] = std::min(visible_px[at], off);
      }
    }
    for (const double s : {0.25, 0.5, 0.75}) {
      const core::Projected p = core::project(request_.view, glm::mix(a.place_m, b.place_m, s));
      if (!inside(p.xy, 2)) continue;
      if (!can_be_seen(glm::mix(a.place_m, b.place_m, s))) {
        ++hidden;
        continue;
      }
      if (!is_clear(depths, p, 1)) continue;
      ++seen;
      // Lines are continuous: one pixel is painted in each column of a flat line, in each row of a steep one.
      const int x = static_cast<int>(p.xy.x), y = static_cast<int>(p.xy.y);
      const bool is_flat = std::abs(along.x) > std::abs(along.y);
      bool hit = false;
      for (int off = -1; off <= 1; ++off)
        hit = hit || painted(frame, is_flat ? x : x + off, is_flat ? y + off : y);
      missed += hit ? 0 : 1;
    }
  };
  visit_tiles([&](const std::vector<Vertex>& v, int side) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const auto at = static_cast<std::size_t>(j * side + i);
        const auto row = static_cast<std::size_t>(side);
        if (i + 1 < side) edge(v[at], v[at + 1]);
        if (j + 1 < side) edge(v[at], v[at + row]);
        if (i + 1 < side && j + 1 < side) edge(v[at], v[at + row + 1]);
      }
    }
  });
  int lines = 0, astray = 0, through = 0, ground = 0, black = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto at = static_cast<std::size_t>(y * kWidth + x);
      const bool line = painted(frame, x, y);
      if (std::isfinite(frame.range_m[at])) {
        ++ground;
        black += line ? 0 : 1;
      }
      if (!line) continue;
      ++lines;
      astray += any_px[at] > 1.5 ? 1 : 0;
      through += visible_px[at] > 1.5 ? 1 : 0;
    }
  }
  std::printf(
      "%d pixels of lines: %d astray, %d hidden ones; %d edges, %d visible places, %d without a line, %d "
      "hidden places; %d of %d pixels of ground are between lines\n",
      lines, astray, through, edges, seen, missed, hidden, black, ground);
  EXPECT_EQ(astray, 0);
  EXPECT_EQ(through, 0);
  EXPECT_EQ(missed, 0);
  EXPECT_GT(seen, 1000);
  EXPECT_GT(hidden, 1000);
  EXPECT_GT(black, ground / 4);
}

TEST_F(Lines, MarkersAreTheVerticesThatCanBeSeenInTheirColours) {
  for (const double size_px : {3.0, 5.0}) {
    request_.settings.mode = core::Mode::kMarkers;
    request_.settings.marker_px = size_px;
    request_.settings.palette = "turbo";
    request_.settings.palette_low = -300;
    request_.settings.palette_high = 3000;
    const core::Frame frame = draw_->draw(request_).frame;
    const std::vector<double> depths = depths_m(frame);
    const core::ColourScale scale(request_.settings);
    enum : std::uint8_t { kNear = 1, kSeen = 2, kColour = 4 };
    std::vector<std::uint8_t> found(frame.colour.size());
    int seen = 0, missed = 0, hidden = 0;
    const double half = 0.5 * size_px;
    visit_tiles([&](const std::vector<Vertex>& vertices, int) {
      for (const Vertex& v : vertices) {
        if (v.at.behind || v.at.depth_m < 200 || !inside(v.at.xy, -half)) continue;
        const glm::dvec3 colour = scale(v.height_m);
        const auto low = glm::floor(v.at.xy - half - 0.5), high = glm::ceil(v.at.xy + half + 0.5);
        for (int y = std::max(0, static_cast<int>(low.y)); y < std::min<double>(kHeight, high.y); ++y) {
          for (int x = std::max(0, static_cast<int>(low.x)); x < std::min<double>(kWidth, high.x); ++x) {
            const glm::dvec2 off = glm::abs(glm::dvec2(x + 0.5, y + 0.5) - v.at.xy);
            if (std::max(off.x, off.y) > half + 0.5) continue;
            const auto at = static_cast<std::size_t>(y * kWidth + x);
            found[at] |= kNear;
            if (v.at.depth_m > kThrough * farthest_m(depths, x, y, static_cast<int>(half) + 1)) continue;
            found[at] |= kSeen;
            const vpe::base::Rgb c = frame.colour[at];
            const glm::dvec3 wrong = glm::abs(glm::dvec3(c.r, c.g, c.b) - colour);
            if (std::max({wrong.x, wrong.y, wrong.z}) <= 2) found[at] |= kColour;
          }
        }
        if (!inside(v.at.xy, half + 1)) continue;
        if (!can_be_seen(v.place_m)) {
          ++hidden;
          continue;
        }
        if (!is_clear(depths, v.at, static_cast<int>(half))) continue;
        ++seen;
        // The dot is whole; where another one covers it, that one is painted too.
        bool whole = true;
        for (int y = static_cast<int>(std::ceil(v.at.xy.y - half)); y + 0.5 < v.at.xy.y + half - 0.5; ++y) {
          for (int x = static_cast<int>(std::ceil(v.at.xy.x - half)); x + 0.5 < v.at.xy.x + half - 0.5; ++x)
            whole = whole && painted(frame, x, y);
        }
        missed += whole ? 0 : 1;
      }
    });
    int dots = 0, astray = 0, through = 0, discoloured = 0, ground = 0, black = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto at = static_cast<std::size_t>(y * kWidth + x);
        if (std::isfinite(frame.range_m[at])) {
          ++ground;
          black += painted(frame, x, y) ? 0 : 1;
        }
        if (!painted(frame, x, y)) continue;
        ++dots;
        astray += (found[at] & kNear) == 0 ? 1 : 0;
        through += (found[at] & kSeen) == 0 ? 1 : 0;
        discoloured += (found[at] & kColour) == 0 ? 1 : 0;
      }
    }
    std::printf(
        "markers of %.0f px: %d pixels, %d astray, %d hidden ones, %d of another colour; %d visible vertices, "
        "%d without a dot, %d hidden; %d of %d pixels of ground are between\n",
        size_px, dots, astray, through, discoloured, seen, missed, hidden, black, ground);
    EXPECT_EQ(astray, 0);
    EXPECT_EQ(through, 0);
    EXPECT_EQ(discoloured, 0);
    EXPECT_EQ(missed, 0);
    EXPECT_GT(seen, 80);
    EXPECT_GT(hidden, 300);
    EXPECT_GT(black, ground / 4);
  }
}

TEST_F(Lines, NoSkyShowsThroughTheGround) {
  request_.settings.background = core::Background::kSky;
  for (const auto mode : {core::Mode::kWireframe, core::Mode::kMarkers}) {
    request_.settings.mode = mode;
    request_.settings.colour = core::Colour::kNone;
    const core::Frame frame = draw_->draw(request_).frame;
    int ground = 0, wrong = 0, sky = 0;
    for (std::size_t n = 0; n < frame.colour.size(); ++n) {
      const vpe::base::Rgb c = frame.colour[n];
      const bool black = c == vpe::base::Rgb{0, 0, 0}, line = c == vpe::base::Rgb{242, 191, 140};
      const bool is_ground = std::isfinite(frame.range_m[n]);
      ground += is_ground ? 1 : 0;
      wrong += is_ground && !black && !line ? 1 : 0;
      sky += !is_ground && !black && !line ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0) << "of " << ground;
    EXPECT_GT(ground, 10000);
    EXPECT_GT(sky, 5000);
  }
}

}  // namespace
