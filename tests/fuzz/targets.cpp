#include "tests/fuzz/targets.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "paging/build/builder.h"
#include "paging/planet/codec.h"
#include "paging/planet/verify.h"
#include "scripts/flight.h"
#include "scripts/ground_tracks.h"
#include "tests/support/fake_source.h"
#include "vpe/core/image/image.h"

namespace fuzz {

namespace {

namespace fs = std::filesystem;

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Bytes read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// Returns a file of this process alone, in memory where the system has such a folder.
const std::string& scratch() {
  static const std::string path = [] {
    const fs::path folder = ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : fs::temp_directory_path();
    std::string name = (folder / ("vpe-fuzz-" + std::to_string(::getpid()) + ".vpe")).string();
    static const std::string kept = name;
    std::atexit([] {
      std::error_code none;
      fs::remove(kept, none);
    });
    return name;
  }();
  return path;
}

void run_flight(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const scripts::ParsedFlight parsed = scripts::parse_flight(text, "fuzz.flight");
  require(parsed.flight.has_value() == parsed.errors.empty(), "a flight or errors, not both");
  if (!parsed.flight) {
    for (const scripts::FlightError& error : parsed.errors)
      require(!scripts::to_string(error).empty(), "words");
    return;
  }
  const scripts::ParsedFlight again = scripts::parse_flight(scripts::to_text(*parsed.flight), "again.flight");
  require(again.flight.has_value() && *again.flight == *parsed.flight, "a flight survives being written");
  require(scripts::duration_s(*parsed.flight) >= 0, "no negative duration");
  require(parsed.flight->views.empty() || scripts::version_of(*parsed.flight) >= scripts::FlightVersion::k1_1,
          "views need version 1.1");
  require(parsed.flight->objects.empty() || scripts::version_of(*parsed.flight) >= scripts::FlightVersion::k1_2,
          "objects need version 1.2");
  try {
    const scripts::GroundTracks ground(*parsed.flight, mars::kMarsRadius_m);
    for (const double time_s : ground.times_s()) {
      for (const double later_s : {0.0, 1e-3, 7.0}) {
        const scripts::GroundState state = ground.at(time_s + later_s);
        for (const relief::ReliefSpec& one : state.reliefs)
          require(relief::problem_of(one).empty(), "reliefs are sound at any time");
        for (const scripts::PatchState& one : state.patches)
          require(one.mix > 0 && one.mix <= 1, "mixes are shares");
      }
    }
  } catch (const std::runtime_error& e) {
    require(std::string_view(e.what()).starts_with("the relief \""), "messages name the relief");
  }
}

std::vector<Bytes> flight_seeds() {
  std::vector<Bytes> all{
      bytes_of("flight 1\nview fov=60 size=64x48 fps=30000/1001\nat 0 pose lon=1 lat=2 alt=3e5 "
               "yaw=4 pitch=-5 roll=6\nat 1:02.5 set mode=lit sun.azimuth=10\nat 2 look yaw=1 "
               "pitch=2\nat 3 interest lon=1 lat=2 radius=1000 levels=2\nat 90 end\n"),
      bytes_of(
          "flight 1.1\nview fov=60\nat 0 pose lon=1 lat=2 alt=3e5\nat 0 view fov=30 backend=ray eyes=sbs "
          "base=2.5 size=640x360\nat 2 view eyes=off backend=auto\nat 3 view fov=40 eyes=anaglyph base=0\n"),
      bytes_of("flight 1.2\nat 0 pose lon=1 lat=2 alt=3e5\nat 0 object \"a b\" lon=1 lat=2 height=3 heading=4\n"
               "at 2 object c show=off\nat 3 object \"a b\" lon=1.5 lat=2 show=on\nat 4 view fov=30\n"),
      bytes_of(
          "flight 1.3\nat 0 pose lon=1 lat=2 alt=3e5\nat 0 relief \"a b\" kind=crater lon=1 lat=2 radius=30\n"
          "at 0 patch b.vpe mix=0\nat 2 relief \"a b\" radius=90 lon=-1 mode=min\nat 3 relief \"a b\" show=off\n"
          "at 4 patch b.vpe mix=0.5\nat 5 relief \"a b\" kind=pad lon=1 lat=2 radius=3 rise=1\n"),
      bytes_of("# nothing\nflight 1\n")};
  const fs::path folder = fs::path(VPE_SOURCE_DIR) / "scripts" / "flights";
  for (const auto& entry : fs::directory_iterator(folder)) all.push_back(read(entry.path()));
  return all;
}

void run_payload(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  const auto rest = bytes.subspan(1);
  constexpr int kSide = 9;
  try {
    switch (bytes[0] % 4) {
      case 0: {
        const auto quanta = paging::decode_heights(rest, kSide);
        require(quanta.size() == std::size_t{kSide} * kSide, "as many heights as asked for");
        require(paging::decode_heights(paging::encode_heights(quanta, kSide), kSide) == quanta,
                "heights survive");
        break;
      }
      case 1: {
        const auto mask = paging::decode_mask(rest, 81);
        require(mask.size() == 81, "as many flags as asked for");
        require(paging::decode_mask(paging::encode_mask(mask), 81) == mask, "masks survive");
        break;
      }
      case 2: {
        const paging::PackedMesh mesh = paging::decode_mesh(rest, 8);
        require(mesh.height_q.size() == mesh.mesh.vertices.size(), "a height for each vertex");
        for (const std::uint16_t v : mesh.mesh.triangles)
          require(v < mesh.mesh.vertices.size(), "indices in range");
        for (const lod::MeshVertex& v : mesh.mesh.vertices) {
          require(v.i <= mesh.mesh.intervals && v.j <= mesh.mesh.intervals, "vertices in the grid");
        }
        const paging::PackedMesh again = paging::decode_mesh(paging::encode_mesh(mesh), 8);
        require(again.height_q == mesh.height_q && again.mesh.vertices == mesh.mesh.vertices, "meshes survive");
        break;
      }
      default: vpe::core::decode_jpeg(rest, 257 * 257); break;
    }
  } catch (const paging::CodecError&) {
  } catch (const std::runtime_error&) {
    require(bytes[0] % 4 == 3, "decoders of ours throw CodecError");
  }
}

std::vector<Bytes> payload_seeds() {
  std::vector<std::int32_t> quanta(81);
  for (std::size_t n = 0; n < quanta.size(); ++n) quanta[n] = static_cast<std::int32_t>(n * n) - 3000;
  paging::PackedMesh mesh{lod::mesh_full(8), quanta};
  std::vector<bool> mask(81);
  mask[7] = mask[80] = true;
  const std::vector<vpe::base::Rgb> pixels(64, {200, 100, 50});
  const Bytes payloads[] = {paging::encode_heights(quanta, 9), paging::encode_mask(mask),
                            paging::encode_mesh(mesh), vpe::core::encode_jpeg(pixels, 8, 8, 90)};
  std::vector<Bytes> all;
  std::uint8_t kind = 0;
  for (const Bytes& payload : payloads) {
    Bytes seed{kind++};
    seed.insert(seed.end(), payload.begin(), payload.end());
    all.push_back(seed);
  }
  return all;
}

// A file in which verify() finds no problem must have the content that was built.
const std::string& seed_identity();

void run_planet(std::span<const std::uint8_t> bytes) {
  {
    std::ofstream out(scratch(), std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  try {
    const auto planet = paging::PlanetFile::open(scratch());
    paging::VerifyOptions options;
    options.threads = 1;
    const paging::VerifyReport report = paging::verify(*planet, options);
    if (report.problems.empty()) {
      require(planet->meta().identity == seed_identity(), "only the planet itself is sound");
    }
  } catch (const paging::PlanetError&) {
  }
}

const Bytes& seed_planet() {
  static const Bytes file = [] {
    const test_support::FakeElevation source(test_support::bumpy_height);
    paging::BuildOptions options;
    options.output = scratch();
    options.base_spacing_m = 1e6;
    options.tile_k = 3;
    options.threads = 1;
    options.resampling_posts = 100;
    paging::build_planet(options, source, nullptr);
    return read(scratch());
  }();
  return file;
}

const std::string& seed_identity() {
  static const std::string identity = [] {
    const Bytes& file = seed_planet();
    std::ofstream out(scratch() + ".seed", std::ios::binary);
    out.write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
    out.close();
    std::string text = paging::PlanetFile::open(scratch() + ".seed")->meta().identity;
    fs::remove(scratch() + ".seed");
    return text;
  }();
  return identity;
}

std::vector<Bytes> planet_seeds() { return {seed_planet()}; }

}  // namespace

const Target kFlight{"flight", run_flight, flight_seeds};
const Target kPayload{"payload", run_payload, payload_seeds};
const Target kPlanet{"planet", run_planet, planet_seeds};

void require(bool promise, const char* words) {
  if (promise) return;
  std::fprintf(stderr, "broken promise: %s\n", words);
  std::abort();
}

}  // namespace fuzz
