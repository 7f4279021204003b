#include "vpe/app/report/embree_ranges.h"

#include <stdexcept>

#ifdef VPE_HAS_EMBREE
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "vpe/base/parallel.h"
#endif

namespace vpe::app {

#ifndef VPE_HAS_EMBREE

bool has_embree() { return false; }

std::unique_ptr<core::Renderer> make_embree_renderer(std::shared_ptr<const paging::PlanetFile>, int) {
  throw std::runtime_error("Embree is not built in; configure with -DVPE_EMBREE=ON (libembree-dev)");
}

#else

namespace {

// Finest tiles that are not hidden by the ball of the lowest ground.
std::vector<lod::TileKey> tiles_in_sight(const paging::PlanetFile& planet, const glm::dvec3& camera_m) {
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

class Scene {
 public:
  Scene(const paging::PlanetFile& planet, const glm::dvec3& camera_m, int threads) {
    const std::string config = "threads=" + std::to_string(std::max(0, threads));
    device_ = rtcNewDevice(config.c_str());
    if (device_ == nullptr) throw std::runtime_error("Embree: cannot make a device: " + config);
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* self, ssize_t bytes, bool) {
          static_cast<Scene*>(self)->bytes_ += bytes;
          return true;
        },
        this);
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    const std::vector<lod::TileKey> tiles = tiles_in_sight(planet, camera_m);
    base::parallel_for(tiles.size(), threads,
                       [&](std::size_t k) { add(planet, tiles[k], static_cast<unsigned>(k), camera_m); });
    rtcCommitScene(scene_);
    check("building its scene");
  }
  ~Scene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  RTCScene get() const { return scene_; }
  std::int64_t bytes() const { return bytes_; }

 private:
  void check(const char* what) const {
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
      throw std::runtime_error(std::string("Embree: ") + what + ": error " + std::to_string(error));
  }

  void add(const paging::PlanetFile& planet, const lod::TileKey& key, unsigned id, const glm::dvec3& camera_m) {
    const lod::Posts posts = planet.heights(key).posts;
    const lod::GridLines lines = lod::grid_lines(key, posts.intervals);
    const auto side = static_cast<std::size_t>(posts.side());
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_GRID);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), side * side));
    auto* grid = static_cast<RTCGrid*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
    if (vertex == nullptr || grid == nullptr) throw std::runtime_error("Embree: no memory for a tile");
    // From east to west: Embree splits a grid's cells along the other diagonal than S.
    for (std::size_t j = 0; j < side; ++j) {
      for (std::size_t i = side; i-- > 0;) {
        const glm::dvec3 p = mars::cube_point(key.face, lines.u[i], lines.v[j]);
        const double radius_m = planet.radius_m() + posts.height_m[j * side + i];
        const glm::dvec3 at = p * (radius_m / mars::cube_length(p)) - camera_m;
        for (const double x : {at.x, at.y, at.z}) *vertex++ = static_cast<float>(x);
      }
    }
    const auto width = static_cast<unsigned short>(side);
    *grid = {0, static_cast<unsigned>(side), width, width};
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, id);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::atomic<std::int64_t> bytes_{0};
};

class EmbreeRenderer : public core::Renderer {
 public:
  EmbreeRenderer(std::shared_ptr<const paging::PlanetFile> planet, int threads)
      : planet_(std::move(planet)), threads_(threads), pool_(threads) {}

  core::DrawResult draw(const core::DrawRequest& request) override {
    const core::View& view = request.view;
    if (view.projection != core::Projection::kPerspective || view.part.width != 0)
      throw std::runtime_error("Embree draws whole perspective pictures only");
    if (!scene_ || view.camera.position_m != camera_m_) {
      scene_.reset();
      camera_m_ = view.camera.position_m;
      scene_.emplace(*planet_, camera_m_, threads_);
    }
    core::DrawResult result;
    core::Frame& frame = result.frame;
    frame.width = view.width;
    frame.height = view.height;
    frame.range_m.resize(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
    frame.colour.resize(frame.range_m.size());
    pool_.run(static_cast<std::size_t>((view.height + kBlock - 1) / kBlock),
              [&](std::size_t row) { cast_blocks(view, static_cast<int>(row) * kBlock, frame.range_m); });
    result.certificate.shift_bound_px = std::numeric_limits<double>::quiet_NaN();
    result.stats.bytes_resident = scene_->bytes();
    return result;
  }

 private:
  static constexpr int kBlock = 4;  // pixels a side

  // Along axes, so that lengths are not 1: a ray's end counts in them.
  void cast_blocks(const core::View& view, int y0, std::vector<float>& range_m) const {
    alignas(64) static constexpr std::array<int, 16> kAll{-1, -1, -1, -1, -1, -1, -1, -1,
                                                          -1, -1, -1, -1, -1, -1, -1, -1};
    const double focal = core::focal_px(view);
    const glm::dvec2 centre = 0.5 * glm::dvec2(view.width, view.height) + view.principal_offset_px;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (int x0 = 0; x0 < view.width; x0 += kBlock) {
      RTCRayHit16 packet{};
      std::array<float, 16> length{};
      for (int n = 0; n < 16; ++n) {
        const double across = (x0 + n % kBlock + 0.5 - centre.x) / focal;
        const double up = (centre.y - (y0 + n / kBlock + 0.5)) / focal;
        const glm::dvec3 d =
            across * view.camera.axes.right + up * view.camera.axes.up + view.camera.axes.forward;
        packet.ray.dir_x[n] = static_cast<float>(d.x);
        packet.ray.dir_y[n] = static_cast<float>(d.y);
        packet.ray.dir_z[n] = static_cast<float>(d.z);
        packet.ray.tfar[n] = std::numeric_limits<float>::infinity();
        packet.ray.mask[n] = ~0U;
        packet.hit.geomID[n] = RTC_INVALID_GEOMETRY_ID;
        length[static_cast<std::size_t>(n)] = static_cast<float>(std::sqrt(1.0 + across * across + up * up));
      }
      rtcIntersect16(kAll.data(), scene_->get(), &context, &packet);
      for (int n = 0; n < 16; ++n) {
        const int x = x0 + n % kBlock;
        const int y = y0 + n / kBlock;
        if (x >= view.width || y >= view.height) continue;
        range_m[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) +
                static_cast<std::size_t>(x)] = packet.ray.tfar[n] * length[static_cast<std::size_t>(n)];
      }
    }
  }

  std::shared_ptr<const paging::PlanetFile> planet_;
  int threads_;
  base::ThreadPool pool_;
  std::optional<Scene> scene_;
  glm::dvec3 camera_m_{0, 0, 0};
};

}  // namespace

bool has_embree() { return true; }

std::unique_ptr<core::Renderer> make_embree_renderer(std::shared_ptr<const paging::PlanetFile> planet,
                                                     int threads) {
  return std::make_unique<EmbreeRenderer>(std::move(planet), threads);
}

#endif

}  // namespace vpe::app
