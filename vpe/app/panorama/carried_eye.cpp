#include "vpe/app/panorama/carried_eye.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mars/geodesy/sphere.h"
#include "vpe/core/appearance/shading.h"

namespace vpe::app {

namespace {

using panorama::Piece;
using panorama::Strip;

// The nearest ground was measured with few pixels.
constexpr double kOfNearest = 0.8;

// Keeps the larger bounds, and what is missing.
void add(core::DrawResult& all, const core::DrawResult& one) {
  core::Certificate& certificate = all.certificate;
  certificate.geometric_error_m = std::max(certificate.geometric_error_m, one.certificate.geometric_error_m);
  certificate.shift_bound_px = std::max(certificate.shift_bound_px, one.certificate.shift_bound_px);
  all.stats.tiles_substituted += one.stats.tiles_substituted;
  all.missing.insert(all.missing.end(), one.missing.begin(), one.missing.end());
}

// Draws the open pixels of a piece. `at` is the index of its first pixel in the image, `stride` the distance of rows.
core::DrawResult draw_open(const Piece& piece, const warp::CarriedImage& carried, std::size_t at,
                           std::size_t stride, core::PixelRenderer& renderer, core::DrawRequest request,
                           core::Frame& image) {
  core::Frame part{piece.width, piece.height, {}, {}};
  std::vector<std::uint8_t> wanted;
  std::vector<float> clear_m;
  for (int y = 0; y < piece.height; ++y) {
    const std::size_t row = at + static_cast<std::size_t>(y) * stride;
    for (std::size_t n = row; n < row + static_cast<std::size_t>(piece.width); ++n) {
      const bool is_open = carried.origin[n] == warp::Origin::kOpen;
      wanted.push_back(is_open ? 1 : 0);
      clear_m.push_back(is_open && std::isfinite(carried.range_m[n]) ? carried.range_m[n] : 0);
      part.range_m.push_back(carried.range_m[n]);
      part.colour.push_back(image.colour[n]);
    }
  }
  if (std::ranges::count(wanted, 1) == 0) return {};
  request.view = piece.view;
  core::DrawResult result = renderer.draw_pixels(request, {wanted, clear_m}, part);
  std::vector<base::Rgb> drawn;
  for (std::size_t n = 0; n < wanted.size(); ++n)
    if (wanted[n] != 0) drawn.push_back(part.colour[n]);
  core::apply_gamma(drawn, request.settings.gamma);
  auto next = drawn.begin();
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    if (wanted[n] == 0) continue;
    const auto width = static_cast<std::size_t>(piece.width);
    image.colour[at + n / width * stride + n % width] = *next++;
  }
  return result;
}

}  // namespace

void copy_into(core::Frame& frame, const Piece& piece, const core::Frame& image) {
  const auto width = static_cast<std::size_t>(piece.width);
  for (int y = 0; y < piece.height; ++y) {
    const std::size_t from = static_cast<std::size_t>(y) * width;
    const std::size_t to = static_cast<std::size_t>(piece.y + y) * static_cast<std::size_t>(frame.width) +
                           static_cast<std::size_t>(piece.x);
    std::copy_n(&image.colour[from], width, &frame.colour[to]);
    std::copy_n(&image.range_m[from], width, &frame.range_m[to]);
  }
}

namespace {

std::int64_t end_of(const Strip& strip) { return strip.x + strip.width; }

// Copies columns [from, from + count) of an image to a place in a wider one of the same height.
void copy_columns(const core::Frame& image, std::int64_t from, std::int64_t count, core::Frame& wide,
                  std::int64_t to) {
  for (int y = 0; y < image.height; ++y) {
    const std::size_t begin =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(from);
    const std::size_t out =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(wide.width) + static_cast<std::size_t>(to);
    std::copy_n(&image.colour[begin], count, &wide.colour[out]);
    std::copy_n(&image.range_m[begin], count, &wide.range_m[out]);
  }
}

}  // namespace

core::Frame LeftColumns::join(const std::vector<Strip>& strips, const Draw& draw) {
  core::Frame all;
  for (const Strip& strip : strips) all.width += strip.width;
  std::int64_t at = 0;
  for (const Strip& strip : strips) {
    for (std::int64_t x = strip.x; x < end_of(strip);) {
      const auto holds = [&](const Block& block) { return x >= block.strip.x && x < end_of(block.strip); };
      auto found = std::ranges::find_if(blocks_, holds);
      if (found == blocks_.end()) {
        std::int64_t end = end_of(strip);
        for (const Block& block : blocks_)
          if (block.strip.x > x) end = std::min(end, block.strip.x);
        const Strip missing{x, static_cast<int>(end - x)};
        blocks_.push_back({missing, draw(missing)});
        found = blocks_.end() - 1;
      }
      if (all.colour.empty()) {
        all.height = found->frame.height;
        all.colour.resize(static_cast<std::size_t>(all.width) * static_cast<std::size_t>(all.height));
        all.range_m.resize(all.colour.size());
      }
      const std::int64_t count = std::min(end_of(strip), end_of(found->strip)) - x;
      copy_columns(found->frame, x - found->strip.x, count, all, at);
      x += count;
      at += count;
    }
  }
  return all;
}

