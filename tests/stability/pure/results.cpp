// Prints what pure functions give for a fixed set of arguments, a line each: name, number, results as
// hexadecimal floats. Built twice, at the build's own optimisation and at -O0;
// tests/stability/arithmetic_test.cpp compares.
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <random>
#include <vector>

#include "cull/frustum.h"
#include "cull/horizon.h"
#include "cull/terrain_horizon.h"
#include "lod/control.h"
#include "lod/frame_budget.h"
#include "lod/mesh/error_meter.h"
#include "lod/mesh/mesh.h"
#include "lod/off_axis_magnification.h"
#include "lod/tree/posts.h"
#include "mars/geodesy/pose.h"
#include "panorama/projection.h"
#include "scripts/path.h"
#include "vpe/core/appearance/shading.h"
#include "vpe/core/appearance/slope.h"
#include "vpe/core/view.h"
#include "vpe/explore/steer.h"

namespace {

std::mt19937_64 engine(20261122);

double uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1p-53);
}
int integer(int low, int high) {
  return low + static_cast<int>(engine() % static_cast<unsigned>(high - low + 1));
}
glm::dvec3 direction() {
  return mars::direction({uniform(-180, 180), std::asin(uniform(-1, 1)) / mars::kRadiansPerDegree});
}
mars::LonLat place() {
  static const double lats[] = {90, -90, 89.999999999, 0, 45};
  static const double lons[] = {180, -180, 0, 90, 135};
  const bool hostile = integer(0, 3) == 0;
  return hostile ? mars::LonLat{lons[integer(0, 4)], lats[integer(0, 4)]} : mars::lon_lat(direction());
}

void print(const char* name, int number, std::initializer_list<double> values) {
  std::printf("%s %d", name, number);
  for (const double v : values) std::printf(" %a", v);
  std::printf("\n");
}
void print(const char* name, int number, const glm::dvec3& v) { print(name, number, {v.x, v.y, v.z}); }

vpe::core::View random_view() {
  vpe::core::View view;
  const mars::LonLat at = place();
  view.projection = static_cast<vpe::core::Projection>(integer(0, 2));
  view.fov_deg = std::exp(uniform(std::log(0.01), std::log(150)));
  view.width = integer(10, 4000);
  view.height = integer(10, 3000);
  view.camera = mars::to_camera({at.lon_deg, at.lat_deg, std::exp(uniform(-2, 17)), uniform(-180, 180),
                                 uniform(-90, 90), uniform(-180, 180)},
                                mars::kMarsRadius_m);
  return view;
}

void planet(int n) {
  const mars::LonLat a = place();
  const mars::LonLat b = place();
  const double angle = uniform(-720, 720);
  const mars::SinCos s = mars::sin_cos_deg(angle);
  print("sin_cos_deg", n, {s.sin, s.cos});
  print("direction", n, mars::direction(a));
  const mars::LonLat back = mars::lon_lat(mars::direction(a) * uniform(0.1, 1e7));
  print("lon_lat", n, {back.lon_deg, back.lat_deg});
  print("great circle", n, {mars::distance_rad(a, b), mars::initial_bearing_deg(a, b)});
  const mars::LonLat to = mars::destination(a, angle, uniform(0, 6));
  print("destination", n, {to.lon_deg, to.lat_deg});
  print("slerp", n, mars::slerp(mars::direction(a), mars::direction(b), uniform(0, 1)));
  const double alt_m = std::exp(uniform(-3, 18));
  print("horizon", n, {mars::horizon_dip_rad(alt_m, 3.4e6), mars::horizon_distance_m(alt_m, 3.4e6)});
  const mars::Pose pose{a.lon_deg, a.lat_deg, alt_m, uniform(-400, 400), uniform(-90, 90), uniform(-200, 200)};
  const mars::CameraPose camera =
      mars::to_camera(pose, {uniform(-90, 90), uniform(-90, 90), 3}, mars::kMarsRadius_m);
  print("camera", n, camera.position_m);
  print("camera forward", n, camera.axes.forward);
  print("camera up", n, camera.axes.up);
  const mars::Pose again = mars::to_pose(camera, mars::kMarsRadius_m);
  print("pose", n, {again.lon_deg, again.lat_deg, again.alt_m, again.yaw_deg, again.pitch_deg, again.roll_deg});
  const mars::ChartPoint chart = mars::chart_point(direction());
  print("chart", n, {chart.u, chart.v, mars::face_parameter(chart.u)});
  print("chart direction", n, mars::chart_direction(chart.face, chart.u, chart.v));
}

