#include "vpe/warp/carry_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/warp/moved_pixels.h"

namespace vpe::warp {

namespace {

constexpr int kBandRows = 16;
constexpr int kBlockColumns = 64;
// Neighbours of which one is sky: each pixel takes the nearer one, as long as they are hardly farther apart than in the
// first image.
constexpr float kWidestSkyline_px = 1.125F;
constexpr float kFar_px = 1e6F;

float cross(const glm::vec2& a, const glm::vec2& b) { return a.x * b.y - a.y * b.x; }

float largest(const glm::vec2& v) { return std::max(std::abs(v.x), std::abs(v.y)); }

// Names half of a cell between four pixels of the first image: twice the index of the cell's upper left pixel, and 1 for
// the lower half.
using Half = std::int32_t;
constexpr Half kNothing = -1;
constexpr Half kHidden = -2;  // ground that reaches behind the new camera; it hides and shows nothing

// Holds what a pixel of the new image shows.
struct Hit {
  float inverse_depth = -1;
  Half half = kNothing;
};

// A corner of a triangle in the new image.
struct Corner {
  glm::vec2 xy{0, 0};
  float inverse_depth = 0;
};

// Returns the shares of the second and the third corner at a point.
glm::vec2 shares_at(const glm::vec2& point, const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
  const glm::vec2 ab = b - a;
  const glm::vec2 ac = c - a;
  const glm::vec2 p = point - a;
  return glm::vec2(cross(p, ac), cross(ab, p)) / cross(ab, ac);
}

glm::vec2 centre_of(int x, int y) { return {static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F}; }

// Draws triangles into a band of rows; the nearest one stays.
class Band {
 public:
  Band(int width, int first_row, int end_row)
      : width_(width),
        first_row_(first_row),
        end_row_(end_row),
        hits_(static_cast<std::size_t>(width) * static_cast<std::size_t>(end_row - first_row)) {}

  // Draws a triangle with its corners clockwise in the image. One that turns its back is not drawn: a side that faces
  // the camera lies before it.
  void draw(const Corner& a, const Corner& b, const Corner& c, Half half) {
    const int y0 = std::max(first_centre(std::min(std::min(a.xy.y, b.xy.y), c.xy.y)), first_row_);
    const int y1 = std::min(last_centre(std::max(std::max(a.xy.y, b.xy.y), c.xy.y)), end_row_ - 1);
    if (y0 > y1) return;
    const int x0 = std::max(first_centre(std::min(std::min(a.xy.x, b.xy.x), c.xy.x)), 0);
    const int x1 = std::min(last_centre(std::max(std::max(a.xy.x, b.xy.x), c.xy.x)), width_ - 1);
    if (x0 > x1) return;
    const glm::vec2 ab = b.xy - a.xy;
    const glm::vec2 ac = c.xy - a.xy;
    const float area = cross(ab, ac);
    if (!(area > 0)) return;
    const float per_area = 1 / area;
    const float edge = kEdge_px * (largest(ab) + largest(ac)) * per_area;
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const glm::vec2 p = centre_of(x, y) - a.xy;
        const float u = cross(p, ac) * per_area;
        const float v = cross(ab, p) * per_area;
        if (u < -edge || v < -edge || u + v > 1 + edge) continue;
        const float depth = std::max(
            a.inverse_depth + u * (b.inverse_depth - a.inverse_depth) + v * (c.inverse_depth - a.inverse_depth),
            0.0F);
        Hit& hit = hits_[static_cast<std::size_t>(y - first_row_) * static_cast<std::size_t>(width_) +
                         static_cast<std::size_t>(x)];
        if (depth > hit.inverse_depth) hit = {depth, half};
      }
    }
  }

  const Hit& at(int x, int y) const {
    return hits_[static_cast<std::size_t>(y - first_row_) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(x)];
  }

 private:
  // Triangles are wider by this, so that rounding leaves no crack between them.
  static constexpr float kEdge_px = 1.0F / 256;
  static int floor_of(float position) {
    const float clamped = std::clamp(position, -kFar_px, kFar_px);
    const auto cut = static_cast<int>(clamped);
    return cut - (clamped < static_cast<float>(cut) ? 1 : 0);
  }
  static int first_centre(float position) { return floor_of(position + (0.5F - kEdge_px)); }
  static int last_centre(float position) { return floor_of(position - (0.5F - kEdge_px)); }

