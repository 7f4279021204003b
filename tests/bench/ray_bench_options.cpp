#include "tests/bench/ray_bench_options.h"

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "vpe/base/number.h"

namespace bench {

void refuse(const std::string& what) {
  throw std::invalid_argument(
      what +
      "; ray_bench [--dir DIR] [--scenes 513,2049,8193,mars] [--mars FILE] [--scale S] "
      "[--threads N] [--rounds N] [--cell PX] [--nearest PX] [--show PIXELS] [--memory MiB] [--mesh-limit TRIANGLES] "
      "[--benchmark_filter=REGEX] [--help]");
}

RayBenchOptions parse_options(int argc, char** argv) {
  RayBenchOptions options;
  for (int n = 1; n < argc; n += 2) {
    const std::string key = argv[n];
    if (n + 1 == argc) refuse(key + " needs a value");
    const std::string value = argv[n + 1];
    const auto number = [&](double least) {
      const auto parsed = vpe::base::parse_number(value);
      if (!parsed || *parsed < least) refuse(key + " " + value + ": not a number, or too small");
      return *parsed;
    };
    if (key == "--dir") {
      options.dir = value;
    } else if (key == "--scenes") {
      options.scenes = value;
    } else if (key == "--mars") {
      options.mars = value;
    } else if (key == "--scale") {
      options.scale = number(0.001);
    } else if (key == "--threads") {
      options.threads = static_cast<int>(number(0));
    } else if (key == "--rounds") {
      options.rounds = static_cast<int>(number(1));
    } else if (key == "--cell") {
      options.cell_px = number(0);
    } else if (key == "--nearest") {
      options.nearest_px = number(0);
    } else if (key == "--show") {
      options.show = static_cast<int>(number(0));
    } else if (key == "--memory") {
      options.memory_mib = number(1);
    } else if (key == "--mesh-limit") {
      options.mesh_limit = number(0);
    } else {
      refuse(key + " is not an option");
    }
  }
  return options;
}

std::string cached_mars() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  const std::filesystem::path folder = cache != nullptr
                                           ? std::filesystem::path(cache)
                                           : std::filesystem::path(home != nullptr ? home : ".") / ".cache";
  return (folder / "vpe" / "embedded-mars-6.vpe").string();
}

}  // namespace bench
