#include "vpe/app/report/embree_ranges.h"

#include <stdexcept>

#ifdef VPE_HAS_EMBREE
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "vpe/app/report/embree_scene.h"
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

class EmbreeRenderer : public core::Renderer {
 public:
  EmbreeRenderer(std::shared_ptr<const paging::PlanetFile> planet, int threads)
      : planet_(std::move(planet)), threads_(threads), pool_(threads) {}

  core::DrawResult draw(const core::DrawRequest& request) override {
    const core::View& view = request.view;
    if (view.projection != core::Projection::kPerspective || view.part.width != 0)
      throw std::runtime_error("Embree draws whole perspective images only");
    if (!scene_ || view.camera.position_m != camera_m_) {
      scene_.reset();
      camera_m_ = view.camera.position_m;
      EmbreeOptions options;
      options.shape = EmbreeShape::kGrid;
      options.threads = threads_;
      scene_.emplace(*planet_, tiles_in_sight(*planet_, camera_m_), camera_m_, options);
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

  // Directions have length 1 along the view axis, not in space: a ray's range is in units of its length.
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
      rtcIntersect16(kAll.data(), scene_->scene(), &context, &packet);
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
  std::optional<EmbreeScene> scene_;
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
