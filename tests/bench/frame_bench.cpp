// Time of a film's frames against plain drawing of the same triangles. docs/measurements/rendering.md has the
// figures.
//
//   frame_bench PLANET.vpe FLIGHT [FRAMES] [ROUNDS]
//
// The baseline draws all triangles of the frame's meshes, relative to the camera, with one call, one vertex
// buffer and one texture, into the same kind of target. It is the time that OpenGL takes for that many
// triangles and pixels. Tiles are resident on both sides, rounds alternate, figures are medians.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>

#include "lod/select.h"
#include "mars/geodesy/sun.h"
#include "paging/surface/surface.h"
#include "scripts/path.h"
#include "tests/bench/flight.h"
#include "vpe/base/number.h"
#include "vpe/base/quantile.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/gl/projection.h"
#include "vpe/gl/target.h"
#include "vpe/gl/tile_geometry.h"

namespace {

using Clock = std::chrono::steady_clock;
using vpe::base::median_upper;
using vpe::core::DrawRequest;

constexpr const char* kVertex = R"glsl(
#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 st;
layout(location = 2) uniform mat3 rotation;
layout(location = 3) uniform vec4 projection;
layout(location = 4) uniform float near;
layout(location = 0) out vec2 place;
void main() {
  vec3 e = rotation * position;
  gl_Position =
      vec4(projection.x * e.x + projection.z * e.z, projection.y * e.y + projection.w * e.z, near, -e.z);
  place = st;
}
)glsl";
constexpr const char* kFlat = R"glsl(
#version 450 core
layout(location = 0) out vec4 colour;
void main() { colour = vec4(0.8, 0.5, 0.3, 1.0); }
)glsl";
constexpr const char* kBilinear = R"glsl(
#version 450 core
layout(location = 0) in vec2 place;
layout(binding = 0) uniform sampler2D surface;
layout(location = 0) out vec4 colour;
void main() { colour = texture(surface, place); }
)glsl";

std::vector<DrawRequest> film(const char* file, std::int64_t count, const paging::Surface& surface) {
  const scripts::Flight flight = bench::read_flight(file);
  const scripts::Path path = bench::path_over(flight, surface);
  std::vector<DrawRequest> frames;
  for (std::int64_t n = 0; n < count; ++n) {
    const double t = scripts::duration_s(flight) * (static_cast<double>(n) + 0.5) / static_cast<double>(count);
    DrawRequest request;
    request.view.camera = path.at(t).camera;
    request.view.fov_deg = flight.view.fov_deg;
    request.view.width = flight.view.width;
    request.view.height = flight.view.height;
    vpe::core::Settings settings;
    path.apply_settings(t, settings);
    request.settings = settings.values();
    request.sun = mars::sun_direction({-64, -13}, 340, 35);
    frames.push_back(request);
  }
  return frames;
}

struct Vertex {
  glm::vec3 position_m;
  vpe::gl::VertexChart chart;
};

// Holds the meshes of a frame in one buffer.
class Plain {
 public:
  Plain(const paging::PlanetFile& planet, const DrawRequest& request) : array_(vpe::gl::VertexArray::make()) {
    lod::SelectOptions options;
    options.tolerance_px = request.settings.lod_tolerance_px;
    options.exaggeration = request.settings.exaggeration;
    lod::SelectScratch scratch;
    lod::Selection selection;
    lod::select(options, planet.tree(), lod::select_view(request.view), scratch, selection);
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    double nearest_m = 1e9;
    for (const lod::SelectedTile& tile : selection.tiles) {
      const vpe::gl::TileGeometry g = geometry(planet, tile, options.exaggeration);
      const auto base = static_cast<std::uint32_t>(vertices.size());
      const glm::dvec3 offset = g.centre_m - request.view.camera.position_m;
      for (std::uint32_t v = 0; v < g.surface_vertices; ++v) {
        vertices.push_back({glm::vec3(glm::dvec3(g.positions_m[v]) + offset), g.charts[v]});
      }
      for (std::uint32_t n = 0; n < g.ranges.surface; ++n) indices.push_back(base + g.indices[n]);
      nearest_m = std::min(nearest_m, tile.min_distance_m);
    }
    count_ = static_cast<GLsizei>(indices.size());
    vertices_ = vpe::gl::Buffer::make();
    indices_ = vpe::gl::Buffer::make();
    glNamedBufferStorage(vertices_.name(), static_cast<GLsizeiptr>(vertices.size() * sizeof vertices[0]),
                         vertices.data(), 0);
    glNamedBufferStorage(indices_.name(), static_cast<GLsizeiptr>(indices.size() * sizeof indices[0]),
                         indices.data(), 0);
    const GLuint array = array_.name();
    glEnableVertexArrayAttrib(array, 0);
    glEnableVertexArrayAttrib(array, 1);
    glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, position_m));
    glVertexArrayAttribFormat(array, 1, 2, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(Vertex, chart));
    glVertexArrayAttribBinding(array, 0, 0);
    glVertexArrayAttribBinding(array, 1, 0);
    glVertexArrayVertexBuffer(array, 0, vertices_.name(), 0, sizeof(Vertex));
    glVertexArrayElementBuffer(array, indices_.name());
    projection_ = vpe::gl::clip_projection(request.view, std::max(1.0, 0.3 * nearest_m));
    rotation_ = vpe::gl::body_to_camera(request.view.camera.axes);
  }

  std::int64_t triangles() const { return count_ / 3; }

  double draw_ms(vpe::gl::Target& target, const vpe::gl::Program& program) const {
    const auto start = Clock::now();
    target.bind();
    glClearColor(0, 0, 0, 1);
    glClearDepth(0.0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDepthFunc(GL_GREATER);
    glUseProgram(program.name());
    glUniformMatrix3fv(2, 1, GL_FALSE, &rotation_[0][0]);
    glUniform4fv(3, 1, &projection_.scale_shift[0]);
    glUniform1f(4, projection_.near_m);
    glBindVertexArray(array_.name());
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    glFinish();
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  }

 private:
  static vpe::gl::TileGeometry geometry(const paging::PlanetFile& planet, const lod::SelectedTile& tile,
                                        double exaggeration) {
    const double radius = planet.radius_m();
    if (lod::is_full_grid(planet.tree()[tile.index], tile.variant)) {
      const paging::TileHeights heights = planet.heights(tile.key);
      return vpe::gl::make_geometry(tile.key, lod::mesh_full(heights.posts.intervals), heights.posts.height_m,
                                    radius, {exaggeration});
    }
    const paging::PackedMesh packed = planet.mesh(tile.key, tile.variant);
    std::vector<double> heights;
    for (const std::int32_t q : packed.height_q) heights.push_back(q * planet.meta().quantum_m);
    return vpe::gl::make_geometry(tile.key, packed.mesh, heights, radius, {exaggeration});
  }

  vpe::gl::VertexArray array_;
  vpe::gl::Buffer vertices_;
  vpe::gl::Buffer indices_;
  GLsizei count_ = 0;
  vpe::gl::ClipProjection projection_;
  glm::mat3 rotation_{};
};

