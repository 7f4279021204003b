#include "vpe/voxel/cast/volume_rays.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <utility>

#include "mars/geodesy/cube.h"
#include "vpe/voxel/columns/grid_ray.h"

namespace vpe::voxel {

namespace {

constexpr double kNoHit = std::numeric_limits<double>::infinity();
// Of chart coordinates: places on the border of a rectangle belong to it in spite of rounding.
constexpr double kSlack = 1e-11;
// From one grid to the next, of the distance from the centre and the range.
constexpr double kStepOver = 1e-9;
// Samples in air before blocks are asked again.
constexpr int kAirRun = 24;
// A hit is moved by halving the way from the sample before it, and by the chord of the rest.
constexpr int kHalvings = 6;
// Voxels above its surface that a boundary cell reaches, and more.
constexpr double kReachOfCells = 3;

// Returns the least distance from the centre on a ray between two ranges.
double least_radius_m(const glm::dvec3& camera, const glm::dvec3& ray, double from, double to) {
  const double t = std::clamp(-glm::dot(camera, ray), from, to);
  return glm::length(camera + t * ray);
}

struct ChartSquare {
  double u0 = -1;
  double u1 = 1;
  double v0 = -1;
  double v1 = 1;
};

// Cuts [begin, end] to where a ray is over a part of a face.
void cut(const mars::FaceAxes& axes, const ChartSquare& square, const glm::dvec3& camera, const glm::dvec3& ray,
         double& begin, double& end) {
  const glm::dvec3 e{glm::dot(camera, axes.right), glm::dot(camera, axes.up), glm::dot(camera, axes.out)};
  const glm::dvec3 d{glm::dot(ray, axes.right), glm::dot(ray, axes.up), glm::dot(ray, axes.out)};
  const auto side = [&](double start, double rate) {
    if (rate > 0) {
      begin = std::max(begin, -start / rate);
    } else if (rate < 0) {
      end = std::min(end, -start / rate);
    } else if (start < 0) {
      end = -kNoHit;
    }
  };
  const double u0 = square.u0 - kSlack;
  const double u1 = square.u1 + kSlack;
  const double v0 = square.v0 - kSlack;
  const double v1 = square.v1 + kSlack;
  side(e.x - u0 * e.z, d.x - u0 * d.z);
  side(u1 * e.z - e.x, u1 * d.z - d.x);
  side(e.y - v0 * e.z, d.y - v0 * d.z);
  side(v1 * e.z - e.y, v1 * d.z - d.y);
}

// A ray in the voxels of a grid.
class VoxelRay {
 public:
  VoxelRay(const GridVolume& volume, const glm::dvec3& camera, const glm::dvec3& ray, double radius_m)
      : grid_(camera, ray, 0, volume.face, volume.frame, volume.reference, radius_m),
        per_level_(1 / volume.level_m) {}

  double depth(double t) const { return grid_.at().w + t * grid_.per_m().w; }
  glm::dvec3 at(double t) const {
    const glm::dvec4 p = grid_.at() + t * grid_.per_m();
    const double inverse = 1 / p.w;
    return {p.x * inverse, p.y * inverse, p.z * inverse * per_level_};
  }

  // Returns the range between two from which on the ray may be in a cell that is not air.
  double first_low(const BlockMaxima& maxima, double from, double to) const {
    const glm::dvec3 begin = at(from);
    const glm::dvec3 way = at(to) - begin;
    const double length = glm::length(way);
    if (!(length > 0)) return from;
    const double share = maxima.first_low(begin, way / length, 0, length) / length;
    if (share >= 1) return to;
    // Ways in the chart are not even along the ray.
    const double w0 = depth(from);
    const double w1 = depth(to);
    return from + (to - from) * (share * w0 / (share * w0 + (1 - share) * w1));
  }

