// Writes the seeds of a target into a folder: vpe_fuzz_seeds NAME FOLDER.
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/targets.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  for (const fuzz::Target* target :
       {&fuzz::kFlight, &fuzz::kPayload, &fuzz::kPlanet, &fuzz::kForged, &fuzz::kLabel, &fuzz::kRover,
        &fuzz::kGpano, &fuzz::kSidecar, &fuzz::kImage, &fuzz::kPlace, &fuzz::kTable, &fuzz::kAxes,
        &fuzz::kScene, &fuzz::kRelief, &fuzz::kSticks, &fuzz::kMesh, &fuzz::kVolume}) {
    if (std::strcmp(target->name, argv[1]) != 0) continue;
    std::filesystem::create_directories(argv[2]);
    int number = 0;
    for (const fuzz::Bytes& bytes : target->seeds()) {
      std::ofstream out(std::filesystem::path(argv[2]) / ("seed-" + std::to_string(number++)),
                        std::ios::binary);
      out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    return 0;
  }
  std::fprintf(stderr, "no target '%s'\n", argv[1]);
  return 2;
}
