// Measures our rays against the objects of a scene, and those of Embree against the same triangles as instances: one thread,
// single rays, one picture, by turns.
//   objects_embree_bench [ROUNDS]
#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "objects/draw/pixel_square.h"
#include "objects/levels/mesh_levels.h"
#include "objects/model/shapes.h"
#include "objects/sticks/build_sticks.h"
#include "objects/sticks/voxelise.h"
#include "vpe/report/interleaved_timing.h"

namespace {

namespace core = vpe::core;
using objects::Instance;
using objects::Scene;

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr double kCentre_m = 3.4e6;  // distance of the plane from the planet's centre
constexpr float kSky = std::numeric_limits<float>::infinity();

core::View camera_view() {
  core::View view;
  view.width = kWidth;
  view.height = kHeight;
  view.fov_deg = 50;
  view.camera.position_m = {kCentre_m + 5, 0, 0};
  // Up is x; ten degrees down along y.
  const double down = 10 * mars::kRadiansPerDegree;
  view.camera.axes.forward = {-std::sin(down), std::cos(down), 0};
  view.camera.axes.up = {std::cos(down), std::sin(down), 0};
  view.camera.axes.right = glm::cross(view.camera.axes.forward, view.camera.axes.up);
  return view;
}

// A thousand objects on a plane before the camera, turned and scaled by chance.
std::vector<Instance> thousand() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<Instance> out;
  for (int n = 0; n < 1000; ++n) {
    Instance i;
    i.position_m = {kCentre_m, 8 + 2.0 * (n / 40) + 0.5 * any(random),
                    2.0 * (n % 40 - 19.5) + 0.5 * any(random)};
    const glm::dquat upright = glm::angleAxis(0.5 * 3.14159265358979, glm::dvec3(0, 1, 0));
    i.rotation = glm::quat(glm::normalize(upright * glm::angleAxis(3.2 * any(random), glm::dvec3(0, 0, 1))));
    i.scale = static_cast<float>(1.5 + 0.7 * any(random));
    out.push_back(i);
  }
  return out;
}

Scene scene_of(std::shared_ptr<const objects::Model> model) { return Scene({std::move(model)}, thousand()); }

// Casts a picture as the compositor does: objects are chosen for squares of 64 pixels, then for parts of 8.
class OurRays {
 public:
  OurRays(const Scene& scene, const core::View& view, double tolerance_px)
      : view_(view), view_rays_(view), rays_(scene, rule_of(view, tolerance_px)) {}

  void cast(std::vector<float>& range_m, bool only_chooses = false) {
    for (int y = 0; y < kHeight; y += 64) {
      for (int x = 0; x < kWidth; x += 64) cast_square(x, y, range_m, only_chooses);
    }
  }

 private:
  static objects::LevelRule rule_of(const core::View& view, double tolerance_px) {
    objects::LevelRule rule;
    rule.camera_m = view.camera.position_m;
    rule.focal_px = core::focal_px(view);
    rule.stretch = core::corner_stretch(view);
    rule.tolerance_px = tolerance_px;
    rule.least_ray_px = 0;
    return rule;
  }

  void cast_square(int x0, int y0, std::vector<float>& range_m, bool only_chooses) {
    const objects::PixelSquare square{x0, y0, std::min(x0 + 64, kWidth), std::min(y0 + 64, kHeight)};
    const std::vector<objects::PlacedObject> placed =
        rays_.in_cone(cone_of(view_, view_rays_, square, 1), std::numeric_limits<double>::infinity());
    for (int y = square.y0; y < square.y1; y += 8) {
      for (int x = square.x0; x < square.x1; x += 8) {
        const objects::PixelSquare part{x, y, std::min(x + 8, square.x1), std::min(y + 8, square.y1)};
        const objects::ViewCone cone = cone_of(view_, view_rays_, part, 1);
        objects::ObjectNumbers among;
        for (std::uint32_t n = 0; n < placed.size(); ++n) {
          const objects::SceneBall& ball = placed[n].around;
          if (meets(cone, view_.camera.position_m, ball.centre_m, ball.radius_m)) among.push_back(n);
        }
        if (!only_chooses) cast_part(part, placed, among, range_m);
      }
    }
  }

  void cast_part(const objects::PixelSquare& part, const std::vector<objects::PlacedObject>& placed,
                 const objects::ObjectNumbers& among, std::vector<float>& range_m) {
    for (int y = part.y0; y < part.y1; ++y) {
      for (int x = part.x0; x < part.x1; ++x) {
        float& range = range_m[static_cast<std::size_t>(y * kWidth + x)];
        range = kSky;
        if (among.empty()) continue;
        nearest_object(placed, among, {view_.camera.position_m, view_rays_.at(x + 0.5, y + 0.5)},
                       std::numeric_limits<double>::infinity(), 0, met_);
        if (met_.has_front) range = static_cast<float>(met_.front.range_m);
      }
    }
  }

  const core::View& view_;
  objects::ViewRays view_rays_;
  objects::ObjectRays rays_;
  objects::RayResult met_;
};