 private:
  GridRay grid_;
  double per_level_;
};

bool is_in_ground(const GridVolume& volume, const glm::dvec3& at, bool is_far) {
  const BandVolume& voxels = volume.voxels;
  const int i = std::clamp(static_cast<int>(at.x), 0, voxels.columns() - 2);
  const int j = std::clamp(static_cast<int>(at.y), 0, voxels.rows() - 2);
  const CellFlag flag = voxels.flag(i, j, static_cast<int>(std::floor(std::clamp(at.z, -1e6, 1e6))));
  if (flag != CellFlag::kBoundary) return flag == CellFlag::kGround;
  return is_far || voxels.density(at) > voxels.surface();
}

}  // namespace

VolumeRays::VolumeRays(const ColumnWalk& walk, const GridVolumeStore& store, ThreadLocalTiles& tiles,
                       const VolumeForm& form)
    : walk_(walk),
      store_(store),
      tiles_(tiles),
      form_(form),
      voxels_beyond_(form.band.filter == VolumeFilter::kGaussian ? std::ceil(4 * form.band.sigma) + 1 : 1) {
  for (int face = 0; face < mars::kFaces; ++face)
    highest_m_ = std::max(highest_m_, top_m(static_cast<lod::TileTree::Index>(face)));
  for (const auto& brick : form.bricks)
    highest_m_ = std::max(highest_m_, brick->highest_m(walk.camera().radius_m));
}

double VolumeRays::top_m(lod::TileTree::Index tile) {
  Top& top = tops_[tile % tops_.size()];
  if (top.tile != tile) top = {tile, make_top_m(tile)};
  return top.radius_m;
}

double VolumeRays::make_top_m(lod::TileTree::Index tile) const {
  const lod::TileTree& tree = walk_.tree();
  const lod::TileInfo& info = tree[tile];
  const double radius_m = walk_.camera().radius_m;
  const double top_m = radius_m + walk_.exaggeration() * info.max_height_m;
  // Beyond the border heights go on with the slopes beside it. Cells are up to half as wide again as the nominal one.
  const double voxel_m =
      1.5 * lod::nominal_side_m(info.key.level, std::max(radius_m, top_m)) / tree.shape().intervals();
  const double slope = std::min(tree.steepest_slope(info, walk_.exaggeration()), 1e6);
  return top_m + voxel_m * (kReachOfCells + voxels_beyond_ * slope);
}

const std::shared_ptr<const GridVolume>& VolumeRays::volume(lod::TileTree::Index tile, int i, int j,
                                                            const HeightGridFrame& frame) {
  const lod::TileKey& key = walk_.tree()[tile].key;
  const int place = j * kMostVolumeSide + i;
  Slot& slot = slots_[(tile * 7 + static_cast<unsigned>(5 * i + 3 * j)) % slots_.size()];
  if (!slot.volume || slot.tile != tile || slot.place != place) {
    auto found = store_.get(tiles_.any_grids(tile), i, j, key.face, frame, walk_.camera().radius_m, form_.band);
    slot = {tile, place, std::move(found)};
  }
  return slot.volume;
}

VolumeRays::Place VolumeRays::find(const glm::dvec3& camera_m, const glm::dvec3& ray, double at_m,
                                   double until_m) {
  const lod::TileTree& tree = walk_.tree();
  const mars::ChartPoint place = mars::chart_point(camera_m + at_m * ray);
  const mars::FaceAxes& axes = mars::face_axes(place.face);
  auto tile = static_cast<lod::TileTree::Index>(place.face);
  ChartSquare square;
  int level = 0;
  std::int32_t i = 0;
  std::int32_t j = 0;
  const auto halve = [&] {
    const double u = walk_.middle_line(level, i);
    const double v = walk_.middle_line(level, j);
    const bool east = place.u >= u;
    const bool north = place.v >= v;
    (east ? square.u0 : square.u1) = u;
    (north ? square.v0 : square.v1) = v;
    i = 2 * i + (east ? 1 : 0);
    j = 2 * j + (north ? 1 : 0);
    ++level;
    return (east ? 1U : 0U) + (north ? 2U : 0U);
  };
  Place found;
  const auto cut_to_square = [&] {
    found.begin_m = 0;
    found.end_m = until_m;
    cut(axes, square, camera_m, ray, found.begin_m, found.end_m);
    found.end_m = std::max(found.end_m, at_m);
  };
  const double here_m = glm::length(camera_m + at_m * ray);
  for (;;) {
    // Most rays are below the top of a tile where they are, and need not be followed over it.
    if (const double top = top_m(tile); here_m > top) {
      cut_to_square();
      if (least_radius_m(camera_m, ray, at_m, found.end_m) > top) return found;
    }
    if (walk_.ends_at(tile)) break;
    tile = tree.first_child(tile) + halve();
  }
  walk_.mark_used(tile);
  const lod::TileKey& key = tree[tile].key;
  const int per_side = grids_per_side(key.level, tree.shape().intervals());
  for (int k = 1; k < per_side; k *= 2) halve();
  HeightGridFrame frame;
  frame.intervals = tree.shape().intervals() / per_side;
  frame.u0 = square.u0;
  frame.du = (square.u1 - square.u0) / frame.intervals;
  frame.v0 = square.v0;
  frame.dv = (square.v1 - square.v0) / frame.intervals;
  cut_to_square();
  found.tile = tile;
  found.is_far = walk_.least_distance_m(tile) >= form_.near_m;
  found.volume = volume(tile, i - key.i * per_side, j - key.j * per_side, frame);
  return found;
}

void VolumeRays::find_bricks(const glm::dvec3& camera_m, const glm::dvec3& ray) {
  bricks_.clear();
  for (const auto& brick : form_.bricks) {
    const HeightGridFrame& frame = brick->frame;
    const ChartSquare square{frame.u0, frame.u0 + frame.intervals * frame.du, frame.v0,
                             frame.v0 + frame.intervals * frame.dv};
    BrickOnRay found{brick, 0, kNoHit};
    cut(mars::face_axes(brick->face), square, camera_m, ray, found.begin_m, found.end_m);
    if (found.begin_m <= found.end_m) bricks_.push_back(std::move(found));
  }
  std::sort(bricks_.begin(), bricks_.end(),
            [](const BrickOnRay& a, const BrickOnRay& b) { return a.begin_m < b.begin_m; });
}

double VolumeRays::cast_in(const Place& place, const glm::dvec3& camera_m, const glm::dvec3& ray,
                           double from_m) {
  const GridVolume& volume = *place.volume;
  const double radius_m = walk_.camera().radius_m;
  const VoxelRay voxels(volume, camera_m, ray, radius_m);
  // Samples lie at multiples of the step from the camera, wherever the search begins.
  const double step_m = form_.interval * volume.voxel_m;
  const double last = std::floor(place.end_m / step_m);
  double n = std::ceil(std::max(place.begin_m, from_m) / step_m);
  const auto skip = [&] {
    const double from = n * step_m;
    if (from < place.end_m)
      n = std::max(n, std::floor(voxels.first_low(volume.voxels.maxima(), from, place.end_m) / step_m));
  };
  const auto over = [&](double t) { return volume.voxels.density(voxels.at(t)) - volume.voxels.surface(); };
  // Returns where the surface is between a sample before it and one in the ground.
  const auto surface_between = [&](double low, double high) {
    double below = over(low);
    double above = over(high);
    // Ground at the border of a grid, or a cell that is ground as a whole.
    if (below > 0) return low;
    if (above <= 0) return high;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (low + high);
      const double value = over(middle);
      (value > 0 ? high : low) = middle;
      (value > 0 ? above : below) = value;
    }
    return low + (high - low) * (below / (below - above));
  };
  skip();
  for (int run = 0; n <= last; n += 1) {
    if (!is_in_ground(volume, voxels.at(n * step_m), place.is_far)) {
      if (++run % kAirRun == 0) skip();
      continue;
    }
    if (place.is_far) return n * step_m;
    return surface_between(std::max(place.begin_m, (n - 1) * step_m), n * step_m);
  }
  // Ground that begins between the last sample and the border would else be met behind the border.
  if (!(place.end_m < kNoHit) || !is_in_ground(volume, voxels.at(place.end_m), place.is_far)) return kNoHit;
  return place.is_far ? place.end_m : surface_between(std::max(place.begin_m, last * step_m), place.end_m);
}

