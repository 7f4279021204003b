#include "vpe/voxel/smooth/smooth_caster.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "vpe/base/object_pool.h"
#include "vpe/core/frame.h"
#include "vpe/voxel/smooth/smooth_ray.h"

namespace vpe::voxel {

namespace {

constexpr int kSide = 8;  // of a bundle, pixels
constexpr int kRays = kSide * kSide;
constexpr int kItem = 8;  // bundles along a side of what a thread takes at a time
// Blocks narrower than this many bundles are not divided by a bundle.
constexpr double kBundleWidths = 2;
using Mask = std::uint64_t;

// What is known of a tile that rays came near.
struct Seen {
  double nearest_m = std::numeric_limits<double>::infinity();  // range of a hit
  double deviation_m = 0;
};
using SeenTiles = std::unordered_map<SmoothGround::Index, Seen>;

// The memory of one thread: tiles that it used last, and those that it saw.
struct BundleScratch {
  struct Slot {
    SmoothGround::Index index = ~SmoothGround::Index{0};
    std::shared_ptr<const SmoothTile> tile;
    Seen* seen = nullptr;
  };
  std::array<Slot, 512> slots;
  PatchCache patches;
  SeenTiles seen;
};

// Everything that is the same for all bundles of an image.
struct SmoothImage {
  const SmoothGround& ground;
  const core::View& view;
  const SmoothForm& form;
  const SmoothPixels& pixels;
  core::SubRectangle part;
  std::array<int, mars::kFaces> faces{};  // nearest first
  double focal_px = 1;
  double planet_m = 0;
  double highest_m = 0;  // bound of the distance of all ground from the centre
  glm::dvec2 principal_px{0, 0};

  glm::dvec3 ray(int x, int y) const {
    const double px = part.x + x + 0.5;
    const double py = part.y + y + 0.5;
    if (view.projection != core::Projection::kPerspective) return core::pixel_ray(view, px, py);
    const mars::Axes& axes = view.camera.axes;
    return glm::normalize(axes.right * (px - principal_px.x) + axes.up * (principal_px.y - py) +
                          axes.forward * focal_px);
  }
};

// The rays of a square of pixels.
class Bundle {
 public:
  Bundle(const SmoothImage& image, BundleScratch& scratch) : image_(image), scratch_(scratch) {}

  void cast(int x0, int y0) {
    const core::SubRectangle& part = image_.part;
    const glm::dvec3& camera_m = image_.view.camera.position_m;
    const double square = glm::dot(camera_m, camera_m);
    const double top2 = image_.highest_m * image_.highest_m;
    left_ = 0;
    camera2_ = square;
    steepest_ = std::numeric_limits<double>::infinity();
    glm::dvec3 sum{0, 0, 0};
    for (int y = 0; y < kSide && y0 + y < part.height; ++y) {
      for (int x = 0; x < kSide && x0 + x < part.width; ++x) {
        const std::size_t at = place(x0 + x, y0 + y);
        if (!image_.pixels.is_wanted.empty() && image_.pixels.is_wanted[at] == 0) continue;
        image_.pixels.range_m[at] = core::kSkyRange;
        if (!image_.pixels.normals.empty()) image_.pixels.normals[at] = {};
        const glm::dvec3 ray = image_.ray(x0 + x, y0 + y);
        // Where it is not above all ground.
        const double along = glm::dot(camera_m, ray);
        const double rest = along * along - square + top2;
        if (!(rest >= 0)) continue;
        const double half = std::sqrt(rest);
        if (!(half >= along)) continue;
        const std::size_t n = static_cast<std::size_t>(y * kSide + x);
        reach_[n] = {std::max(0.0, -along - half), half - along};
        direction_[n] = ray;
        place_[n] = at;
        sum += ray;
        steepest_ = std::min(steepest_, along);
        left_ |= Mask{1} << n;
      }
    }
    if (left_ == 0) return;
    axis_ = glm::normalize(sum);
    double least = 1;
    for (Mask m = left_; m != 0; m &= m - 1) least = std::min(least, glm::dot(axis_, direction_[index(m)]));
    // Squares of a round image are small; what is not is taken whole.
    cosine_ = least - 1e-12;
    camera_m_ = std::sqrt(square);
    // The longest way from the axis to a direction.
    spread_ = std::sqrt(std::max(2 - 2 * least, 0.0)) + 1e-12;
    sine_ = cosine_ > 0 ? std::sqrt(1 - cosine_ * cosine_) : 1;
    for (const int face : image_.faces) {
      if (left_ == 0) return;
      face_ = static_cast<mars::Face>(face);
      has_rays_ = false;
      const FaceRay axis(face_, camera_m, axis_);
      camera_on_face_ = axis.e;
      axis_on_face_ = axis.d;
      visit(static_cast<SmoothGround::Index>(face));
    }
  }

