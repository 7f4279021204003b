#include "vpe/warp/carry_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "vpe/warp/block_kernel.h"
#include "vpe/warp/block_plan.h"
#include "vpe/warp/moved_pixels.h"
#include "vpe/warp/triangles.h"

namespace vpe::warp {

namespace {

constexpr int kBandRows = 16;
// Neighbours of which one is sky: each pixel takes the nearer one, as long as they are hardly farther apart than in the
// first image.
constexpr float kWidestSkyline_px = 1.125F;

// Corners of a cell's halves: clockwise, the first one opposite to the diagonal.
constexpr std::array<std::array<glm::ivec2, 3>, 2> kCorners{
    {{{{0, 0}, {1, 0}, {0, 1}}}, {{{1, 1}, {0, 1}, {1, 0}}}}};

// Carries an image.
class CellCarrier {
 public:
  CellCarrier(const core::View& from, const core::Frame& frame, const core::View& to,
              const CarryOptions& options, base::ThreadPool& pool, MovedPixels& pixels);

  // Fills the rows [first, end) of an image, and returns the largest bound of what its cells add.
  float fill(int first, int end, CarriedImage& into) const;
  double flat_added_px() const { return plan_.added_px(); }

 private:
  // A block that is carried cell by cell.
  struct RoughBlock {
    glm::ivec2 first{};  // pixels of the first image
    glm::ivec2 end{};    // cells end before
    float low = 0;       // rows of the new image that it reaches
    float high = 0;
  };
  using Corners = std::array<std::size_t, 3>;
  static const MovedPixels& taken(const Motion& motion, const core::Frame& frame, base::ThreadPool& pool,
                                  MovedPixels& pixels) {
    pixels.take(motion, frame, pool);
    return pixels;
  }
  Corners corners_of(Half half) const;
  void move_rough(MovedPixels& pixels, base::ThreadPool& pool);
  void find_rows(RoughBlock& block) const;
  void draw_clipped(int x, int y, int half, TriangleBand& band) const;
  void draw_cells(const RoughBlock& block, TriangleBand& band) const;
  Hits draw(int first, int end, int width) const;
  float show(Half half, float hit_inverse_depth, int x, int y, std::size_t out, CarriedImage& into) const;
  float clear_m(Half half, int x, int y) const;

