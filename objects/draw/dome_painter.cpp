#include "objects/draw/dome_painter.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace objects {

namespace {

using vpe::core::Projection;
using Kind = PanoramaFormula::Kind;

// Where the camera is nearer to a dome, relative to its radius, pixels are drawn one at a time.
constexpr double kLeastOpen = 1e-6;
// By how much of a pixel floats may move a place.
constexpr double kMostFloatError_px = 0.5 * kDomePlaceError_px;
// Nearer to the middle than what moves no place by more, a camera is taken to be there.
constexpr double kLeastMove_px = 1e-4;
// As panorama/projection.h: rounding may push a place over the edge of the image.
constexpr double kRim_px = 1e-8;
constexpr std::size_t kMostBlockLevels = 32;
// Where levels differ by more between the corners of a block, they are not bilinear in it.
constexpr double kMostLevels = 0.5;

// Returns the part of a vector that counts for where a ray meets the dome.
glm::dvec3 met_part(const glm::dvec3& v, bool is_cylinder) { return {v.x, v.y, is_cylinder ? 0 : v.z}; }

std::uint32_t word_of(const glm::vec3& colour, float steps) {
  const auto channel = [&](float value) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0F, 255.0F) * steps));
  };
  return channel(colour.x) | channel(colour.y) << 10U | channel(colour.z) << 20U;
}

template <class Visit>
void for_blocks(const PixelSquare& square, const Visit& visit) {
  for (int y = square.y0; y < square.y1; y += kDomeBlock_px) {
    for (int x = square.x0; x < square.x1; x += kDomeBlock_px)
      visit(PixelSquare{x, y, std::min(x + kDomeBlock_px, square.x1), std::min(y + kDomeBlock_px, square.y1)});
  }
}

}  // namespace

struct DomePainter::SquareRays {
  std::array<glm::dvec3, DomeMask::kSide> column;
  std::array<double, DomeMask::kSide> scale;
  std::array<double, DomeMask::kSide> rise;
};

struct DomePainter::BlockOrigin {
  bool is_known = false;
  double sine_azimuth = 0;  // of the direction that is y in the block
  double cosine_azimuth = 1;
  double sine = 0;  // of the elevation
  double cosine = 1;
  glm::dvec2 middle_px{0, 0};  // as in DomeBlock
  glm::dvec2 place_px{0, 0};   // of the block's middle in the panorama
};

bool DomePainter::knows(const SeenPosters& posters, std::uint32_t poster) {
  const PlacedPoster* placed = posters.dome(poster);
  if (placed == nullptr || !placed->image.formula || !placed->image.texture->is_opaque()) return false;
  const Texture& finest = placed->image.texture->levels().front();
  return std::int64_t{finest.width} * finest.height < std::numeric_limits<std::int32_t>::max() &&
         placed->image.texture->levels().size() < kMostBlockLevels;
}

DomePainter::DomePainter(const SeenPosters& posters, std::uint32_t poster, const vpe::core::View& view,
                         const ViewRays& rays, double gamma)
    : posters_(posters),
      poster_(poster),
      view_(view),
      rays_(rays),
      placed_(*posters.dome(poster)),
      formula_(*placed_.image.formula),
      opacity_(posters.opacity(poster)),
      repeats_whole_(placed_.image.is_full_circle && formula_.turn_px == formula_.width_px),
      steps_(gamma == 1 && opacity_ >= 1 ? 1.0F : 4.0F),
      principal_px_(0.5 * glm::dvec2(view.width, view.height) + view.principal_offset_px),
      focal_px_(vpe::core::focal_px(view)) {
  const auto in_dome = [&](const glm::dvec3& v) {
    return glm::dvec3(glm::dot(v, placed_.axes.right), glm::dot(v, placed_.axes.forward),
                      glm::dot(v, placed_.axes.up));
  };
  right_ = in_dome(view.camera.axes.right);
  up_ = in_dome(view.camera.axes.up);
  forward_ = in_dome(view.camera.axes.forward);
  camera_ = in_dome(view.camera.position_m - placed_.middle_m) / placed_.radius_m;
  const glm::dvec3 met = met_part(camera_, placed_.is_cylinder);
  open_ = 1 - glm::dot(met, met);
  // Near to the dome a small move is seen under a large angle.
  const double nearest = 1 - glm::length(met);
  is_central_ = glm::length(camera_) * focal_px_ * vpe::core::corner_stretch(view) < kLeastMove_px;
  has_doubles_ = kFloatError_rad * focal_px_ * vpe::core::corner_stretch(view) > kMostFloatError_px * nearest;
  for (std::size_t n = 0; n < values_.size(); ++n) {
    const double value = std::min(255.0, static_cast<double>(n) / static_cast<double>(steps_));
    const double shown = gamma == 1 ? value : 255 * std::pow(value / 255, gamma);
    values_[n] = static_cast<float>(shown);
    bytes_[n] = static_cast<std::uint8_t>(std::lround(shown));
  }
}