  int width_;
  int first_row_;
  int end_row_;
  std::vector<Hit> hits_;
};

// Corners of a cell's halves: clockwise, the first one opposite to the diagonal.
constexpr std::array<std::array<glm::ivec2, 3>, 2> kCorners{
    {{{{0, 0}, {1, 0}, {0, 1}}}, {{{1, 1}, {0, 1}, {1, 0}}}}};

// Carries an image.
class CellCarrier {
 public:
  CellCarrier(const core::View& from, const core::Frame& frame, const core::View& to,
              const CarryOptions& options, base::ThreadPool& pool, MovedPixels& pixels)
      : motion_(from, to), frame_(frame), options_(options), pixels_(pixels) {
    pixels.move(motion_, frame, pool);
    blocks_ = (pixels_.width - 1 + kBlockColumns - 1) / kBlockColumns;
    const auto rows = static_cast<std::size_t>(pixels_.height - 1);
    rows_.resize(static_cast<std::size_t>(blocks_) * rows);
    pool.run(rows, [&](std::size_t y) { find_rows(static_cast<int>(y)); });
  }

  // Fills the rows [first, end) of an image, and returns the largest bound of what it adds.
  float fill(int first, int end, CarriedImage& into) const;

 private:
  // Rows of the new image that a block of cells reaches.
  struct Rows {
    float low = 0;
    float high = 0;
  };
  using Corners = std::array<std::size_t, 3>;
  Corners corners_of(Half half) const;
  void find_rows(int y);
  void draw_clipped(int x, int y, int half, Band& band) const;
  float show(const Hit& hit, int x, int y, std::size_t out, CarriedImage& into) const;
  void draw_block(int first_x, int end_x, int y, Band& band) const;
  float clear_m(const Hit& hit, int x, int y) const;

  Motion motion_;
  const core::Frame& frame_;
  const CarryOptions& options_;
  const MovedPixels& pixels_;
  int blocks_ = 0;
  std::vector<Rows> rows_;
};

CellCarrier::Corners CellCarrier::corners_of(Half half) const {
  const int cell = half / 2;
  Corners at{};
  for (std::size_t n = 0; n < 3; ++n) {
    const glm::ivec2& corner = kCorners[static_cast<std::size_t>(half % 2)][n];
    at[n] = static_cast<std::size_t>(cell + corner.y * pixels_.width + corner.x);
  }
  return at;
}

void CellCarrier::find_rows(int y) {
  for (int block = 0; block < blocks_; ++block) {
    const int begin = block * kBlockColumns;
    const int end = std::min(begin + kBlockColumns, pixels_.width - 1);
    Rows rows{kFar_px, -kFar_px};
    bool is_whole = true;
    for (int row = y; row <= y + 1; ++row) {
      for (int x = begin; x <= end; ++x) {
        const float at = pixels_.y_px[pixels_.index(x, row)];
        is_whole = is_whole && at == at;
        rows.low = std::min(rows.low, at);
        rows.high = std::max(rows.high, at);
      }
    }
    if (!is_whole) rows = {-kFar_px, kFar_px};
    rows_[static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks_) + static_cast<std::size_t>(block)] =
        rows;
  }
}

void CellCarrier::draw_block(int first_x, int end_x, int y, Band& band) const {
  const auto corner = [&](std::size_t n) {
    return Corner{{pixels_.x_px[n], pixels_.y_px[n]}, pixels_.inverse_depth[n]};
  };
  std::size_t upper = pixels_.index(first_x, y);
  std::size_t lower = pixels_.index(first_x, y + 1);
  Corner a = corner(upper);
  Corner c = corner(lower);
  for (int x = first_x; x < end_x; ++x) {
    const Half half = 2 * static_cast<Half>(upper);
    const Corner b = corner(++upper);
    const Corner d = corner(++lower);
    const float sum = a.xy.x + b.xy.x + c.xy.x + d.xy.x;
    if (sum == sum) {  // all are ahead
      band.draw(a, b, c, half);
      band.draw(d, c, b, half + 1);
    } else {
      draw_clipped(x, y, 0, band);
      draw_clipped(x, y, 1, band);
    }
    a = b;
    c = d;
  }
}

