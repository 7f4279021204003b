#include "vpe/warp/carry.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vpe/warp/carry_cells.h"
#include "vpe/warp/carry_checks.h"
#include "vpe/warp/carry_rows.h"
#include "vpe/warp/moved_pixels.h"

namespace vpe::warp {

namespace {

void check(const core::View& from, const core::Frame& frame, const core::View& to,
           const CarryOptions& options) {
  if (const std::string problem = check_carry(from, to); !problem.empty()) throw std::invalid_argument(problem);
  check_options(options);
  const glm::ivec2 drawn = core::drawn_size(from);
  const std::size_t count = static_cast<std::size_t>(drawn.x) * static_cast<std::size_t>(drawn.y);
  if (frame.range_m.size() != count) throw std::invalid_argument("the image to carry has no ranges");
  if (!frame.colour.empty() && frame.colour.size() != count)
    throw std::invalid_argument("the image to carry has colours of another size");
}

// Makes sure that the clear ranges of open pixels end before what is around them: silhouettes may reach up to two pixels
// farther than the places of the first image's pixels.
void keep_clear_of_silhouettes(base::ThreadPool& pool, CarriedImage& image) {
  constexpr int kAround = 2;
  constexpr int kRows = 16;
  struct ClearPixel {
    std::size_t index = 0;
    float clear_m = 0;
  };
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
  };
  const auto clear_m_at = [&](int x, int y) {
    float clear_m = image.range_m[index(x, y)];
    for (int v = std::max(y - kAround, 0); v <= std::min(y + kAround, image.height - 1); ++v)
      for (int u = std::max(x - kAround, 0); u <= std::min(x + kAround, image.width - 1); ++u)
        if (image.range_m[index(u, v)] > 0) clear_m = std::min(clear_m, image.range_m[index(u, v)]);
    return clear_m;
  };
  // Written after all are found, so that none depends on another.
  std::vector<std::vector<ClearPixel>> found(static_cast<std::size_t>((image.height + kRows - 1) / kRows));
  pool.run(found.size(), [&](std::size_t task) {
    const int first = static_cast<int>(task) * kRows;
    for (int y = first; y < std::min(first + kRows, image.height); ++y)
      for (int x = 0; x < image.width; ++x)
        if (image.origin[index(x, y)] == Origin::kOpen && image.range_m[index(x, y)] > 0)
          found[task].push_back({index(x, y), clear_m_at(x, y)});
  });
  for (const std::vector<ClearPixel>& pixels : found)
    for (const ClearPixel& pixel : pixels) image.range_m[pixel.index] = pixel.clear_m;
}

}  // namespace

void check_options(const CarryOptions& options) {
  if (!(options.gap_px >= 0 && options.gap_px <= CarryLimits::kMaxGap_px))
    throw std::invalid_argument("the widest gap must be 0 to 16 pixels");
  if (!(options.most_added_px >= 0))
    throw std::invalid_argument("the largest added error must be 0 or more pixels");
  if (!(options.nearest_m >= 0)) throw std::invalid_argument("the nearest distance must be 0 or more metres");
}

void prepare(int width, int height, bool has_colour, CarriedImage& image) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  image.width = width;
  image.height = height;
  image.colour.assign(has_colour ? pixels : 0, base::Rgb{});
  image.range_m.assign(pixels, 0.0F);
  image.origin.assign(pixels, Origin::kOpen);
  image.added_px = 0;
}

void finish(base::ThreadPool& pool, CarriedImage& image) {
  keep_clear_of_silhouettes(pool, image);
  for (const Origin origin : {Origin::kOpen, Origin::kSky, Origin::kCarried, Origin::kBetween})
    image.pixels[static_cast<std::size_t>(origin)] = std::ranges::count(image.origin, origin);
}

std::string check_carry(const core::View& from, const core::View& to) {
  for (const core::View* view : {&from, &to}) {
    if (std::string problem = core::check(*view); !problem.empty()) return problem;
    if (view->projection != core::Projection::kPerspective)
      return "images are carried between perspective views only; draw panoramas in full (--stereo-method full)";
  }
  return {};
}

Carrier::Carrier() = default;
Carrier::~Carrier() = default;
Carrier::Carrier(Carrier&&) noexcept = default;
Carrier& Carrier::operator=(Carrier&&) noexcept = default;

void Carrier::carry(const core::View& from, const core::Frame& frame, const core::View& to,
                    const CarryOptions& options, base::ThreadPool& pool, CarriedImage& into) {
  check(from, frame, to, options);
  const glm::ivec2 size = core::drawn_size(to);
  const std::size_t pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  into.width = size.x;
  into.height = size.y;
  into.colour.resize(frame.colour.empty() ? 0 : pixels);
  into.range_m.resize(pixels);
  into.origin.resize(pixels);
  into.added_px = 0;
  if (options.gap_px == 0) {
    prepare(size.x, size.y, !frame.colour.empty(), into);
  } else if (rows_correspond(from, to)) {
    carry_rows(from, frame, to, options, pool, into);
  } else {
    if (!pixels_) pixels_ = std::make_unique<MovedPixels>();
    carry_cells(from, frame, to, options, pool, *pixels_, into);
  }
  finish(pool, into);
}

CarriedImage carry(const core::View& from, const core::Frame& frame, const core::View& to,
                   const CarryOptions& options, base::ThreadPool& pool) {
  CarriedImage image;
  Carrier().carry(from, frame, to, options, pool, image);
  return image;
}

}  // namespace vpe::warp
