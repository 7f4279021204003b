#include "vpe/app/report/embree_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>

#include "vpe/base/parallel.h"

namespace vpe::app {

namespace {

constexpr std::size_t kPadding = 1;  // indices: Embree reads 16 bytes at the last triangle

}  // namespace

std::vector<lod::TileKey> tiles_in_sight(const paging::PlanetFile& planet, const glm::dvec3& camera_m) {
  // The sphere of the lowest radius hides a point at the highest radius beyond the sum of both horizon dips.
  const double low_m = planet.meta().lowest_radius_m;
  const auto dip_rad = [&](double radius_m) { return std::acos(std::min(1.0, low_m / radius_m)); };
  const double reach_rad = dip_rad(glm::length(camera_m)) + dip_rad(planet.meta().highest_radius_m);
  std::vector<lod::TileKey> keys;
  for (const lod::TileInfo& tile : planet.tree().tiles()) {
    if (tile.has_children) continue;
    const mars::Cap cap = lod::bounding_cap(tile.key);
    if (mars::angle_between_rad(cap.centre, camera_m) <= reach_rad + cap.radius_rad) keys.push_back(tile.key);
  }
  return keys;
}

std::int64_t triangle_count(const paging::PlanetFile& planet, const std::vector<lod::TileKey>& tiles) {
  const std::int64_t n = planet.meta().tile.intervals();
  return 2 * n * n * static_cast<std::int64_t>(tiles.size());
}

EmbreeScene::EmbreeScene(const paging::PlanetFile& planet, const std::vector<lod::TileKey>& tiles,
                         const glm::dvec3& camera_m, const EmbreeOptions& options)
    : triangles_(triangle_count(planet, tiles)) {
  const std::string config = "threads=" + std::to_string(std::max(0, options.threads));
  device_ = rtcNewDevice(config.c_str());
  if (device_ == nullptr) throw std::runtime_error("Embree: cannot make a device: " + config);
  rtcSetDeviceMemoryMonitorFunction(
      device_,
      [](void* self, ssize_t bytes, bool) {
        static_cast<EmbreeScene*>(self)->bytes_ += bytes;
        return true;
      },
      this);
  scene_ = rtcNewScene(device_);
  rtcSetSceneBuildQuality(scene_, options.quality);
  rtcSetSceneFlags(scene_, options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);

  const int n = planet.meta().tile.intervals();
  if (options.shape == EmbreeShape::kTriangles) {
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + n - i); };
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        for (const std::uint32_t v :
             {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)})
          indices_.push_back(v);
      }
    }
    indices_.resize(indices_.size() + kPadding);
    bytes_ += static_cast<std::int64_t>(indices_.size() * sizeof(std::uint32_t));
  }
  base::parallel_for(tiles.size(), options.threads, [&](std::size_t t) {
    add_tile(planet, tiles[t], static_cast<unsigned>(t), camera_m, options);
  });
  const auto start = std::chrono::steady_clock::now();
  rtcCommitScene(scene_);
  build_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  check("building its scene");
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreeScene::check(const char* what) const {
  const RTCError error = rtcGetDeviceError(device_);
  if (error == RTC_ERROR_NONE) return;
  throw std::runtime_error(std::string("Embree: ") + what + ": " +
                           (error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory; ask for fewer tiles"
                                                             : "error " + std::to_string(error)));
}

void EmbreeScene::add_tile(const paging::PlanetFile& planet, const lod::TileKey& key, unsigned id,
                           const glm::dvec3& camera_m, const EmbreeOptions& options) {
  const lod::Posts posts = planet.heights(key).posts;
  const lod::GridLines lines = lod::grid_lines(key, posts.intervals);
  const bool grid = options.shape == EmbreeShape::kGrid;
  RTCGeometry geometry = rtcNewGeometry(device_, grid ? RTC_GEOMETRY_TYPE_GRID : RTC_GEOMETRY_TYPE_TRIANGLE);
  const auto side = static_cast<std::size_t>(posts.side());
  auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), side * side));
  if (vertex == nullptr) check("vertices");
  // Columns run from east to west: Embree splits a grid's cells along the other diagonal than the reference
  // surface.
  for (std::size_t j = 0; j < side; ++j) {
    for (std::size_t i = side; i-- > 0;) {
      const glm::dvec3 p = mars::cube_point(key.face, lines.u[i], lines.v[j]);
      const double radius_m = planet.radius_m() + posts.height_m[j * side + i];
      const glm::dvec3 at = p * (radius_m / mars::cube_length(p)) - camera_m;
      for (const double x : {at.x, at.y, at.z}) *vertex++ = static_cast<float>(x);
    }
  }
  if (grid) {
    auto* one = static_cast<RTCGrid*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
    if (one == nullptr) check("a grid");
    const auto width = static_cast<unsigned short>(side);
    *one = {0, static_cast<unsigned>(side), width, width};
  } else {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices_.data(), 0,
                               3 * sizeof(std::uint32_t), (indices_.size() - kPadding) / 3);
  }
  rtcSetGeometryBuildQuality(geometry, options.quality);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, id);
  rtcReleaseGeometry(geometry);
}

double EmbreeScene::cast(const glm::dvec3& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  ray.ray.dir_x = static_cast<float>(direction.x);
  ray.ray.dir_y = static_cast<float>(direction.y);
  ray.ray.dir_z = static_cast<float>(direction.z);
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0U;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_, &context, &ray);
  return static_cast<double>(ray.ray.tfar);
}

}  // namespace vpe::app