void views(int n) {
  const vpe::core::View view = random_view();
  print("pixel_ray", n, vpe::core::pixel_ray(view, uniform(0, view.width), uniform(0, view.height)));
  const vpe::core::Projected p = vpe::core::project(view, direction() * uniform(1e6, 1e8));
  print("project", n, {p.xy.x, p.xy.y, p.depth_m});
  const lod::TileKey key{static_cast<mars::Face>(integer(0, 5)), 5, integer(0, 31), integer(0, 31)};
  const cull::BoundingRegion region{lod::chart_rect(key), uniform(3.38e6, 3.39e6), uniform(3.39e6, 3.41e6)};
  const cull::Camera camera = cull::make_camera(view.camera.position_m);
  const double chord2 = cull::nearest_chord2(region.rect, camera.direction);
  print("distance", n,
        {chord2, cull::farthest_chord2(region.rect, camera.direction),
         cull::min_distance_m(camera, chord2, region.min_radius_m, region.max_radius_m),
         cull::max_distance_m(camera, chord2, region.min_radius_m, region.max_radius_m)});
  const cull::BoundingHexahedron volume = cull::bounding_hexahedron(region);
  print("volume", n, volume.corners_m[static_cast<std::size_t>(n % 8)]);
  const cull::Frustum frustum = cull::make_frustum(view);
  const auto crossed = cull::planes_crossed(frustum, volume, cull::all_planes(frustum));
  const cull::Horizon horizon = cull::make_horizon(camera, 3.38e6);
  print("culled", n,
        {crossed ? static_cast<double>(*crossed) : -1, horizon.half_tangent,
         cull::hidden(horizon, chord2, region.max_radius_m) ? 1.0 : 0.0,
         cull::against_sky(camera, horizon, chord2, region.max_radius_m) ? 1.0 : 0.0});
  print("magnification", n, {lod::off_axis_magnification(lod::image_plane(view), volume)});
  print("centre", n, {lod::least_angle_rad(lod::centre_of_view(view), volume)});
}

void occluders(int n) {
  cull::TerrainHorizon horizon;
  const glm::dvec3 up = direction();
  horizon.begin({up, 3.4e6 + uniform(10, 1e5)}, 1e-5);
  const mars::ChartPoint at = mars::chart_point(up);
  std::vector<double> ends;
  std::vector<double> radius_m;
  for (int k = 0; k <= 8; ++k) ends.push_back(std::max(-1.0, at.v - 0.1) + 0.02 * k);
  for (int k = 0; k < 8; ++k) radius_m.push_back(3.4e6 + uniform(-3000, 9000));
  horizon.add({at.face, true, at.u + 0.01, ends, radius_m});
  for (int k = 0; k < 20; ++k) print("blocked", 20 * n + k, {horizon.blocked_slope(direction())});
}

void ground(int n) {
  const lod::TileKey key{static_cast<mars::Face>(integer(0, 5)), 4, integer(0, 15), integer(0, 15)};
  constexpr int kSide = 17;
  lod::Posts posts{key, kSide - 1, {}};
  for (int k = 0; k < kSide * kSide; ++k) posts.height_m.push_back(uniform(-5000, 8000));
  const lod::GridLines lines = lod::grid_lines(key, kSide - 1);
  const double radius_m = mars::kMarsRadius_m;
  for (int k = 0; k < 20; ++k) {
    glm::dvec3 normal;
    const double height_m =
        lod::surface_height(posts, lines, uniform(lines.u.front(), lines.u.back()),
                            uniform(lines.v.front(), lines.v.back()), radius_m, &normal, k % 3 + 0.5);
    print("surface", 20 * n + k, {height_m, normal.x, normal.y, normal.z});
    print("slope", 20 * n + k,
          {vpe::core::slope_deg(normal, direction()),
           vpe::core::aspect_deg(normal, {0, 0, 1}, {0, 1, 0}, {1, 0, 0})});
  }
  print("steepest", n, {lod::steepest_slope(posts, lines, radius_m)});
  lod::Posts constrained = posts;
  lod::constrain_edge(constrained, lines, lod::kEdges[static_cast<std::size_t>(n % 4)], 4, radius_m);
  double sum = 0;
  for (const double h : constrained.height_m) sum += h;
  print("edge", n, {sum});
  // A mesh of two triangles over the tile against its posts.
  lod::TileMesh mesh;
  mesh.intervals = kSide - 1;
  mesh.vertices = {{0, 0}, {16, 0}, {16, 16}, {0, 16}};
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  const std::vector<double> heights{posts.at(0, 0), posts.at(16, 0), posts.at(16, 16), posts.at(0, 16)};
  const lod::ErrorTerms terms = lod::measure_error(key, mesh, heights, posts, radius_m);
  print("error", n,
        {terms.height_error_m, terms.sagitta_m, terms.total_m,
         lod::error_bound(terms, 3.7, -5000, 8000, radius_m)});
}