// Draws half of a cell that may reach behind the new camera: what lies ahead hides, and shows nothing.
void CellCarrier::draw_clipped(int x, int y, int half, Band& band) const {
  struct Point {
    glm::vec3 point{};
    float nearness = 0;
  };
  std::array<Point, 3> in;
  for (std::size_t n = 0; n < 3; ++n) {
    const glm::ivec2& corner = kCorners[static_cast<std::size_t>(half)][n];
    const float range = frame_.range_m[pixels_.index(x + corner.x, y + corner.y)];
    if (!(range > 0)) return;
    in[n].nearness = motion_.focal() * motion_.lengths().at(x + corner.x, y + corner.y) / range;
    in[n].point = motion_.moved(motion_.ray(x + corner.x, y + corner.y), in[n].nearness);
    if (!std::isfinite(in[n].nearness)) return;
  }
  std::array<Corner, 4> out;
  std::size_t count = 0;
  const auto add = [&](const Point& p) { out[count++] = {motion_.place(p.point), p.nearness / p.point.z}; };
  for (std::size_t n = 0; n < 3; ++n) {
    const Point& p = in[n];
    const Point& next = in[(n + 1) % 3];
    const bool is_ahead = motion_.is_ahead(p.point);
    if (is_ahead) add(p);
    if (is_ahead == motion_.is_ahead(next.point)) continue;
    const float at_z = Motion::kLeastForward * motion_.focal();
    const float share = (at_z - p.point.z) / (next.point.z - p.point.z);
    Point cut{p.point + share * (next.point - p.point), p.nearness + share * (next.nearness - p.nearness)};
    cut.point.z = at_z;
    add(cut);
  }
  for (std::size_t n = 2; n < count; ++n) band.draw(out[0], out[n - 1], out[n], kHidden);
}

std::uint8_t rounded(float value) { return static_cast<std::uint8_t>(value + 0.5F); }

// Writes a pixel if it can be carried, and returns the bound of what that adds.
float CellCarrier::show(const Hit& hit, int x, int y, std::size_t out, CarriedImage& into) const {
  const Corners at = corners_of(hit.half);
  const glm::vec2 a = pixels_.xy(at[0]);
  const glm::vec2 b = pixels_.xy(at[1]);
  const glm::vec2 c = pixels_.xy(at[2]);
  const auto is_sky_at = [&](std::size_t n) { return pixels_.inverse_depth[at[n]] == 0; };
  const bool is_skyline = is_sky_at(0) != is_sky_at(1) || is_sky_at(1) != is_sky_at(2);
  const auto widest = static_cast<float>(options_.gap_px);
  const float width = std::max(std::max(largest(b - a), largest(c - b)), largest(a - c));
  if (!(width <= (is_skyline ? std::min(kWidestSkyline_px, widest) : widest))) return 0;
  float parted_px = 0;
  if (!is_skyline && !is_sky_at(0)) {
    const glm::vec2 pa = pixels_.parallax(at[0]);
    const glm::vec2 pb = pixels_.parallax(at[1]);
    const glm::vec2 pc = pixels_.parallax(at[2]);
    parted_px = std::max(std::max(largest(pb - pa), largest(pc - pb)), largest(pa - pc));
    if (parted_px > std::min(options_.most_added_px, widest - 1 + static_cast<float>(kCarriedPosition_px)))
      return 0;
  }
  const glm::vec2 centre = centre_of(x, y);
  const glm::vec2 second = glm::clamp(shares_at(centre, a, b, c), 0.0F, 1.0F);
  std::array<float, 3> share{std::max(1 - second.x - second.y, 0.0F), second.x, second.y};
  const std::size_t nearest = share[0] >= share[1]   ? (share[0] >= share[2] ? 0U : 2U)
                              : share[1] >= share[2] ? 1U
                                                     : 2U;
  const bool is_sky = is_sky_at(nearest) && (is_skyline || is_sky_at(0));
  const float inverse_depth = is_skyline ? pixels_.inverse_depth[at[nearest]] : hit.inverse_depth;
  into.origin[out] = is_sky                                              ? Origin::kSky
                     : largest(pixels_.xy(at[nearest]) - centre) <= 0.5F ? Origin::kCarried
                                                                         : Origin::kBetween;
  into.range_m[out] = is_sky ? core::kSkyRange : motion_.new_lengths().at(x, y) / inverse_depth;
  if (into.colour.empty()) return parted_px;
  if (is_skyline || !options_.filters) {
    into.colour[out] = frame_.colour[at[nearest]];
    return parted_px;
  }
  const base::Rgb& ca = frame_.colour[at[0]];
  const base::Rgb& cb = frame_.colour[at[1]];
  const base::Rgb& cc = frame_.colour[at[2]];
  const float whole = 1 / (share[0] + share[1] + share[2]);
  const auto mix = [&](std::uint8_t va, std::uint8_t vb, std::uint8_t vc) {
    return rounded(whole * (share[0] * static_cast<float>(va) + share[1] * static_cast<float>(vb) +
                            share[2] * static_cast<float>(vc)));
  };
  into.colour[out] = {mix(ca.r, cb.r, cc.r), mix(ca.g, cb.g, cc.g), mix(ca.b, cb.b, cc.b)};
  return parted_px;
}