 private:
  static std::size_t index(Mask m) { return static_cast<std::size_t>(std::countr_zero(m)); }
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.part.width) +
           static_cast<std::size_t>(x);
  }

  // Returns whether a ray of the bundle may come into a ball, there as near to the planet's centre as `highest_m`, and
  // over the rectangle of chart.
  bool may_meet(const glm::dvec3& centre_m, double radius_m, double highest_m,
                const mars::ChartRect& rect) const {
    const glm::dvec3 to = centre_m - image_.view.camera.position_m;
    const double square = glm::dot(to, to);
    const double distance_m = std::sqrt(square);
    // The distance from the planet's centre on the steepest ray, where it may be in the ball.
    const double s = std::clamp(-steepest_, std::max(distance_m - radius_m, 0.0), distance_m + radius_m);
    if (camera2_ + s * (2 * steepest_ + s) > highest_m * highest_m + 1e-13 * (camera2_ + s * s)) return false;
    // A side's plane goes through the planet's centre. On the rays its distance is of first degree.
    const double s0 = std::max(distance_m - radius_m, 0.0);
    const double s1 = distance_m + radius_m;
    const auto is_beyond = [&](double at_camera, double on_axis, double normal) {
      const double most = on_axis + normal * spread_;
      const double slack = 1e-12 * normal * (distance_m + camera_m_);
      return at_camera + s0 * most < -slack && at_camera + s1 * most < -slack;
    };
    const glm::dvec3& e = camera_on_face_;
    const glm::dvec3& d = axis_on_face_;
    constexpr double kLongest = 1.5;  // of a normal (1, 0, -u)
    if (is_beyond(e.x - rect.u0 * e.z, d.x - rect.u0 * d.z, kLongest) ||
        is_beyond(rect.u1 * e.z - e.x, rect.u1 * d.z - d.x, kLongest) ||
        is_beyond(e.y - rect.v0 * e.z, d.y - rect.v0 * d.z, kLongest) ||
        is_beyond(rect.v1 * e.z - e.y, rect.v1 * d.z - d.y, kLongest))
      return false;
    if (distance_m <= radius_m || cosine_ <= 0) return true;
    const double along = glm::dot(to, axis_);
    if (along < -radius_m) return false;
    const double aside = std::sqrt(std::max(square - along * along, 0.0));
    return aside * cosine_ - along * sine_ <= radius_m * (1 + 1e-9) + 1e-12 * std::abs(along);
  }

  void set_rays() {
    for (Mask m = left_; m != 0; m &= m - 1)
      rays_[index(m)] = FaceRay(face_, image_.view.camera.position_m, direction_[index(m)]);
    has_rays_ = true;
  }

  // The number of the child on the camera's side of the lines u and v.
  unsigned nearest_child(double u, double v) const {
    const mars::FaceAxes& axes = mars::face_axes(face_);
    const glm::dvec3& camera_m = image_.view.camera.position_m;
    const double out = glm::dot(axes.out, camera_m);
    const unsigned right = glm::dot(axes.right, camera_m) - u * out > 0 ? 1 : 0;
    const unsigned up = glm::dot(axes.up, camera_m) - v * out > 0 ? 2 : 0;
    return right + up;
  }

  void visit(SmoothGround::Index tile) {
    const SmoothGround::Ball ball = image_.ground.ball(tile, image_.form.exaggeration);
    if (!may_meet(ball.centre_m, ball.radius_m, image_.planet_m + ball.highest_m, ball.rect)) return;
    const lod::TileTree& tree = image_.ground.tree();
    if (!tree[tile].has_children) {
      meet_tile(tile);
      return;
    }
    const SmoothGround::Index first = tree.first_child(tile);
    const mars::ChartRect corner = image_.ground.ball(first, image_.form.exaggeration).rect;
    const unsigned nearest = nearest_child(corner.u1, corner.v1);
    for (const unsigned turn : {0U, 1U, 2U, 3U}) {
      visit(first + (nearest ^ turn));
      if (left_ == 0) return;
    }
  }

  BundleScratch::Slot& slot(SmoothGround::Index tile) {
    BundleScratch::Slot& slot = scratch_.slots[tile % scratch_.slots.size()];
    if (slot.index != tile) {
      slot = {};
      scratch_.patches.clear();
      slot.tile = image_.ground.tile(tile, image_.form.patch);
      slot.index = tile;
    }
    return slot;
  }

  // Blocks are visited by the bundle while they are wider than it; then its rays go on alone.
  void meet_tile(SmoothGround::Index index_of_tile) {
    if (!has_rays_) set_rays();
    BundleScratch::Slot& held = slot(index_of_tile);
    tile_index_ = index_of_tile;
    visit_block(held, {held.tile->levels(), 0, 0});
  }