void light(int n) {
  print("air", n, {vpe::core::air_m(3.39e6, uniform(-8000, 2e5), uniform(-1, 1), uniform(1, 1e6))});
  print("light", n,
        {vpe::core::light(uniform(0, 1), uniform(0, 1), uniform(-1, 1)),
         vpe::core::transmittance(uniform(0, 1e6), 30000)});
}

void control() {
  lod::FrameBudgetState state;
  for (int n = 0; n < 500; ++n) {
    const double next = lod::next_multiplier(
        {}, {state.multiplier, 40 * std::pow(state.multiplier, -1.5) * uniform(0.9, 1.1)}, state);
    print("budget", n, {next, state.log_load, state.slope});
  }
}

void flights(int trial) {
  scripts::Flight flight;
  double t = 0;
  mars::LonLat at = place();
  for (int n = 0; n < 6; ++n) {
    flight.waypoints.push_back({t, at.lon_deg, at.lat_deg, uniform(1, 1e6), false, uniform(-180, 180),
                                uniform(-90, 90), uniform(-180, 180)});
    flight.heads.push_back({t, uniform(-180, 180), uniform(-90, 90), 0});
    t += uniform(0.1, 20);
    at = mars::destination(at, uniform(0, 360), uniform(0, 1));
  }
  const scripts::Path path(flight, mars::kMarsRadius_m, {});
  for (int n = 0; n < 30; ++n) {
    const scripts::FlightState state = path.at(uniform(0, t));
    print("flight camera", 30 * trial + n, state.camera.position_m);
    print("flight forward", 30 * trial + n, state.camera.axes.forward);
    print("flight head", 30 * trial + n, {state.head.yaw_deg, state.head.pitch_deg, state.pose.alt_m});
  }
  const vpe::explore::TerrainQuery ball = vpe::explore::ball(mars::kMarsRadius_m);
  mars::Pose pose{at.lon_deg, at.lat_deg, 5000, 30, 0, 0};
  for (int n = 0; n < 20; ++n)
    pose = vpe::explore::moved(pose, uniform(-1e4, 1e4), 0, uniform(-1e4, 1e4), ball);
  print("steered", trial, {pose.lon_deg, pose.lat_deg, pose.alt_m, pose.yaw_deg});
}

void panoramas(int n) {
  const panorama::PanoramaMap maps[] = {
      panorama::cylinder_map(5000, 1000, 5000, uniform(-180, 180), 500),
      panorama::equirectangular_map(5000, 1000, 5000, uniform(-180, 180), 500),
      panorama::faceted_map(8, 640, 800, uniform(-180, 180), 400)};
  const panorama::PanoramaMap& map = maps[n % 3];
  const panorama::Direction d = map.to_direction(uniform(0, 5000), uniform(0, 800));
  const glm::dvec2 at = map.place(d);
  print("panorama", n, {d.azimuth_deg, d.elevation_deg, at.x, at.y});
}

}  // namespace

int main() {
  for (int n = 0; n < 2000; ++n) planet(n);
  for (int n = 0; n < 2000; ++n) views(n);
  for (int n = 0; n < 30; ++n) occluders(n);
  for (int n = 0; n < 60; ++n) ground(n);
  for (int n = 0; n < 1000; ++n) light(n);
  control();
  for (int n = 0; n < 60; ++n) flights(n);
  for (int n = 0; n < 1000; ++n) panoramas(n);
  return 0;
}
