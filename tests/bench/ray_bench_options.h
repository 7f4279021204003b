// Parses the command line of ray_bench.
#pragma once

#include <string>

namespace bench {

// Fields are the options of the same names (ray_bench.cpp).
struct RayBenchOptions {
  std::string dir;
  std::string scenes = "513,2049,8193,mars";
  std::string mars;
  double scale = 1;
  int threads = 0;
  int rounds = 5;
  double cell_px = 0;  // > 0: mode multires, and shifts against Embree's exact image
  double nearest_px =
      0;  // > 0: perspective pixels take the nearest sample of columns so far apart (rays.sample=nearest)
  int show = 0;  // wrong pixels of a view to list on stderr
  double memory_mib = 4096;
  double mesh_limit = 4e7;  // triangles; beyond it only the grid, whose structure is a sixth as large
};

// Parses what Google Benchmark has left of the command line. Throws std::invalid_argument with the usage.
RayBenchOptions parse_options(int argc, char** argv);

// Throws std::invalid_argument with the problem and the usage.
[[noreturn]] void refuse(const std::string& what);

// Returns the planet file that `vpe` builds on its first run without a planet.
std::string cached_mars();

}  // namespace bench