  void visit_block(BundleScratch::Slot& held, const TileBlock& block) {
    const SmoothTile& tile = *held.tile;
    const auto line = [&block](const std::vector<double>& lines, int k) {
      return lines[static_cast<std::size_t>(k) << block.b];
    };
    const double u0 = line(tile.u_lines(), block.i);
    const double u1 = line(tile.u_lines(), block.i + 1);
    const double v0 = line(tile.v_lines(), block.j);
    const double v1 = line(tile.v_lines(), block.j + 1);
    const SmoothTile::Bounds& bounds = tile.bounds(block.b, block.i, block.j);
    // A ball about the block: the middle of its directions and radii.
    const double u = 0.5 * (u0 + u1);
    const double v = 0.5 * (v0 + v1);
    const double length = std::sqrt(1 + u * u + v * v);
    const double reach = 0.5 * std::sqrt((u1 - u0) * (u1 - u0) + (v1 - v0) * (v1 - v0));
    const double low = image_.planet_m + image_.form.exaggeration * static_cast<double>(bounds.low_m);
    const double high = image_.planet_m + image_.form.exaggeration * static_cast<double>(bounds.high_m);
    const mars::FaceAxes& axes = mars::face_axes(face_);
    const double scale = 0.5 * (low + high) / length;
    const glm::dvec3 centre_m = scale * (axes.right * u + axes.up * v + axes.out);
    // Directions of points of the cube's face are no farther apart than the points.
    const double radius_m = 0.5 * (high - low) + high * reach / std::max(length - reach, 1.0);
    if (!may_meet(centre_m, radius_m, high, {face_, u0, u1, v0, v1})) return;
    const double distance_m = glm::length(centre_m - image_.view.camera.position_m);
    if (block.b > 1 && radius_m > kBundleWidths * sine_ * distance_m) {
      const int half = block.b - 1;
      const auto middle = [half](const std::vector<double>& lines, int k) {
        return lines[static_cast<std::size_t>(2 * k + 1) << half];
      };
      const unsigned nearest = nearest_child(middle(tile.u_lines(), block.i), middle(tile.v_lines(), block.j));
      for (const unsigned turn : {0U, 1U, 2U, 3U}) {
        const unsigned child = nearest ^ turn;
        visit_block(held, {half, 2 * block.i + static_cast<int>(child & 1),
                           2 * block.j + static_cast<int>(child >> 1)});
        if (left_ == 0) return;
      }
      return;
    }
    for (Mask m = left_; m != 0; m &= m - 1) {
      const std::size_t n = index(m);
      RaySegment segment = reach_[n];
      if (!cut_to_rect(rays_[n], u0, u1, v0, v1, segment)) continue;
      TileMeeting found;
      bool is_near = false;
      const bool is_met = meet_block(tile, block, image_.planet_m, image_.form.exaggeration, rays_[n], segment,
                                     scratch_.patches, found, is_near);
      if (is_near && held.seen == nullptr) {
        held.seen = &scratch_.seen[tile_index_];
        held.seen->deviation_m = image_.ground.deviation_m(tile, image_.form.exaggeration);
      }
      if (!is_met) continue;
      held.seen->nearest_m = std::min(held.seen->nearest_m, found.s);
      left_ &= ~(Mask{1} << n);
      finish(n, tile, found);
    }
  }

  void finish(std::size_t n, const SmoothTile& tile, const TileMeeting& found) {
    image_.pixels.range_m[place_[n]] = static_cast<float>(found.s);
    if (image_.pixels.normals.empty()) return;
    const glm::dvec3 point_m = image_.view.camera.position_m + found.s * direction_[n];
    const double out = glm::dot(mars::face_axes(face_).out, point_m);
    const auto i = static_cast<std::size_t>(found.i);
    // The width of the cell, in pixels that face the ray.
    const double cell_px =
        (tile.u_lines()[i + 1] - tile.u_lines()[i]) * out * image_.focal_px / std::max(found.s, 1e-9);
    const double share = std::clamp(cell_px - 1, 0.0, 1.0);
    if (share <= 0) return;
    const SmoothPatch& patch = scratch_.patches.get(tile, found.i, found.j, image_.form.exaggeration);
    const glm::dvec3 normal =
        patch_point(tile, patch, image_.form.exaggeration, point_m, found.i, found.j).normal;
    image_.pixels.normals[place_[n]] = {static_cast<float>(normal.x), static_cast<float>(normal.y),
                                        static_cast<float>(normal.z), static_cast<float>(share)};
  }