glm::dvec3 DomePainter::colour(std::uint32_t word) const {
  return {values_[word & 1023U], values_[word >> 10U & 1023U], values_[word >> 20U & 1023U]};
}

// Columns and rows are apart in all projections.
DomePainter::SquareRays DomePainter::rays_of(const PixelSquare& square) const {
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view_);
  SquareRays rays;
  for (int n = 0; n < DomeMask::kSide; ++n) {
    const auto k = static_cast<std::size_t>(n);
    const double x = part.x + square.x0 + n + 0.5 - principal_px_.x;
    const double y = principal_px_.y - (part.y + square.y0 + n + 0.5);
    rays.scale[k] = 1;
    if (view_.projection == Projection::kPerspective) {
      rays.column[k] = x / focal_px_ * right_ + forward_;
      rays.rise[k] = y / focal_px_;
      continue;
    }
    const double azimuth = std::remainder(x, view_.width) * 2 * mars::kPi / view_.width;
    rays.column[k] = std::sin(azimuth) * right_ + std::cos(azimuth) * forward_;
    rays.rise[k] = y / focal_px_;
    if (view_.projection == Projection::kCylinder) continue;
    rays.scale[k] = std::cos(y / focal_px_);
    rays.rise[k] = std::sin(y / focal_px_);
  }
  return rays;
}

glm::dvec3 DomePainter::ray_at(double x, double y) const {
  const glm::dvec3 d = rays_.at(x, y);
  return {glm::dot(d, placed_.axes.right), glm::dot(d, placed_.axes.forward), glm::dot(d, placed_.axes.up)};
}

// Returns where a ray (unit; east, north, up) meets the dome, from its middle, in radii.
glm::dvec3 DomePainter::meet(const glm::dvec3& ray) const {
  const glm::dvec3 d = met_part(ray, placed_.is_cylinder);
  const double square = glm::dot(d, d);
  const double ahead = glm::dot(camera_, d);
  const double root = std::sqrt(ahead * ahead + square * open_);
  return camera_ + (ahead > 0 ? open_ / (root + ahead) : (root - ahead) / square) * ray;
}

// Returns the level of the pyramid at a place of the image, without limits.
double DomePainter::level_at(double x, double y) const {
  const glm::dvec3 ray = ray_at(x, y);
  const glm::dvec3 at = meet(ray);
  const glm::dvec3 away = at - camera_;
  const double out_square = glm::dot(at, at);
  const double cosine = std::max(kLeastPosterCosine, glm::dot(ray, at) / std::sqrt(out_square));
  const double pixel_sr =
      pixel_solid_angle(view_, rays_.at(x, y)) * glm::dot(away, away) / (out_square * cosine);
  const Texture& finest = placed_.image.texture->levels().front();
  const double texel_sr =
      formula_.pixel_sr(at) * (formula_.width_px / finest.width) * (formula_.height_px / finest.height);
  return 0.5 * std::log2(pixel_sr / texel_sr);
}