vpe::gl::Texture2D noise_texture() {
  constexpr GLsizei kSide = 1024;
  std::vector<std::uint32_t> texels(static_cast<std::size_t>(kSide) * kSide);
  std::uint32_t x = 1;
  for (std::uint32_t& t : texels) t = x = x * 1664525U + 1013904223U;
  vpe::gl::Texture2D texture = vpe::gl::Texture2D::make();
  glTextureStorage2D(texture.name(), 1, GL_RGBA8, kSide, kSide);
  glTextureSubImage2D(texture.name(), 0, 0, 0, kSide, kSide, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

void run(const char* planet_file, const char* flight_file, std::int64_t count, std::int64_t rounds) {
  const auto planet = paging::PlanetFile::open(planet_file);
  const paging::Surface surface(planet, std::size_t{256} << 20);
  const std::vector<DrawRequest> frames = film(flight_file, count, surface);
  const std::shared_ptr<vpe::gl::Context> context = vpe::gl::Context::create();
  std::printf("%s\n\n", context->info().renderer.c_str());
  const auto renderer = vpe::gl::make_polygon_renderer(context, planet, {std::size_t{1} << 30, 0, {}});
  const vpe::gl::Program flat = vpe::gl::make_program("flat", kVertex, kFlat);
  const vpe::gl::Program bilinear = vpe::gl::make_program("bilinear", kVertex, kBilinear);
  const vpe::gl::Texture2D texture = noise_texture();
  vpe::gl::Target target(frames[0].view.width, frames[0].view.height, 1);
  std::printf(
      "| frame | triangles | plain bilinear (ms) | flat / bilinear | edges=hard / bilinear | edges=smooth / "
      "bilinear |\n"
      "|---|---|---|---|---|---|\n");
  std::vector<double> hard_ratios;
  std::vector<double> smooth_ratios;
  for (std::size_t n = 0; n < frames.size(); ++n) {
    const Plain plain(*planet, frames[n]);
    DrawRequest hard = frames[n];
    hard.settings.smooth_edges = false;
    DrawRequest smooth = frames[n];
    smooth.settings.smooth_edges = true;
    renderer->draw(hard);
    std::vector<double> flat_ms;
    std::vector<double> bilinear_ms;
    std::vector<double> hard_ms;
    std::vector<double> smooth_ms;
    for (std::int64_t round = 0; round < rounds; ++round) {
      glBindTextureUnit(0, texture.name());
      bilinear_ms.push_back(plain.draw_ms(target, bilinear));
      hard_ms.push_back(renderer->draw(hard).stats.draw_ms);
      flat_ms.push_back(plain.draw_ms(target, flat));
      smooth_ms.push_back(renderer->draw(smooth).stats.draw_ms);
    }
    const double baseline_ms = median_upper(bilinear_ms);
    hard_ratios.push_back(median_upper(hard_ms) / baseline_ms);
    smooth_ratios.push_back(median_upper(smooth_ms) / baseline_ms);
    std::printf("| %zu | %lld | %.1f | %.2f | %.2f | %.2f |\n", n, static_cast<long long>(plain.triangles()),
                baseline_ms, median_upper(flat_ms) / baseline_ms, hard_ratios.back(), smooth_ratios.back());
    std::fflush(stdout);
  }
  std::printf("\nmedian of the frames: edges=hard %.2f, edges=smooth %.2f of plain bilinear drawing\n",
              median_upper(hard_ratios), median_upper(smooth_ratios));
}

}  // namespace

int main(int argc, char** argv) {
  const auto frames = argc > 3 ? vpe::base::parse_integer(argv[3]) : 12;
  const auto rounds = argc > 4 ? vpe::base::parse_integer(argv[4]) : 9;
  if (argc < 3 || argc > 5 || !frames || *frames < 1 || !rounds || *rounds < 1) {
    std::fprintf(stderr, "usage: frame_bench PLANET.vpe FLIGHT [FRAMES] [ROUNDS]\n");
    return 2;
  }
  try {
    run(argv[1], argv[2], *frames, *rounds);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "frame_bench: %s\n", e.what());
    return 1;
  }
  return 0;
}
