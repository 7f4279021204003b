#include "vpe/voxel/volume/volume_caster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "vpe/voxel/columns/pixel_lines.h"
#include "vpe/voxel/volume/pixel_rays.h"

namespace vpe::voxel {

namespace {

constexpr float kNoGround = std::numeric_limits<float>::infinity();

void check_cast(const TerrainVolume& volume, const BoundaryCells& cells, const core::View& view,
                const VolumeCastOptions& options) {
  if (const std::string problem = core::check(view); !problem.empty()) throw std::invalid_argument(problem);
  if (view.projection != core::Projection::kPerspective || view.part.width != 0)
    throw std::invalid_argument("casting of a volume: expected a whole perspective view");
  if (cells.columns() != volume.columns() - 1 || cells.rows() != volume.rows() - 1)
    throw std::invalid_argument("casting of a volume: the boundary cells are those of another volume");
  if (!(options.interval >= 0.01 && options.interval <= 10))
    throw std::invalid_argument("casting of a volume: expected an interval of 0.01 to 10 voxels");
}

// Casts rays of one line of pixels after the other.
class LineCaster {
 public:
  LineCaster(const TerrainVolume& volume, const BoundaryCells& cells, const VolumeCastOptions& options)
      : volume_(volume),
        cells_(cells),
        options_(options),
        last_{volume.columns() - 1.0, volume.rows() - 1.0, volume.levels() - 1.0},
        surface_(volume.threshold() + 0.5) {}

  // Returns the range of the next ray of a line; `before` is the sample at which the ray before it ended.
  float cast(const glm::dvec3& origin, const glm::dvec3& direction, std::int64_t& before);

  const VolumeCounts& counts() const { return counts_; }

 private:
  struct Ray {
    glm::dvec3 origin;
    glm::dvec3 direction;
    std::int64_t first = 0;  // samples within the volume
    std::int64_t last = -1;
  };

  bool enter(Ray& ray) const;
  bool is_ground(const Ray& ray, std::int64_t n);
  glm::dvec3 at(const Ray& ray, double t) const { return ray.origin + t * ray.direction; }
  double density_over(const Ray& ray, double t) { return volume_.density(at(ray, t)) - surface_; }
  float found(const Ray& ray, std::int64_t n);

  const TerrainVolume& volume_;
  const BoundaryCells& cells_;
  const VolumeCastOptions& options_;
  glm::dvec3 last_;
  double surface_;
  VolumeCounts counts_;
};

// Cuts a ray to the volume. Returns false if no sample lies in it.
bool LineCaster::enter(Ray& ray) const {
  double t0 = 0;
  double t1 = std::numeric_limits<double>::max();
  for (int axis = 0; axis < 3; ++axis) {
    const double rate = ray.direction[axis];
    const double from = ray.origin[axis];
    if (rate == 0) {
      if (from < 0 || from > last_[axis]) return false;
      continue;
    }
    const double a = -from / rate;
    const double b = (last_[axis] - from) / rate;
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b));
  }
  if (!(t0 <= t1)) return false;
  ray.first = static_cast<std::int64_t>(std::ceil(t0 / options_.interval));
  ray.last = static_cast<std::int64_t>(std::floor(t1 / options_.interval));
  return ray.first <= ray.last;
}

bool LineCaster::is_ground(const Ray& ray, std::int64_t n) {
  ++counts_.samples;
  const glm::dvec3 p = at(ray, static_cast<double>(n) * options_.interval);
  if (options_.uses_cells || options_.is_approximate) {
    const int i = std::clamp(static_cast<int>(p.x), 0, volume_.columns() - 2);
    const int j = std::clamp(static_cast<int>(p.y), 0, volume_.rows() - 2);
    const int k = std::clamp(static_cast<int>(p.z), 0, volume_.levels() - 2);
    const CellFlag flag = cells_.flag(i, j, k);
    if (flag == CellFlag::kAir) return false;
    if (flag == CellFlag::kGround || options_.is_approximate) return true;
  }
  ++counts_.interpolations;
  return volume_.density(p) > surface_;
}

float LineCaster::found(const Ray& ray, std::int64_t n) {
  double t = static_cast<double>(n) * options_.interval;
  if (options_.refines && !options_.is_approximate && n > ray.first) {
    double low = t - options_.interval;
    double below = density_over(ray, low);
    double above = density_over(ray, t);
    if (below <= 0 && above > 0) {
      // Halving, and the chord at last.
      double high = t;
      for (int step = 0; step < 6; ++step) {
        const double middle = 0.5 * (low + high);
        const double value = density_over(ray, middle);
        (value > 0 ? high : low) = middle;
        (value > 0 ? above : below) = value;
      }
      t = low + (high - low) * (below / (below - above));
      counts_.interpolations += 8;
    }
  }
  return static_cast<float>(t);
}

float LineCaster::cast(const glm::dvec3& origin, const glm::dvec3& direction, std::int64_t& before) {
  ++counts_.rays;
  Ray ray{origin, direction};
  if (!enter(ray)) return kNoGround;
  std::int64_t n = ray.first;
  if (options_.start == VolumeStart::kPaper) {
    n = std::clamp(before, ray.first, ray.last);
    if (n > ray.first && is_ground(ray, n)) {
      // The hit lies between here and the camera.
      while (n > ray.first && is_ground(ray, n - 1)) {
        --n;
        ++counts_.retraced;
      }
      before = n;
      return found(ray, n);
    }
  } else if (options_.start == VolumeStart::kChecked) {
    const std::int64_t until = std::clamp(before, ray.first, ray.last);
    if (until > ray.first) {
      const double t0 = static_cast<double>(ray.first) * options_.interval;
      const double t1 = static_cast<double>(until) * options_.interval;
      const double air = cells_.first_low(origin, direction, t0, t1);
      n = std::clamp(static_cast<std::int64_t>(std::floor(air / options_.interval)), ray.first, until);
    }
  }
  for (; n <= ray.last; ++n) {
    if (!is_ground(ray, n)) continue;
    before = n;
    return found(ray, n);
  }
  before = ray.last;
  return kNoGround;
}

}  // namespace

VolumeRanges cast_volume(const TerrainVolume& volume, const BoundaryCells& cells, const core::View& view,
                         const VolumeCastOptions& options, base::ThreadPool& pool) {
  check_cast(volume, cells, view, options);
  VolumeRanges result{view.width, view.height, {}, {}};
  result.range.assign(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height), kNoGround);
  const PixelRays rays(view);
  const mars::Axes& axes = view.camera.axes;
  // The image of z: along it the elevation rises.
  const PixelLines lines(view.width, view.height, {axes.right.z, -axes.up.z});
  std::vector<VolumeCounts> counts(static_cast<std::size_t>(lines.count()));
  pool.run(counts.size(), [&](std::size_t n) {
    std::vector<PixelLines::Pixel> pixels;
    lines.get(static_cast<int>(n), pixels);
    LineCaster caster(volume, cells, options);
    std::int64_t before = 0;
    for (const PixelLines::Pixel& pixel : pixels) {
      const glm::dvec3 direction = rays.through(pixel.x, pixel.y);
      result.range[static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(view.width) +
                   static_cast<std::size_t>(pixel.x)] = caster.cast(view.camera.position_m, direction, before);
    }
    counts[n] = caster.counts();
  });
  for (const VolumeCounts& part : counts) {
    result.counts.rays += part.rays;
    result.counts.samples += part.samples;
    result.counts.interpolations += part.interpolations;
    result.counts.retraced += part.retraced;
  }
  return result;
}

}  // namespace vpe::voxel