DomePainter::BlockOrigin DomePainter::origin_of(double x, double y) const {
  const glm::dvec3 at = meet(ray_at(x, y));
  const double level = std::sqrt(at.x * at.x + at.y * at.y);
  const double length = glm::length(at);
  BlockOrigin origin;
  origin.is_known = level > 0 && std::isfinite(length);
  if (!origin.is_known) return origin;
  double azimuth_rad = std::atan2(at.x, at.y);
  origin.place_px.y = formula_.horizon_px;
  if (formula_.kind == Kind::kFacets) {
    azimuth_rad = formula_.facet_azimuth_rad(formula_.facet_at(azimuth_rad));
    origin.sine_azimuth = std::sin(azimuth_rad);
    origin.cosine_azimuth = std::cos(azimuth_rad);
  } else {
    origin.sine_azimuth = at.x / level;
    origin.cosine_azimuth = at.y / level;
  }
  if (formula_.kind == Kind::kEquirectangular) {
    origin.place_px.y -= formula_.focal_px * std::atan2(at.z, level);
    origin.sine = at.z / length;
    origin.cosine = level / length;
  } else {
    // In the direction of y; a cylinder has the same scale in all of them.
    const double ahead =
        formula_.kind == Kind::kFacets ? at.x * origin.sine_azimuth + at.y * origin.cosine_azimuth : level;
    const double aside = at.x * origin.cosine_azimuth - at.y * origin.sine_azimuth;
    if (formula_.kind == Kind::kFacets) origin.middle_px.x = formula_.focal_px * aside / ahead;
    origin.middle_px.y = -formula_.focal_px * at.z / ahead;
  }
  origin.place_px += glm::dvec2(formula_.column_px(azimuth_rad), 0) + origin.middle_px;
  return origin;
}

template <class T>
DomeBlock<T> DomePainter::block_of(const SquareRays& rays, const BlockOrigin& origin, int column,
                                   int row) const {
  const auto turned = [&](const glm::dvec3& v) {
    return typename DomeBlock<T>::Vector{
        static_cast<T>(v.x * origin.cosine_azimuth - v.y * origin.sine_azimuth),
        static_cast<T>(v.x * origin.sine_azimuth + v.y * origin.cosine_azimuth), static_cast<T>(v.z)};
  };
  DomeBlock<T> block;
  for (std::size_t n = 0; n < kDomeBlock_px; ++n) {
    const auto of_column = turned(rays.column[static_cast<std::size_t>(column) + n]);
    for (std::size_t axis = 0; axis < 3; ++axis) block.column[axis][n] = of_column[axis];
    block.row_scale[n] = static_cast<T>(rays.scale[static_cast<std::size_t>(row) + n]);
    block.row_rise[n] = static_cast<T>(rays.rise[static_cast<std::size_t>(row) + n]);
  }
  block.up = turned(up_);
  block.camera = turned(camera_);
  block.open = static_cast<T>(open_);
  block.is_central = is_central_;
  block.is_cylinder = placed_.is_cylinder;
  block.kind = formula_.kind;
  block.across_px = static_cast<T>(formula_.turn_px / (2 * mars::kPi));
  block.focal_px = static_cast<T>(formula_.focal_px);
  if (formula_.kind == Kind::kFacets)
    block.half_facet_px = static_cast<T>(0.5 * formula_.turn_px / formula_.facets);
  block.middle_x_px = static_cast<T>(origin.middle_px.x);
  block.middle_y_px = static_cast<T>(origin.middle_px.y);
  block.sine = static_cast<T>(origin.sine);
  block.cosine = static_cast<T>(origin.cosine);
  block.radius_m = static_cast<T>(placed_.radius_m);
  constexpr float kEverywhere = std::numeric_limits<float>::infinity();
  const auto from_origin = [](double px, double origin_px) { return static_cast<float>(px - origin_px); };
  block.least_x_px = repeats_whole_ ? -kEverywhere : from_origin(-kRim_px, origin.place_px.x);
  block.most_x_px = repeats_whole_ ? kEverywhere : from_origin(formula_.width_px + kRim_px, origin.place_px.x);
  block.least_y_px = from_origin(-kRim_px, origin.place_px.y);
  block.most_y_px = from_origin(formula_.height_px + kRim_px, origin.place_px.y);
  block.replaces_ground = placed_.replaces_ground;
  return block;
}

// Returns false where the pixels are to be found one at a time.
bool DomePainter::find_block(const SquareRays& rays, const PixelSquare& square, const GroundRanges* ground,
                             const PixelSquare& block, BlockOrigin& origin, BlockPlaces& places) const {
  if (!(open_ >= kLeastOpen)) return false;
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view_);
  constexpr double kHalf_px = 0.5 * kDomeBlock_px;
  origin = origin_of(part.x + block.x0 + kHalf_px, part.y + block.y0 + kHalf_px);
  if (!origin.is_known) return false;
  const int column = block.x0 - square.x0;
  const int row = block.y0 - square.y0;
  const float* const until_m = ground == nullptr ? nullptr : ground->from(block.x0, block.y0);
  const std::size_t stride = ground == nullptr ? 0 : ground->stride();
  const bool is_found = has_doubles_
                            ? find_places(block_of<double>(rays, origin, column, row), until_m, stride, places)
                            : find_places(block_of<float>(rays, origin, column, row), until_m, stride, places);
  if (!is_found || repeats_whole_) return is_found;
  // Columns are counted on from the image's middle up to the opposite direction.
  const auto [left, right] = std::ranges::minmax(places.x_px);
  const double from_middle_px = origin.place_px.x - 0.5 * formula_.width_px;
  return std::max(from_middle_px + static_cast<double>(right), -(from_middle_px + static_cast<double>(left))) <
         0.5 * formula_.turn_px;
}

