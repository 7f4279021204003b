// Files of objects: scenes, models of sticks, volumes, and what the reader of models sends.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "objects/files/mesh_stream.h"
#include "objects/files/scene_file.h"
#include "objects/model/shapes.h"
#include "objects/sticks/build_sticks.h"
#include "objects/sticks/stick_file.h"
#include "objects/sticks/voxelise.h"
#include "objects/volumes/volume_file.h"
#include "objects/volumes/volume_march.h"
#include "tests/fuzz/targets.h"

namespace fuzz {
namespace {

namespace fs = std::filesystem;

Bytes bytes_of_text(const std::string& text) { return {text.begin(), text.end()}; }

const std::string& stick_scratch() {
  static const std::string path = [] {
    const fs::path folder = ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : fs::temp_directory_path();
    static const std::string kept = (folder / ("vpe-fuzz-" + std::to_string(::getpid()) + ".sticks")).string();
    std::atexit([] {
      std::error_code none;
      fs::remove(kept, none);
    });
    return kept;
  }();
  return path;
}

void check_scene(const objects::SceneFile& scene) {
  const auto is_model = [&](std::size_t n) { return n < scene.models.size(); };
  for (const objects::ObjectEntry& object : scene.objects) {
    require(is_model(object.model), "objects have models");
    for (const objects::Placing& p : object.places)
      require(mars::is_valid(p.place) && p.scale > 0, "objects stand somewhere");
  }
  for (const objects::ScatterEntry& entry : scene.scatters) {
    require(!entry.models.empty() && entry.polygon.size() >= 3, "rocks have models and a polygon");
    require(entry.least_diameter_m > 0 && entry.least_diameter_m <= entry.most_diameter_m, "rocks have sizes");
  }
  for (const objects::PathEntry& path : scene.paths) {
    require(is_model(path.model) && !path.points.empty(), "paths have models and points");
    for (std::size_t n = 1; n < path.points.size(); ++n)
      require(path.points[n - 1].time_s < path.points[n].time_s, "times ascend");
  }
}

// The first byte selects the format.
void run_scene(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + 1, bytes.size() - 1);
  try {
    check_scene(bytes[0] % 2 == 0 ? objects::parse_scene_toml(text, "fuzz.scene.toml")
                                  : objects::parse_scene_geojson(text, "fuzz.geojson"));
  } catch (const std::runtime_error& e) {
    require(std::string_view(e.what()).starts_with("fuzz."), "messages name the file");
  }
}

std::vector<Bytes> scene_seeds() {
  std::vector<Bytes> all{
      bytes_of_text(
          " version = 1\n[[model]]\nname = \"a\"\nfile = \"a.glb\"\nunit_m = 0.01\nup = \"z\"\n"
          "[[object]]\nmodel = \"a\"\nname = \"x\"\nlon = 1\nlat = 2\nheight = 3\nheading = 4\nalign = \"slope\"\n"
          "[[object]]\nmodel = \"a\"\nat = [[1, 2], [3, 4, 5]]\nscale = 2\n"
          "[[scatter]]\nmodels = [\"a\"]\npolygon = [[0, 0], [1, 0], [0, 1]]\nrock_abundance = 0.1\n"
          "diameter_m = [0.1, 2]\nseed = 4\n[[path]]\nmodel = \"a\"\npoints = [[0, 1, 2], [5, 2, 3, 90]]\n"
          "wheelbase_m = 2\ntrack_m = 2\n[[volume]]\nname = \"d\"\nkind = \"plume\"\nheight_m = 90\nradius_m = 20\n"
          "lean_m = 4\noptical_depth = 0.5\ncolour = [1, 2, 3]\nseed = 3\nvoxels = 32\n"),
      bytes_of_text(
          "!{\"type\": \"FeatureCollection\", \"features\": [{\"type\": \"Feature\", \"geometry\": {\"type\": "
          "\"Point\", \"coordinates\": [1, 2]}, \"properties\": {\"model\": \"a.glb\", \"heading\": 3, "
          "\"scale\": 2, \"name\": \"x\", \"align\": \"slope\"}}]}")};
  all[0][0] = 0;
  all[1][0] = 1;
  return all;
}

void run_sticks(std::span<const std::uint8_t> bytes) {
  std::ofstream(stick_scratch(), std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  try {
    const objects::StickModel model = objects::read_stick_file(stick_scratch());
    require(!model.levels().empty(), "a model has levels");
    objects::StickHits hits;
    for (std::size_t level = 0; level < model.levels().size(); ++level) {
      require(objects::check(model.levels()[level]).empty(), "levels are sound");
      const objects::Ball& ball = model.ball();
      model.cast({ball.centre_m - glm::vec3(2 * ball.radius_m, 0, 0), {1, 0.1F, 0.05F}}, level,
                 std::numeric_limits<float>::infinity(), hits);
    }
  } catch (const std::runtime_error& e) {
    require(std::string_view(e.what()).find(".sticks") != std::string_view::npos, "messages name the file");
  }
}

std::vector<Bytes> stick_seeds() {
  std::vector<Bytes> all;
  for (const objects::Mesh& mesh : {objects::make_box({1, 2, 1}), objects::make_ellipsoid({1, 1, 1}, 12)}) {
    objects::write_stick_file(stick_scratch(),
                              objects::build_sticks(objects::voxelise(mesh, {}, {.voxels_longest = 12})));
    std::ifstream in(stick_scratch(), std::ios::binary);
    all.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return all;
}

void run_mesh(std::span<const std::uint8_t> bytes) {
  try {
    const objects::MeshStream stream = objects::read_mesh_stream(bytes);
    require(!stream.error.empty() || objects::check(stream.mesh).empty(),
            "a mesh can be drawn, or there is an error");
  } catch (const std::runtime_error&) {
  }
  try {
    const objects::MeshStream stream = objects::read_mesh_stream(bytes, true);
    require(
        !stream.error.empty() || !stream.mesh.triangles.empty() || objects::check_points(stream.mesh).empty(),
        "points are sound, or there is an error");
  } catch (const std::runtime_error&) {
  }
}

std::vector<Bytes> mesh_seeds() {
  std::vector<Bytes> all;
  objects::Mesh mesh = objects::make_cone(1, 2, 7);
  const auto add = [&](const objects::MeshStream& stream) {
    Bytes& bytes = all.emplace_back();
    objects::write_mesh_stream(stream, [&](std::span<const std::uint8_t> piece) {
      bytes.insert(bytes.end(), piece.begin(), piece.end());
    });
  };
  add({mesh, {"a note"}, "", ""});
  mesh.uvs.assign(mesh.positions_m.size(), {0.5F, 0.5F});
  mesh.colours.assign(mesh.positions_m.size(), {1, 2, 3, 4});
  mesh.textures = {{2, 1, {{1, 2, 3, 255}, {4, 5, 6, 0}}}};
  mesh.material_table[0].texture = 0;
  add({mesh, {}, "", ""});
  add({{}, {}, "it is damaged", "take another"});
  objects::Mesh points;
  points.positions_m = {{0, 0, 0}, {1, 2, 3}};
  points.normals.assign(2, {0, 0, 1});
  points.colours.assign(2, {1, 2, 3, 255});
  add({points, {}, "", ""});
  return all;
}

void run_volume(std::span<const std::uint8_t> bytes) {
  try {
    const objects::VolumeModel model = objects::volume_of_bytes(bytes, "fuzz.volume");
    require(!model.levels().empty(), "a volume has levels");
    for (const objects::VolumeLevel& level : model.levels()) {
      require(objects::check(level).empty(), "levels are sound");
      const glm::dvec3 from(model.ball().centre_m - 2 * model.ball().radius_m);
      const double depth = objects::optical_depth(level, {from, {1, 0.9, 1.1}}, 0, 1e9);
      require(depth >= 0, "depths are numbers");
    }
  } catch (const std::runtime_error& e) {
    require(std::string_view(e.what()).find("fuzz.volume") != std::string_view::npos, "messages name the file");
  }
}

std::vector<Bytes> volume_seeds() {
  std::vector<Bytes> all;
  for (const int side : {4, 12}) {
    objects::DenseVolume dense({{side, side, side + 3}, 0.5F, {-1, -1, 0}});
    for (std::size_t n = 0; n < dense.values().size(); n += 3)
      dense.values()[n] = static_cast<float>(n % 7) / 10;
    all.push_back(objects::volume_bytes(objects::build_level(dense), {200, 100, 50, 255}, "fuzz.volume"));
  }
  return all;
}

}  // namespace

const Target kVolume{"volume", run_volume, volume_seeds};
const Target kScene{"scene", run_scene, scene_seeds};
const Target kSticks{"sticks", run_sticks, stick_seeds};
const Target kMesh{"mesh", run_mesh, mesh_seeds};

}  // namespace fuzz