// The same triangles as instances of one scene, about the camera.
class EmbreeInstances {
 public:
  EmbreeInstances(const objects::Mesh& mesh, const Scene& scene, const core::View& view)
      : view_rays_(view), device_(rtcNewDevice("threads=1,set_affinity=0")) {
    if (device_ == nullptr) throw std::runtime_error("Embree gives no device");
    RTCScene model = new_scene();
    RTCGeometry triangles = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions_m.size()));
    for (const glm::vec3& p : mesh.positions_m)
      for (int k = 0; k < 3; ++k) *positions++ = p[k];
    auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles.size()));
    for (const glm::uvec3& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) *corners++ = t[k];
    attach(model, triangles);
    rtcCommitScene(model);
    scene_ = new_scene();
    for (std::uint32_t n = 0; n < scene.size(); ++n) {
      const Instance i = scene.instance(n);
      const glm::dmat3 turned =
          glm::mat3_cast(glm::normalize(glm::dquat(i.rotation))) * static_cast<double>(i.scale);
      const glm::dvec3 at_m = i.position_m - view.camera.position_m;
      float columns[12];
      for (int c = 0; c < 4; ++c)
        for (int k = 0; k < 3; ++k) columns[3 * c + k] = static_cast<float>(c < 3 ? turned[c][k] : at_m[k]);
      RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, model);
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
      attach(scene_, instance);
    }
    rtcCommitScene(scene_);
    rtcReleaseScene(model);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree refuses the scene");
  }
  ~EmbreeInstances() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeInstances(const EmbreeInstances&) = delete;
  EmbreeInstances& operator=(const EmbreeInstances&) = delete;

  void cast(std::vector<float>& range_m) const {
    const unsigned before = _mm_getcsr();
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const glm::vec3 d(view_rays_.at(x + 0.5, y + 0.5));
        RTCRayHit ray{};
        ray.ray.dir_x = d.x;
        ray.ray.dir_y = d.y;
        ray.ray.dir_z = d.z;
        ray.ray.tfar = kSky;
        ray.ray.mask = ~0U;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &ray);
        range_m[static_cast<std::size_t>(y * kWidth + x)] = ray.ray.tfar;
      }
    }
    _mm_setcsr(before);
  }

 private:
  RTCScene new_scene() const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // watertight, as ours are
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    return scene;
  }
  static void attach(RTCScene scene, RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }

  objects::ViewRays view_rays_;
  RTCDevice device_;
  RTCScene scene_ = nullptr;
};

// Prints how far two pictures agree: both hit or both miss, and ranges within a length.
void print_agreement(const char* what, const std::vector<float>& a, const std::vector<float>& b,
                     float within_m) {
  std::size_t hit_or_miss = 0;
  std::size_t far = 0;
  std::size_t both = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    if (std::isinf(a[n]) != std::isinf(b[n])) {
      ++hit_or_miss;
    } else if (!std::isinf(a[n])) {
      ++both;
      far += std::abs(a[n] - b[n]) > within_m ? 1 : 0;
    }
  }
  const auto share = [&](std::size_t n) {
    return 100.0 * static_cast<double>(n) / static_cast<double>(a.size());
  };
  std::printf(
      "%s against Embree: %.1f %% of pixels hit in both, %.3f %% in one only, %.3f %% farther apart than %g m\n",
      what, share(both), share(hit_or_miss), share(far), static_cast<double>(within_m));
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 7;
  const core::View view = camera_view();
  objects::Mesh mesh = objects::make_rock(3, 5);
  const auto triangles = std::make_shared<const objects::Model>("triangles", objects::make_levels(mesh));
  const auto sticks = std::make_shared<const objects::Model>(
      "sticks", std::make_shared<const objects::StickModel>(
                    build_sticks(voxelise(mesh, {}, {.voxels_longest = 256, .is_tight = true}))));
  const float voxel_m = sticks->sticks()->levels()[0].grid.voxel_m;
  const Scene triangle_scene = scene_of(triangles);
  const Scene stick_scene = scene_of(sticks);
  OurRays triangle_rays(triangle_scene, view, 0);
  OurRays stick_rays(stick_scene, view, 0);
  OurRays coarse_triangle_rays(triangle_scene, view, 1);
  OurRays coarse_stick_rays(stick_scene, view, 1);
  const EmbreeInstances embree(mesh, triangle_scene, view);

  constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
  std::vector<float> of_embree(kPixels), of_triangles(kPixels), of_sticks(kPixels), scratch(kPixels);
  const std::vector<std::pair<std::string, std::function<void()>>> cases{
      {"Embree, instances of triangles", [&] { embree.cast(of_embree); }},
      {"triangles", [&] { triangle_rays.cast(of_triangles); }},
      {"sticks of 256 voxels", [&] { stick_rays.cast(of_sticks); }},
      {"triangles, tolerance of a pixel", [&] { coarse_triangle_rays.cast(scratch); }},
      {"sticks, tolerance of a pixel", [&] { coarse_stick_rays.cast(scratch); }},
      {"choice of objects alone", [&] { triangle_rays.cast(scratch, true); }},
  };
  std::vector<std::function<void()>> runs;
  for (const auto& c : cases) runs.push_back(c.second);
  const std::vector<vpe::report::Timing> times = vpe::report::time_interleaved(runs, rounds);
  std::printf("1000 instances of %zu triangles, %d x %d rays, %d rounds, one thread\n", mesh.triangles.size(),
              kWidth, kHeight, rounds);
  for (std::size_t n = 0; n < cases.size(); ++n) {
    std::printf("  %-34s %8.1f ms, %6.2f million rays a second, %.2f of Embree's time\n",
                cases[n].first.c_str(), 1000 * times[n].median_s(),
                static_cast<double>(kPixels) * 1e-6 / times[n].median_s(),
                vpe::report::ratio(times[n], times[0]));
  }
  print_agreement("triangles", of_triangles, of_embree, 1e-3F);
  print_agreement("sticks", of_sticks, of_embree, 4 * voxel_m);
  return 0;
}