  const SmoothImage& image_;
  BundleScratch& scratch_;
  mars::Face face_ = mars::Face::kPlusX;
  bool has_rays_ = false;
  Mask left_ = 0;
  glm::dvec3 axis_{0, 0, 1};
  double cosine_ = 1;
  double sine_ = 0;
  double camera2_ = 0;   // its square
  double steepest_ = 0;  // least product of camera and direction
  double camera_m_ = 0;  // the camera's distance from the centre
  double spread_ = 0;
  glm::dvec3 camera_on_face_{0, 0, 0};
  glm::dvec3 axis_on_face_{0, 0, 1};
  std::array<glm::dvec3, kRays> direction_;
  std::array<std::size_t, kRays> place_;
  std::array<RaySegment, kRays> reach_;  // where the ray may meet any ground
  std::array<FaceRay, kRays> rays_;
  SmoothGround::Index tile_index_ = 0;
};

SmoothUsage usage_of(const SmoothGround& ground, const SmoothImage& image, const SeenTiles& seen) {
  SmoothUsage usage;
  const lod::TileTree& tree = ground.tree();
  const cull::Camera camera = cull::make_camera(image.view.camera.position_m);
  for (const auto& [index, tile] : seen) {
    const cull::BoundingRegion region = tree.region(index, image.form.exaggeration, tile.deviation_m);
    const double distance_m = cull::min_distance_m(camera, cull::nearest_chord2(region.rect, camera.direction),
                                                   region.min_radius_m, region.max_radius_m);
    usage.tiles.tiles.push_back({index, index, distance_m, 0, 0});
    usage.tiles.steepest_slope =
        std::max(usage.tiles.steepest_slope, 2 * tree.steepest_slope(tree[index], image.form.exaggeration));
    usage.smoothing_m = std::max(usage.smoothing_m, tile.deviation_m);
    if (!(tile.nearest_m < std::numeric_limits<double>::infinity())) continue;
    const double clear_m = std::max(tile.nearest_m - tile.deviation_m, distance_m);
    usage.smoothing_px =
        std::max(usage.smoothing_px, tile.deviation_m * image.focal_px / std::max(clear_m, 0.0));
  }
  std::sort(usage.tiles.tiles.begin(), usage.tiles.tiles.end(),
            [](const TileUse& a, const TileUse& b) { return a.tile < b.tile; });
  update_totals(tree, usage.tiles);
  return usage;
}

}  // namespace

void SmoothUsage::add(const SmoothUsage& other, const lod::TileTree& tree) {
  tiles.add(other.tiles, tree);
  smoothing_m = std::max(smoothing_m, other.smoothing_m);
  smoothing_px = std::max(smoothing_px, other.smoothing_px);
}

SmoothUsage cast_smooth(const SmoothGround& ground, const core::View& view, const SmoothForm& form,
                        base::ThreadPool& pool, const SmoothPixels& pixels) {
  SmoothImage image{
      ground, view, form, pixels, core::drawn_part(view), {}, core::focal_px(view), ground.radius_m(), 0, {}};
  image.principal_px = {0.5 * view.width + view.principal_offset_px.x,
                        0.5 * view.height + view.principal_offset_px.y};
  for (int face = 0; face < mars::kFaces; ++face) {
    const SmoothGround::Ball ball = ground.ball(static_cast<SmoothGround::Index>(face), form.exaggeration);
    image.highest_m = std::max(image.highest_m, ground.radius_m() + ball.highest_m);
  }
  std::iota(image.faces.begin(), image.faces.end(), 0);
  // A ray leaves the faces nearer to its camera first: it crosses each plane between two faces once at most.
  const auto towards = [&](int face) {
    return glm::dot(mars::face_axes(static_cast<mars::Face>(face)).out, view.camera.position_m);
  };
  std::stable_sort(image.faces.begin(), image.faces.end(),
                   [&](int a, int b) { return towards(a) > towards(b); });

  constexpr int kStep = kSide * kItem;
  const int columns = (image.part.width + kStep - 1) / kStep;
  const int rows = (image.part.height + kStep - 1) / kStep;
  SeenTiles seen;
  std::mutex mutex;
  pool.run(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), [&](std::size_t item) {
    BundleScratch scratch;
    Bundle bundle(image, scratch);
    const int x0 = static_cast<int>(item) % columns * kStep;
    const int y0 = static_cast<int>(item) / columns * kStep;
    for (int y = y0; y < std::min(y0 + kStep, image.part.height); y += kSide)
      for (int x = x0; x < std::min(x0 + kStep, image.part.width); x += kSide) bundle.cast(x, y);
    const std::lock_guard lock(mutex);
    for (const auto& [index, tile] : scratch.seen) {
      Seen& all = seen[index];
      all.nearest_m = std::min(all.nearest_m, tile.nearest_m);
      all.deviation_m = tile.deviation_m;
    }
  });
  return usage_of(ground, image, seen);
}

}  // namespace vpe::voxel
