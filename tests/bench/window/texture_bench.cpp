// Compares an image by triangles that is read back and uploaded, as a window does by default without a GPU, with one that stays
// in a texture (draw.context=shared).
//
// Usage: texture_bench PLANET [ROUNDS]
//
// Both ways draw the same views in turns with one renderer. Prints for each size the median processor time of all threads and
// of waiting, and the bytes that pass between the CPU and OpenGL for the image's pixels and depths.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <memory>
#include <vector>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sun.h"
#include "tests/bench/compare_rounds.h"
#include "vpe/gl/objects.h"
#include "vpe/gl/opengl.h"
#include "vpe/gl/polygon_renderer.h"

namespace {

namespace gl = vpe::gl;

struct Times {
  std::vector<double> cpu_ms;
  std::vector<double> wall_ms;
};

template <typename Work>
void measure(Times& times, bool counts, const Work& work) {
  const std::clock_t cpu = std::clock();
  const auto wall = std::chrono::steady_clock::now();
  work();
  if (!counts) return;
  times.cpu_ms.push_back(1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
  times.wall_ms.push_back(
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall).count());
}

void compare(const std::shared_ptr<gl::Context>& context,
             const std::shared_ptr<const paging::PlanetFile>& planet, int width, int height, int rounds) {
  constexpr glm::ivec2 kCells(64, 36);
  const auto handover = std::make_shared<gl::TextureHandover>();
  gl::RendererOptions options;
  options.handover = handover;
  const auto renderer = gl::make_polygon_renderer(context, planet, options);
  vpe::core::DrawRequest request;
  const mars::Pose pose{-70, -13, 12'000, 90, -15, 0};
  request.view.camera = mars::to_camera(pose, planet->radius_m());
  request.view.width = width;
  request.view.height = height;
  request.settings.samples = 1;
  request.sun = mars::sun_direction({pose.lon_deg, pose.lat_deg}, 315, 40);
  request.want_rough_range = true;
  const gl::Texture2D uploaded = gl::Texture2D::make();
  const gl::Texture2D drawn = gl::Texture2D::make();
  glBindTexture(GL_TEXTURE_2D, uploaded.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE, nullptr);
  glBindTexture(GL_TEXTURE_2D, drawn.name());
  const auto draw_pixels = [&] {
    *handover = {};
    const vpe::core::DrawResult result = renderer->draw(request);
    glBindTexture(GL_TEXTURE_2D, uploaded.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE,
                    result.frame.colour.data());
    glFinish();
  };
  const auto draw_texture = [&] {
    *handover = {.texture = drawn.name(), .cells = kCells};
    (void)renderer->draw(request);
    glFinish();
  };
  Times pixels;
  Times texture;
  for (int n = 0; n <= rounds; ++n) {
    measure(pixels, n > 0, draw_pixels);
    measure(texture, n > 0, draw_texture);
  }
  const double area = static_cast<double>(width) * height;
  // Colours and depths out, colours in.
  const double by_pixels = area * (4 + 4 + 3);
  const double by_texture = 4.0 * (kCells.x + 1) * (kCells.y + 1);
  std::printf("| %dx%d | %.1f, %.1f | %.1f, %.1f | %.1f, %.3f | %s |\n", width, height,
              bench::median_of(pixels.cpu_ms), bench::median_of(texture.cpu_ms),
              bench::median_of(pixels.wall_ms), bench::median_of(texture.wall_ms), by_pixels * 1e-6,
              by_texture * 1e-6, handover->is_drawn ? "yes" : "NO: pixels");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    std::fputs("usage: texture_bench PLANET [ROUNDS]\n", stderr);
    return 2;
  }
  const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 9;
  const std::shared_ptr<gl::Context> context = gl::Context::create();
  std::printf("%s, %d rounds in turns\n", context->info().renderer.c_str(), rounds);
  std::puts(
      "| size | processor time, ms: pixels, texture | time, ms | MB copied | stayed in OpenGL |\n|---|---|---|---|---|");
  const auto planet = paging::PlanetFile::open(argv[1]);
  for (const glm::ivec2 size : {glm::ivec2(1280, 720), glm::ivec2(1920, 1080)})
    compare(context, planet, size.x, size.y, rounds);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "texture_bench: %s\n", e.what());
  return 1;
}
