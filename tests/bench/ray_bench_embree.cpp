#include "tests/bench/ray_bench_embree.h"

#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace bench {

namespace {

constexpr int kBlock = 8;  // pixels a side

class DenormalsOff {
 public:
  DenormalsOff() : before_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  ~DenormalsOff() { _mm_setcsr(before_); }

 private:
  unsigned before_;
};

// Returns a packet of kWide x kHigh pixels with everything set that does not depend on the rays.
template <typename Packet, int kWide, int kHigh>
Packet blank_packet() {
  Packet packet{};
  for (int n = 0; n < kWide * kHigh; ++n) packet.ray.mask[n] = ~0U;
  return packet;
}

template <int kWide, int kHigh, typename Packet>
void fill(const RayTables& t, int x0, int y0, Packet& packet) {
  int n = 0;
  for (int y = y0; y < y0 + kHigh; ++y) {
    const float s = t.tangent[static_cast<std::size_t>(y)];
    const float x_up = s * t.up_x, y_up = s * t.up_y, z_up = s * t.up_z;
    for (int x = x0; x < x0 + kWide; ++x, ++n) {
      packet.ray.dir_x[n] = t.column_x[static_cast<std::size_t>(x)] + x_up;
      packet.ray.dir_y[n] = t.column_y[static_cast<std::size_t>(x)] + y_up;
      packet.ray.dir_z[n] = t.column_z[static_cast<std::size_t>(x)] + z_up;
      packet.ray.tfar[n] = std::numeric_limits<float>::infinity();
      packet.hit.geomID[n] = RTC_INVALID_GEOMETRY_ID;
    }
  }
}

// Converts a distance along a table's ray to a range; infinity stays infinite.
float range_of(const RayTables& t, int x, int y, float distance) {
  const float s = t.tangent[static_cast<std::size_t>(y)];
  return distance * std::sqrt(t.column_length2[static_cast<std::size_t>(x)] + s * s);
}

template <int kWide, int kHigh, typename Packet>
void store(const RayTables& t, int x0, int y0, const Packet& packet, std::span<float> range_m) {
  const int high = std::min(kHigh, t.height - y0);
  const int wide = std::min(kWide, t.width - x0);
  for (int y = 0; y < high; ++y) {
    float* row = &range_m[static_cast<std::size_t>(y0 + y) * static_cast<std::size_t>(t.width)];
    for (int x = 0; x < wide; ++x) row[x0 + x] = range_of(t, x0 + x, y0 + y, packet.ray.tfar[y * kWide + x]);
  }
}

template <typename Packet, int kWide, int kHigh, typename Call>
void cast_packets(const RayTables& t, int y0, std::span<float> range_m, Call&& call) {
  Packet packet = blank_packet<Packet, kWide, kHigh>();
  for (int x0 = 0; x0 < t.width; x0 += kBlock) {
    for (int y = y0; y < std::min(y0 + kBlock, t.height); y += kHigh) {
      for (int x = x0; x < std::min(x0 + kBlock, t.width); x += kWide) {
        fill<kWide, kHigh>(t, x, y, packet);
        call(packet);
        store<kWide, kHigh>(t, x, y, packet, range_m);
      }
    }
  }
}

void cast_stream(const RayTables& t, RTCScene scene, RTCIntersectContext& context, int y0,
                 std::span<float> range_m) {
  std::array<RTCRayHit16, 4> packets;
  packets.fill(blank_packet<RTCRayHit16, 4, 4>());
  for (int x0 = 0; x0 < t.width; x0 += kBlock) {
    for (int n = 0; n < 4; ++n)
      fill<4, 4>(t, x0 + n % 2 * 4, y0 + n / 2 * 4, packets[static_cast<std::size_t>(n)]);
    if (scene != nullptr)
      rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(packets.data()), 16, 4,
                     sizeof(RTCRayHit16));
    for (int n = 0; n < 4; ++n)
      store<4, 4>(t, x0 + n % 2 * 4, y0 + n / 2 * 4, packets[static_cast<std::size_t>(n)], range_m);
  }
}