void DomePainter::find_pixels(const PixelSquare& block, const GroundRanges& ground, DomeColours& out) const {
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view_);
  out.places.shows = {};
  for (int y = block.y0; y < block.y1; ++y) {
    for (int x = block.x0; x < block.x1; ++x) {
      const auto until_m = static_cast<double>(ground.at(x, y));
      const auto hit = posters_.meet(poster_, rays_.at(part.x + x + 0.5, part.y + y + 0.5), until_m);
      if (!hit) continue;
      const auto row = static_cast<std::size_t>(y - block.y0);
      const auto column = static_cast<unsigned>(x - block.x0);
      const std::size_t n = row * kDomeBlock_px + column;
      out.places.shows[row] = static_cast<std::uint16_t>(out.places.shows[row] | 1U << column);
      const PosterImage& image = placed_.image;
      out.words[n] = word_of(image.texture->sample_within(hit->uv, hit->texels, image.is_full_circle), steps_);
      out.places.range_m[n] =
          hit->range_m < until_m ? static_cast<float>(hit->range_m) : std::numeric_limits<float>::infinity();
    }
  }
}

// An angle at the camera is at most sqrt((1 + k) / (1 - k)) times as large at the middle of a sphere, k being how far the camera
// is from there, in radii: a move along the ray's normal is (1 + k) / cos(i) times as long on the sphere, at most, and
// cos(i) >= sqrt(1 - k^2) where the ray meets it.
bool DomePainter::shows_all(const ViewCone& cone, const GroundRanges& ground) const {
  if (!repeats_whole_ || formula_.kind != Kind::kEquirectangular || placed_.is_cylinder ||
      !(open_ >= kLeastOpen))
    return false;
  if (!placed_.replaces_ground && ground.has_ground()) return false;
  const double k = glm::length(camera_);
  const double reach_rad = std::acos(cone.cosine) * std::sqrt((1 + k) / (1 - k)) + 1e-9;
  const glm::dvec3& axis = cone.axis;
  const glm::dvec3 at = meet({glm::dot(axis, placed_.axes.right), glm::dot(axis, placed_.axes.forward),
                              glm::dot(axis, placed_.axes.up)});
  const double elevation_rad = std::atan2(at.z, std::hypot(at.x, at.y));
  const auto row_px = [&](double e) {
    return formula_.horizon_px - formula_.focal_px * std::clamp(e, -0.5 * mars::kPi, 0.5 * mars::kPi);
  };
  return row_px(elevation_rad + reach_rad) >= -kRim_px &&
         row_px(elevation_rad - reach_rad) <= formula_.height_px + kRim_px;
}

DomeMask DomePainter::find(const PixelSquare& square, const ViewCone& cone, const GroundRanges& ground) const {
  DomeMask mask;
  if (shows_all(cone, ground)) {
    mask.is_full = true;
    mask.is_before_all = !ground.has_ground();
    mask.rows.fill(~std::uint64_t{0});
    return mask;
  }
  const SquareRays rays = rays_of(square);
  BlockOrigin origin;
  DomeColours found;
  for_blocks(square, [&](const PixelSquare& block) {
    if (!find_block(rays, square, &ground, block, origin, found.places)) find_pixels(block, ground, found);
    for (int y = block.y0; y < block.y1; ++y) {
      const std::uint64_t bits = found.places.shows[static_cast<std::size_t>(y - block.y0)];
      mask.rows[static_cast<std::size_t>(y - square.y0)] |= bits << static_cast<unsigned>(block.x0 - square.x0);
    }
  });
  const auto columns = static_cast<unsigned>(square.x1 - square.x0);
  const std::uint64_t all = ~std::uint64_t{0} >> (DomeMask::kSide - columns);
  mask.is_full = std::all_of(mask.rows.begin(), mask.rows.begin() + (square.y1 - square.y0),
                             [&](std::uint64_t row) { return (row & all) == all; });
  return mask;
}