// Returns a range before which the ray of a pixel meets nothing: that of the nearest corner of the triangle there.
float CellCarrier::clear_m(const Hit& hit, int x, int y) const {
  float nearest = 0;
  for (const std::size_t n : corners_of(hit.half)) nearest = std::max(nearest, pixels_.inverse_depth[n]);
  return nearest > 0 ? motion_.new_lengths().at(x, y) / nearest : 0;
}

float CellCarrier::fill(int first, int end, CarriedImage& into) const {
  Band band(into.width, first, end);
  for (int y = 0; y + 1 < pixels_.height; ++y) {
    for (int block = 0; block < blocks_; ++block) {
      const Rows& rows = rows_[static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks_) +
                               static_cast<std::size_t>(block)];
      if (rows.high < static_cast<float>(first) || rows.low > static_cast<float>(end)) continue;
      const int begin = block * kBlockColumns;
      draw_block(begin, std::min(begin + kBlockColumns, pixels_.width - 1), y, band);
    }
  }
  float added = 0;
  const bool checks_entry = motion_.moves();
  for (int y = first; y < end; ++y) {
    for (int x = 0; x < into.width; ++x) {
      const std::size_t out =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(into.width) + static_cast<std::size_t>(x);
      into.origin[out] = Origin::kOpen;
      const Hit& hit = band.at(x, y);
      const bool is_known = hit.half >= 0 && !(checks_entry && motion_.entry_m(x, y) > options_.nearest_m);
      if (is_known) added = std::max(added, show(hit, x, y, out, into));
      if (into.origin[out] != Origin::kOpen) continue;
      into.range_m[out] = is_known ? clear_m(hit, x, y) : 0;
      if (!into.colour.empty()) into.colour[out] = {};
    }
  }
  return added;
}

}  // namespace

void carry_cells(const core::View& from, const core::Frame& frame, const core::View& to,
                 const CarryOptions& options, base::ThreadPool& pool, MovedPixels& pixels, CarriedImage& into) {
  const CellCarrier carrier(from, frame, to, options, pool, pixels);
  const int bands = (into.height + kBandRows - 1) / kBandRows;
  std::vector<float> added(static_cast<std::size_t>(bands));
  pool.run(static_cast<std::size_t>(bands), [&](std::size_t n) {
    const int first = static_cast<int>(n) * kBandRows;
    added[n] = carrier.fill(first, std::min(first + kBandRows, into.height), into);
  });
  for (const float px : added) into.added_px = std::max(into.added_px, static_cast<double>(px));
  into.added_px += kCarriedPosition_px;
}

}  // namespace vpe::warp
