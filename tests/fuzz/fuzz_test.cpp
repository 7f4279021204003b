// A short run of the fuzz targets with changes of bytes made here, on every machine. ./test.sh --fuzz runs
// them under libFuzzer.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/fuzz/targets.h"
#include "tests/support/support.h"

namespace {

using test_support::Random;

std::size_t any_place(Random& random, std::size_t size) {
  return static_cast<std::size_t>(random.integer(0, static_cast<int>(size) - 1));
}

// Makes a few small changes: bits, significant bytes, pieces cut, doubled or moved, pieces of another input.
fuzz::Bytes damaged(const fuzz::Bytes& seed, const fuzz::Bytes& other, Random& random) {
  fuzz::Bytes bytes = seed;
  for (int n = random.integer(1, 6); n > 0 && !bytes.empty(); --n) {
    const std::size_t at = any_place(random, bytes.size());
    const std::size_t length = std::min(bytes.size() - at, static_cast<std::size_t>(random.integer(1, 40)));
    switch (random.integer(0, 6)) {
      case 0: bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1 << random.integer(0, 7))); break;
      case 1: {
        constexpr std::uint8_t kSignificant[] = {0, 1, 0x7f, 0x80, 0xff, '\n', ' ', '-', '.', '9', 'e', '='};
        bytes[at] = kSignificant[any_place(random, std::size(kSignificant))];
        break;
      }
      case 2: bytes.resize(at); break;
      case 3:
        bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
        break;
      case 4: {
        const fuzz::Bytes piece(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                                bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(any_place(random, bytes.size())),
                     piece.begin(), piece.end());
        break;
      }
      case 5: bytes[at] = static_cast<std::uint8_t>(random.integer(0, 255)); break;
      default: {
        if (other.empty()) break;
        const std::size_t from = any_place(random, other.size());
        for (std::size_t k = 0; k < length && from + k < other.size(); ++k) bytes[at + k] = other[from + k];
      }
    }
  }
  return bytes;
}

void run(const fuzz::Target& target, int times, std::uint64_t seed) {
  Random random(seed);
  const std::vector<fuzz::Bytes> seeds = target.seeds();
  target.run({});
  for (const fuzz::Bytes& bytes : seeds) target.run(bytes);
  for (int n = 0; n < times; ++n) {
    const auto& bytes = seeds[any_place(random, seeds.size())];
    const auto& other = seeds[any_place(random, seeds.size())];
    target.run(damaged(bytes, other, random));
  }
}

TEST(Fuzz, Flights) { run(fuzz::kFlight, 100000, 1001); }
TEST(Fuzz, Payloads) { run(fuzz::kPayload, 60000, 1002); }
TEST(Fuzz, Labels) { run(fuzz::kLabel, 1500, 1004); }
TEST(Fuzz, RoverLabels) { run(fuzz::kRover, 20000, 1005); }
TEST(Fuzz, GPano) { run(fuzz::kGpano, 10000, 1006); }
TEST(Fuzz, Sidecars) { run(fuzz::kSidecar, 20000, 1007); }
TEST(Fuzz, Images) { run(fuzz::kImage, 3000, 1008); }
TEST(Fuzz, Places) { run(fuzz::kPlace, 100000, 1010); }
TEST(Fuzz, TablesOfPlaces) { run(fuzz::kTable, 50000, 1011); }
TEST(Fuzz, AxisOrders) { run(fuzz::kAxes, 500, 1012); }
TEST(Fuzz, Scenes) { run(fuzz::kScene, 5000, 1013); }
TEST(Fuzz, Reliefs) { run(fuzz::kRelief, 20000, 1017); }
TEST(Fuzz, Sticks) { run(fuzz::kSticks, 3000, 1014); }
TEST(Fuzz, Meshes) { run(fuzz::kMesh, 20000, 1015); }
TEST(Fuzz, Volumes) { run(fuzz::kVolume, 10000, 1016); }
TEST(Fuzz, ForgedPlanets) { run(fuzz::kForged, 800, 1009); }
TEST(Fuzz, Planets) { run(fuzz::kPlanet, 1500, 1003); }

}  // namespace