void cast_stream1(const RayTables& t, RTCScene scene, RTCIntersectContext& context, int y0,
                  std::span<float> range_m) {
  std::array<RTCRayHit, kBlock * kBlock> rays{};
  for (RTCRayHit& ray : rays) ray.ray.mask = ~0U;
  for (int x0 = 0; x0 < t.width; x0 += kBlock) {
    for (int n = 0; n < kBlock * kBlock; ++n) {
      const auto x = static_cast<std::size_t>(x0 + n % kBlock);
      const float s = t.tangent[static_cast<std::size_t>(y0 + n / kBlock)];
      RTCRayHit& ray = rays[static_cast<std::size_t>(n)];
      ray.ray.dir_x = t.column_x[x] + s * t.up_x;
      ray.ray.dir_y = t.column_y[x] + s * t.up_y;
      ray.ray.dir_z = t.column_z[x] + s * t.up_z;
      ray.ray.tfar = std::numeric_limits<float>::infinity();
      ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
    if (scene != nullptr)
      rtcIntersect1M(scene, &context, rays.data(), static_cast<unsigned>(rays.size()), sizeof(RTCRayHit));
    for (int y = y0; y < std::min(y0 + kBlock, t.height); ++y) {
      for (int x = x0; x < std::min(x0 + kBlock, t.width); ++x) {
        range_m[static_cast<std::size_t>(y) * static_cast<std::size_t>(t.width) + static_cast<std::size_t>(x)] =
            range_of(t, x, y, rays[static_cast<std::size_t>((y - y0) * kBlock + x - x0)].ray.tfar);
      }
    }
  }
}

constexpr int padded(int side) { return (side + kBlock - 1) / kBlock * kBlock; }

}  // namespace

const char* name(EmbreeMode mode) {
  switch (mode) {
    case EmbreeMode::kPacket16: return "16-packets";
    case EmbreeMode::kPacket8: return "8-packets";
    case EmbreeMode::kStream: return "64-ray streams";
    case EmbreeMode::kStream1: return "64 single rays";
  }
  return "";
}

EmbreeImage::EmbreeImage(const vpe::core::View& view) {
  using vpe::core::Projection;
  if (view.projection == Projection::kEquirectangular || view.part.width != 0)
    throw std::invalid_argument("EmbreeImage: only whole perspective and cylindrical images");
  tables_.width = view.width;
  tables_.height = view.height;
  const double focal = vpe::core::focal_px(view);
  const glm::dvec2 centre = 0.5 * glm::dvec2(view.width, view.height) + view.principal_offset_px;
  const mars::Axes& axes = view.camera.axes;
  for (int column = 0; column < padded(view.width); ++column) {
    const double x = std::min(column, view.width - 1) + 0.5 - centre.x;
    const bool round = view.projection == Projection::kCylinder;
    const double angle = 2.0 * mars::kPi * x / view.width;
    const glm::dvec3 d = round ? std::sin(angle) * axes.right + std::cos(angle) * axes.forward
                               : x / focal * axes.right + axes.forward;
    tables_.column_x.push_back(static_cast<float>(d.x));
    tables_.column_y.push_back(static_cast<float>(d.y));
    tables_.column_z.push_back(static_cast<float>(d.z));
    tables_.column_length2.push_back(static_cast<float>(glm::dot(d, d)));
  }
  for (int row = 0; row < padded(view.height); ++row) {
    const double y = std::min(row, view.height - 1) + 0.5;
    tables_.tangent.push_back(static_cast<float>((centre.y - y) / focal));
  }
  tables_.up_x = static_cast<float>(axes.up.x);
  tables_.up_y = static_cast<float>(axes.up.y);
  tables_.up_z = static_cast<float>(axes.up.z);
}

double EmbreeImage::cast(RTCScene scene, EmbreeMode mode, vpe::base::ThreadPool& pool,
                         std::span<float> range_m) const {
  const auto start = std::chrono::steady_clock::now();
  pool.run(static_cast<std::size_t>(padded(tables_.height) / kBlock), [&](std::size_t row) {
    const DenormalsOff off;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    const int y0 = static_cast<int>(row) * kBlock;
    alignas(64) static constexpr std::array<int, 16> kAll{-1, -1, -1, -1, -1, -1, -1, -1,
                                                          -1, -1, -1, -1, -1, -1, -1, -1};
    switch (mode) {
      case EmbreeMode::kPacket16:
        cast_packets<RTCRayHit16, 4, 4>(tables_, y0, range_m, [&](RTCRayHit16& packet) {
          if (scene != nullptr) rtcIntersect16(kAll.data(), scene, &context, &packet);
        });
        break;
      case EmbreeMode::kPacket8:
        cast_packets<RTCRayHit8, 4, 2>(tables_, y0, range_m, [&](RTCRayHit8& packet) {
          if (scene != nullptr) rtcIntersect8(kAll.data(), scene, &context, &packet);
        });
        break;
      case EmbreeMode::kStream: cast_stream(tables_, scene, context, y0, range_m); break;
      case EmbreeMode::kStream1: cast_stream1(tables_, scene, context, y0, range_m); break;
    }
  });
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace bench
