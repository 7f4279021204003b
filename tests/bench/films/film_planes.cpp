// Makes planes of 4:2:0 of raw frames (three bytes a pixel) as films do, and prints the time a frame to stderr.
//
//   film_planes WIDTHxHEIGHT <frames.rgb >frames.yuv
//
// tests/bench/film_encoding.sh uses it. docs/measurements/films.md has the figures.
#include <cstdio>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <vector>

#include "vpe/app/film/planar_420.h"

int main(int argc, char** argv) try {
  int width = 0, height = 0;
  char rest = 0;
  if (argc != 2 || std::sscanf(argv[1], "%dx%d%c", &width, &height, &rest) != 2 || width < 2 || height < 2) {
    std::fputs("usage: film_planes WIDTHxHEIGHT <frames.rgb >frames.yuv\n", stderr);
    return 2;
  }
  std::vector<vpe::base::Rgb> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<std::uint8_t> planes;
  int frames = 0;
  std::clock_t ticks = 0;
  for (;; ++frames) {
    const std::size_t read = std::fread(pixels.data(), sizeof pixels[0], pixels.size(), stdin);
    if (read == 0) break;
    if (read != pixels.size()) throw std::runtime_error("the last frame is not whole");
    const std::clock_t start = std::clock();
    vpe::app::to_planar_420(pixels, width, height, planes);
    ticks += std::clock() - start;
    if (std::fwrite(planes.data(), 1, planes.size(), stdout) != planes.size())
      throw std::runtime_error("cannot write the planes");
  }
  if (frames == 0) throw std::runtime_error("no frames");
  std::fprintf(stderr, "%d frames, %.2f ms of processor time each\n", frames,
               1e3 * static_cast<double>(ticks) / CLOCKS_PER_SEC / frames);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "film_planes: %s\n", e.what());
  return 1;
}