double VolumeRays::cast_bricks(const glm::dvec3& from_m, const glm::dvec3& ray) {
  const double half = glm::dot(from_m, ray);
  const double rest = half * half - glm::dot(from_m, from_m) + highest_m_ * highest_m_;
  if (!(rest >= 0)) return kNoHit;
  find_bricks(from_m, ray);
  for (const BrickOnRay& brick : bricks_) {
    const double begin = std::max(brick.begin_m, -half - std::sqrt(rest));
    const double end = std::min(brick.end_m, -half + std::sqrt(rest));
    if (!(begin <= end)) continue;
    const Place place{brick.volume, 0, begin, end, brick.begin_m >= form_.near_m};
    if (const double hit = cast_in(place, from_m, ray, begin); hit < kNoHit) return hit;
  }
  return kNoHit;
}

double VolumeRays::cast(const glm::dvec3& camera_m, const glm::dvec3& ray) {
  const double half = glm::dot(camera_m, ray);
  const double rest = half * half - glm::dot(camera_m, camera_m) + highest_m_ * highest_m_;
  if (!(rest >= 0)) return kNoHit;
  const double end_m = -half + std::sqrt(rest);
  find_bricks(camera_m, ray);
  auto brick = bricks_.begin();
  for (double t = std::max(0.0, -half - std::sqrt(rest)); t <= end_m;) {
    while (brick != bricks_.end() && brick->end_m <= t) ++brick;
    const bool is_in_brick = brick != bricks_.end() && brick->begin_m <= t;
    Place place;
    if (is_in_brick) {
      place = {brick->volume, 0, brick->begin_m, std::min(brick->end_m, end_m), brick->begin_m >= form_.near_m};
    } else {
      place = find(camera_m, ray, t, brick != bricks_.end() ? std::min(brick->begin_m, end_m) : end_m);
    }
    if (is_in_brick) {
      const GridVolume& volume = *place.volume;
      seen_bricks_.deviation_m =
          std::max(seen_bricks_.deviation_m, (place.is_far ? volume.boundary_deviation_m : volume.deviation_m) +
                                                 form_.interval * volume.voxel_m);
      const double hit = cast_in(place, camera_m, ray, t);
      if (hit < kNoHit) {
        seen_bricks_.nearest_m = std::min(seen_bricks_.nearest_m, hit);
        return hit;
      }
    } else if (place.volume) {
      VolumeTile& seen = seen_[place.tile];
      const GridVolume& volume = *place.volume;
      // What is thinner than an interval may be missed, and hits lie within a share of it.
      seen.deviation_m =
          std::max(seen.deviation_m, (place.is_far ? volume.boundary_deviation_m : volume.deviation_m) +
                                         form_.interval * volume.voxel_m);
      const double hit = cast_in(place, camera_m, ray, t);
      if (hit < kNoHit) {
        seen.nearest_m = std::min(seen.nearest_m, hit);
        return hit;
      }
    }
    t = place.end_m + kStepOver * (walk_.camera().radius_m + place.end_m);
  }
  return kNoHit;
}