void LeftColumns::keep(const std::vector<Strip>& wanted) {
  std::erase_if(blocks_, [&](const Block& block) {
    return std::ranges::none_of(wanted, [&](const Strip& strip) {
      return strip.x < end_of(block.strip) && block.strip.x < end_of(strip);
    });
  });
}

std::int64_t LeftColumns::kept() const {
  std::int64_t columns = 0;
  for (const Block& block : blocks_) columns += block.strip.width;
  return columns;
}

CarriedEye::CarriedEye(const panorama::PanoramaMap& map, const panorama::Viewpoint& viewpoint,
                       const panorama::EyePair& eyes)
    : map_(map), viewpoint_(viewpoint), eyes_(eyes), bands_(panorama::stereo_bands(map, eyes)) {
  for (const panorama::StereoBand& band : bands_) {
    for (std::int64_t y = band.y; y < band.y + band.height; ++y) {
      const double elevation_deg = map.to_direction(0.5, static_cast<double>(y) + 0.5).elevation_deg;
      rows_.push_back({0.5 * band.base_m, std::cos(elevation_deg * mars::kRadiansPerDegree)});
    }
  }
  nearest_m_ = eyes.nearest_m ? kOfNearest * (*eyes.nearest_m - 0.5 * eyes.base_m)
                              : std::numeric_limits<double>::infinity();
}

std::vector<Strip> CarriedEye::columns_for(const Strip& strip) const {
  const std::int64_t beside = warp::columns_beside(map_.turn_px, rows_, nearest_m_);
  const std::int64_t end = strip.x + strip.width;
  const std::int64_t within = std::min(beside, map_.width_px - end);
  std::vector<Strip> columns{{strip.x, static_cast<int>(strip.width + within)}};
  if (map_.is_full_turn() && beside > within)
    columns.push_back({0, static_cast<int>(std::min(beside - within, map_.width_px))});
  return columns;
}

std::vector<Piece> CarriedEye::left_pieces(const std::vector<Strip>& columns) const {
  std::vector<Piece> pieces;
  std::int64_t before = 0;
  for (const Strip& strip : columns) {
    for (Piece& piece : panorama::eye_pieces_of(map_, viewpoint_, bands_, panorama::Eye::kLeft, strip)) {
      piece.x += before - strip.x;
      pieces.push_back(std::move(piece));
    }
    before += strip.width;
  }
  return pieces;
}

std::vector<Piece> CarriedEye::right_pieces(const Strip& strip) const {
  std::vector<Piece> pieces = panorama::eye_pieces_of(map_, viewpoint_, bands_, panorama::Eye::kRight, strip);
  for (Piece& piece : pieces) piece.x -= strip.x;
  return pieces;
}

RightEye CarriedEye::carry(const core::Frame& left, const Strip& strip, core::PixelRenderer& renderer,
                           const core::DrawRequest& request, base::ThreadPool& pool,
                           const std::function<void(double)>& show) const {
  warp::CarryOptions options;
  options.gap_px = eyes_.carried_gap_px.value();
  options.nearest_m = nearest_m_;
  warp::CarriedImage carried;
  warp::carry_round(left, {map_.turn_px, strip.width}, rows_, options, pool, carried);
  RightEye out;
  out.added_px = carried.added_px;
  out.frame = {carried.width, carried.height, std::move(carried.colour), {}};
  const std::vector<Piece> pieces = right_pieces(strip);
  const auto stride = static_cast<std::size_t>(strip.width);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    show(static_cast<double>(k) / static_cast<double>(pieces.size()));
    const std::size_t at =
        static_cast<std::size_t>(pieces[k].y) * stride + static_cast<std::size_t>(pieces[k].x);
    const core::DrawResult result = draw_open(pieces[k], carried, at, stride, renderer, request, out.frame);
    out.failures.insert(out.failures.end(), result.failures.begin(), result.failures.end());
    add(out.drawn, result);
  }
  for (std::size_t n = 0; n < carried.range_m.size(); ++n) {
    if (carried.origin[n] == warp::Origin::kOpen) carried.range_m[n] = std::numeric_limits<float>::quiet_NaN();
  }
  out.frame.range_m = std::move(carried.range_m);
  return out;
}

}  // namespace vpe::app