DomePainter::Levels DomePainter::levels_of(const PixelSquare& square) const {
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view_);
  Levels levels;
  for (std::size_t j = 0; j < kNodes; ++j) {
    for (std::size_t i = 0; i < kNodes; ++i)
      levels[j][i] = level_at(part.x + square.x0 + static_cast<int>(i) * kDomeBlock_px,
                              part.y + square.y0 + static_cast<int>(j) * kDomeBlock_px);
  }
  return levels;
}

// Describes the pyramid about a block whose corners have these levels.
struct DomePainter::BlockPyramid {
  void fill(const DomePainter& painter, const BlockOrigin& origin, const std::array<double, 4>& corners) {
    count = 0;
    const std::span<const Texture> textures = painter.placed_.image.texture->levels();
    const auto [low, high] = std::ranges::minmax(corners);
    const auto last = static_cast<double>(textures.size() - 1);
    const double first = std::clamp(std::floor(low), 0.0, last);
    const auto end = static_cast<std::size_t>(std::clamp(std::ceil(high), first, last));
    for (auto n = static_cast<std::size_t>(first); n <= end; ++n) {
      const Texture& t = textures[n];
      BlockLevel& l = levels[count++];
      // The four bytes of a texel are read as one word.
      l.texels = reinterpret_cast<const std::uint32_t*>(t.texels.data());
      l.width = t.width;
      l.height = t.height;
      const glm::dvec2 scale(t.width / painter.formula_.width_px, t.height / painter.formula_.height_px);
      const glm::dvec2 place = origin.place_px * scale - 0.5;
      l.scale_x = static_cast<float>(scale.x);
      l.scale_y = static_cast<float>(scale.y);
      l.first_x = static_cast<int>(std::floor(place.x));
      l.first_y = static_cast<int>(std::floor(place.y));
      l.rest_x = static_cast<float>(place.x - l.first_x);
      l.rest_y = static_cast<float>(place.y - l.first_y);
    }
    for (std::size_t n = 0; n < corners.size(); ++n) level[n] = static_cast<float>(corners[n] - first);
  }

  std::array<BlockLevel, kMostBlockLevels> levels;
  std::size_t count = 0;
  std::array<float, 4> level{};
};

// Finds the places of the next block before it takes the colours of this one, so that these are in reach by then.
void DomePainter::draw(const PixelSquare& square, const GroundRanges& ground, const DomeMask& mask,
                       const std::function<void(const DomeColours&)>& paint) const {
  const SquareRays rays = rays_of(square);
  const Levels levels = levels_of(square);
  struct Found {
    DomeColours out;
    BlockPyramid pyramid;
    bool has_places = false;
    bool is_any = false;
  };
  std::array<Found, 2> found;
  std::size_t next = 0;
  const auto colours_of = [&](const Found& f) {
    return BlockColours{
        {f.pyramid.levels.data(), f.pyramid.count}, f.pyramid.level, placed_.image.is_full_circle, steps_};
  };
  const auto finish = [&](Found& f) {
    if (!f.is_any) return;
    if (f.has_places) {
      take_colours(colours_of(f), f.out.places, f.out.words);
    } else {
      find_pixels(f.out.block, ground, f.out);
    }
    f.is_any = false;
    paint(f.out);
  };
  for_blocks(square, [&](const PixelSquare& block) {
    Found& f = found[next];
    f.out.block = block;
    f.is_any = true;
    const auto i = static_cast<std::size_t>((block.x0 - square.x0) / kDomeBlock_px);
    const auto j = static_cast<std::size_t>((block.y0 - square.y0) / kDomeBlock_px);
    const std::array<double, 4> corners{levels[j][i], levels[j][i + 1], levels[j + 1][i], levels[j + 1][i + 1]};
    const auto [low, high] = std::ranges::minmax(corners);
    BlockOrigin origin;
    f.has_places =
        std::isfinite(low) && high - low <= kMostLevels &&
        find_block(rays, square, mask.is_before_all ? nullptr : &ground, block, origin, f.out.places);
    if (f.has_places) {
      f.pyramid.fill(*this, origin, corners);
      fetch_ahead(colours_of(f), f.out.places);
    }
    next = 1 - next;
    finish(found[next]);
  });
  finish(found[1 - next]);
}

}  // namespace objects