bool VolumeRays::is_ground(const glm::dvec3& place_m) {
  find_bricks(place_m, {0, 0, 0});
  const bool is_in_brick = !bricks_.empty();
  const Place place =
      is_in_brick ? Place{bricks_.front().volume, 0, 0, 0, form_.near_m == 0} : find(place_m, {0, 0, 0}, 0, 0);
  return place.volume &&
         is_in_ground(*place.volume, place.volume->voxel_of(place_m, walk_.camera().radius_m), place.is_far);
}

const GridVolume* VolumeRays::brick_at(const glm::dvec3& place_m) const {
  for (const auto& brick : form_.bricks) {
    if (!(glm::dot(place_m, mars::face_axes(brick->face).out) > 0)) continue;
    const mars::ChartPoint at = mars::chart_on(brick->face, place_m);
    const HeightGridFrame& frame = brick->frame;
    const double u = at.u - frame.u0;
    const double v = at.v - frame.v0;
    if (u >= 0 && u <= frame.intervals * frame.du && v >= 0 && v <= frame.intervals * frame.dv)
      return brick.get();
  }
  return nullptr;
}

double VolumeRays::ground_height_m(const glm::dvec3& up) {
  // Below the top of every tile, so that none is skipped.
  const double radius_m = walk_.camera().radius_m;
  const glm::dvec3 deep = 1e-3 * radius_m * up;
  const Place place = find(deep, {0, 0, 0}, 0, 0);
  const GridVolume& volume = *place.volume;
  glm::dvec3 at = volume.voxel_of(deep, radius_m);
  at.x = std::clamp(at.x, 0.0, volume.voxels.columns() - 1.0);
  at.y = std::clamp(at.y, 0.0, volume.voxels.rows() - 1.0);
  const int i = std::min(static_cast<int>(at.x), volume.voxels.columns() - 2);
  const int j = std::min(static_cast<int>(at.y), volume.voxels.rows() - 2);
  const BandVolume::Span& cells = volume.voxels.span(i, j);
  // Between two levels the density over a place is linear. That of a cell with no boundary passes none.
  const auto over = [&](int k) {
    return volume.voxels.density({at.x, at.y, static_cast<double>(k)}) - volume.voxels.surface();
  };
  int k = std::max<int>(cells.high, cells.low) + 1;
  double above = over(k);
  double below = over(k - 1);
  for (; below < 0 && k > cells.low; --k) {
    above = below;
    below = over(k - 2);
  }
  const double level = below < 0 || above > 0 ? k : k - 1 + below / (below - above);
  return volume.height_m({at.x, at.y, level}, radius_m);
}

}  // namespace vpe::voxel