  Motion motion_;
  const core::Frame& frame_;
  const CarryOptions& options_;
  const MovedPixels& pixels_;
  BlockPlan plan_;
  std::vector<RoughBlock> rough_;
};

CellCarrier::CellCarrier(const core::View& from, const core::Frame& frame, const core::View& to,
                         const CarryOptions& options, base::ThreadPool& pool, MovedPixels& pixels)
    : motion_(from, to),
      frame_(frame),
      options_(options),
      pixels_(taken(motion_, frame, pool, pixels)),
      plan_(motion_, pixels_, core::drawn_size(to), options, pool) {
  move_rough(pixels, pool);
}

void CellCarrier::move_rough(MovedPixels& pixels, base::ThreadPool& pool) {
  const glm::ivec2 cells(pixels.width - 1, pixels.height - 1);
  for (const BlockPlan::Row& row : plan_.rows())
    for (const glm::ivec2& first : row.rough)
      rough_.push_back({first, glm::min(first + BlockPlan::kSmall, cells), 0, 0});
  // Pixels by small blocks of their own; those of a block's last cells belong to its neighbours.
  const glm::ivec2 blocks =
      (glm::ivec2(pixels.width, pixels.height) + BlockPlan::kSmall - 1) / BlockPlan::kSmall;
  const auto index = [&](glm::ivec2 block) {
    return static_cast<std::size_t>(block.y) * static_cast<std::size_t>(blocks.x) +
           static_cast<std::size_t>(block.x);
  };
  std::vector<std::uint8_t> is_needed(static_cast<std::size_t>(blocks.x) * static_cast<std::size_t>(blocks.y));
  for (const RoughBlock& block : rough_)
    for (const int y : {block.first.y, block.end.y})
      for (const int x : {block.first.x, block.end.x})
        is_needed[index(glm::ivec2(x, y) / BlockPlan::kSmall)] = 1;
  pool.run(static_cast<std::size_t>(blocks.y), [&](std::size_t task) {
    const int row = static_cast<int>(task);
    const int end_y = std::min((row + 1) * BlockPlan::kSmall, pixels.height);
    for (int column = 0; column < blocks.x; ++column) {
      if (is_needed[index({column, row})] == 0) continue;
      const int end_x = std::min((column + 1) * BlockPlan::kSmall, pixels.width);
      for (int y = row * BlockPlan::kSmall; y < end_y; ++y)
        pixels.move(motion_, column * BlockPlan::kSmall, end_x, y);
    }
  });
  constexpr std::size_t kBlocks = 64;
  pool.run((rough_.size() + kBlocks - 1) / kBlocks, [&](std::size_t task) {
    for (std::size_t n = task * kBlocks; n < std::min((task + 1) * kBlocks, rough_.size()); ++n)
      find_rows(rough_[n]);
  });
}

CellCarrier::Corners CellCarrier::corners_of(Half half) const {
  const int cell = half / 2;
  Corners at{};
  for (std::size_t n = 0; n < 3; ++n) {
    const glm::ivec2& corner = kCorners[static_cast<std::size_t>(half % 2)][n];
    at[n] = static_cast<std::size_t>(cell + corner.y * pixels_.width + corner.x);
  }
  return at;
}

void CellCarrier::find_rows(RoughBlock& block) const {
  block.low = kFar_px;
  block.high = -kFar_px;
  bool is_whole = true;
  for (int y = block.first.y; y <= block.end.y; ++y) {
    for (int x = block.first.x; x <= block.end.x; ++x) {
      const float at = pixels_.y_px[pixels_.index(x, y)];
      is_whole = is_whole && at == at;
      block.low = std::min(block.low, at);
      block.high = std::max(block.high, at);
    }
  }
  if (is_whole) return;
  block.low = -kFar_px;
  block.high = kFar_px;
}

void CellCarrier::draw_cells(const RoughBlock& block, TriangleBand& band) const {
  const auto corner = [&](std::size_t n) {
    return Corner{{pixels_.x_px[n], pixels_.y_px[n]}, pixels_.inverse_depth[n]};
  };
  for (int y = block.first.y; y < block.end.y; ++y) {
    std::size_t upper = pixels_.index(block.first.x, y);
    std::size_t lower = pixels_.index(block.first.x, y + 1);
    Corner a = corner(upper);
    Corner c = corner(lower);
    for (int x = block.first.x; x < block.end.x; ++x) {
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
}

// Draws half of a cell that may reach behind the new camera: what lies ahead hides, and shows nothing.
void CellCarrier::draw_clipped(int x, int y, int half, TriangleBand& band) const {
  struct Point {
    glm::vec3 point{};
    float nearness = 0;
  };
  std::array<Point, 3> in;
  for (std::size_t n = 0; n < 3; ++n) {
    const glm::ivec2& corner = kCorners[static_cast<std::size_t>(half)][n];
    in[n].nearness = motion_.focal() * pixels_.first_inverse_depth[pixels_.index(x + corner.x, y + corner.y)];
    if (!std::isfinite(in[n].nearness)) return;
    in[n].point = motion_.moved(motion_.ray(x + corner.x, y + corner.y), in[n].nearness);
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
float CellCarrier::show(Half half, float hit_inverse_depth, int x, int y, std::size_t out,
                        CarriedImage& into) const {
  const Corners at = corners_of(half);
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
  const float inverse_depth = is_skyline ? pixels_.inverse_depth[at[nearest]] : hit_inverse_depth;
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
float CellCarrier::clear_m(Half half, int x, int y) const {
  float nearest = 0;
  for (const std::size_t n : corners_of(half)) nearest = std::max(nearest, pixels_.inverse_depth[n]);
  return nearest > 0 ? motion_.new_lengths().at(x, y) / nearest : 0;
}

Hits CellCarrier::draw(int first, int end, int width) const {
  Hits hits(width, first, end);
  for (const BlockPlan::Row& row : plan_.rows()) {
    if (row.end <= first || row.low >= end) continue;
    for (const FlatBlock& block : row.flat)
      if (block.end.y > first && block.low.y < end) draw_block(block, hits);
  }
  TriangleBand band(hits, width);
  for (const RoughBlock& block : rough_)
    if (block.high >= static_cast<float>(first) && block.low <= static_cast<float>(end))
      draw_cells(block, band);
  return hits;
}

float CellCarrier::fill(int first, int end, CarriedImage& into) const {
  const Hits hits = draw(first, end, into.width);
  const auto width = static_cast<std::size_t>(into.width);
  std::vector<float> length(width + kVectorPad);
  std::vector<float> range_m(width + kVectorPad);
  std::vector<Origin> origin(width + kVectorPad);
  std::vector<base::Rgb> colour(width + kVectorPad);
  const MixedImage image{pixels_.word.empty() ? nullptr : pixels_.word.data(), pixels_.width, pixels_.height,
                         options_.filters};
  const auto is_beside = [&](int x, int y) { return motion_.entry_m(x, y) > options_.nearest_m; };
  float added = 0;
  for (int y = first; y < end; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * width;
    motion_.new_lengths().row(y, std::span(length).first(width));
    const bool has_cells = show_flat(hits, hits.index(0, y), into.width, image,
                                     {length.data(), range_m.data(), origin.data(), colour.data()});
    std::copy_n(range_m.begin(), width, into.range_m.begin() + static_cast<std::ptrdiff_t>(row));
    std::copy_n(origin.begin(), width, into.origin.begin() + static_cast<std::ptrdiff_t>(row));
    if (!into.colour.empty())
      std::copy_n(colour.begin(), width, into.colour.begin() + static_cast<std::ptrdiff_t>(row));
    // Where a ray begins in what the first image shows, so do those between: its air is convex.
    int known = 0;
    int end_known = into.width;
    if (motion_.moves()) {
      while (known < end_known && is_beside(known, y)) ++known;
      while (end_known > known && is_beside(end_known - 1, y)) --end_known;
    }
    for (int x = 0; x < into.width; ++x) {
      if (x == known && !has_cells) x = std::max(end_known, known);
      if (x >= into.width) break;
      const std::size_t out = row + static_cast<std::size_t>(x);
      const bool is_known = x >= known && x < end_known;
      const std::size_t hit = hits.index(x, y);
      const Half half = hits.half[hit];
      if (is_known && half >= 0) {
        added = std::max(added, show(half, hits.inverse_depth[hit], x, y, out, into));
        if (into.origin[out] == Origin::kOpen) into.range_m[out] = clear_m(half, x, y);
      } else if (!is_known && into.origin[out] != Origin::kOpen) {
        into.origin[out] = Origin::kOpen;
        into.range_m[out] = 0;
        if (!into.colour.empty()) into.colour[out] = {};
      }
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
  into.added_px = carrier.flat_added_px();
  for (const float px : added) into.added_px = std::max(into.added_px, static_cast<double>(px));
  into.added_px += kCarriedPosition_px;
}

}  // namespace vpe::warp
