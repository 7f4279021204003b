#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <glm/common.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "objects/files/model_file.h"
#include "objects/files/volume_model_file.h"
#include "objects/sticks/build_sticks.h"
#include "objects/sticks/stick_file.h"
#include "objects/sticks/voxelise.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/scene/commands.h"
#include "vpe/app/scene/level_cache.h"
#include "vpe/app/scene/volume_command.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

struct ObjectArguments {
  std::string model;
  std::string output;
  double unit_m = 1;
  std::string up = "auto";
  int voxels = 256;
  bool is_tight = false;
  std::string colour;
  double density = 1;
};

struct Extent {
  glm::dvec3 low_m{0, 0, 0};
  glm::dvec3 high_m{0, 0, 0};
};

Extent extent_of(const objects::Mesh& mesh) {
  Extent e{glm::dvec3(mesh.positions_m.front()), glm::dvec3(mesh.positions_m.front())};
  for (const glm::vec3& p : mesh.positions_m) {
    e.low_m = glm::min(e.low_m, glm::dvec3(p));
    e.high_m = glm::max(e.high_m, glm::dvec3(p));
  }
  return e;
}

std::string size_text(const glm::dvec3& m) {
  return length_text(m.x, 3) + " wide, " + length_text(m.y, 3) + " long, " + length_text(m.z, 3) + " high";
}

nlohmann::json sticks_json(const objects::StickModel& sticks) {
  const objects::StickModel::Level& finest = sticks.levels().front();
  return {{"columns", {finest.grid.columns_x, finest.grid.columns_y}},
          {"height", finest.grid.height},
          {"voxel_m", finest.grid.voxel_m},
          {"sticks", finest.sticks.size()},
          {"runs", finest.runs.size()},
          {"coloured_voxels", finest.voxels.size()},
          {"levels", sticks.levels().size()}};
}

void print_sticks(const objects::StickModel& sticks) {
  const objects::StickModel::Level& finest = sticks.levels().front();
  std::printf(
      "%d x %d columns of %d voxels of %s; %zu different sticks, %zu runs, %zu coloured voxels, %zu levels\n",
      finest.grid.columns_x, finest.grid.columns_y, finest.grid.height,
      length_text(static_cast<double>(finest.grid.voxel_m), 3).c_str(), finest.sticks.size(),
      finest.runs.size(), finest.voxels.size(), sticks.levels().size());
}

// Says what a model of sticks holds.
void describe_sticks(const ObjectArguments& arguments, const Common& common) {
  const objects::StickModel sticks = objects::read_stick_file(arguments.model);
  if (common.json) {
    print_json(sticks_json(sticks));
  } else {
    print_sticks(sticks);
  }
}

// Says what a model holds and how far it can be simplified.
void describe(const ObjectArguments& arguments, objects::ModelFile file, const Common& common) {
  const Extent extent = extent_of(file.mesh);
  const std::size_t vertices = file.mesh.positions_m.size();
  const std::size_t materials = file.mesh.material_table.size();
  const std::size_t textures = file.mesh.textures.size();
  const KeptLevels made = cached_levels(std::move(file.mesh), {});
  if (!made.note.empty()) {
    if (!common.quiet) std::fprintf(stderr, "vpe: note: %s: %s\n", arguments.model.c_str(), made.note.c_str());
    file.notes.push_back(made.note);
  }
  const std::vector<objects::MeshLevel>& levels = made.levels;
  if (common.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const objects::MeshLevel& level : levels)
      list.push_back(
          {{"triangles", level.mesh.triangles.size()}, {"geometric_error_m", level.geometric_error_m}});
    const auto numbers = [](const glm::dvec3& v) { return nlohmann::json{v.x, v.y, v.z}; };
    print_json({{"vertices", vertices},
                {"triangles", levels.front().mesh.triangles.size()},
                {"materials", materials},
                {"textures", textures},
                {"low_m", numbers(extent.low_m)},
                {"high_m", numbers(extent.high_m)},
                {"levels", std::move(list)},
                {"notes", file.notes}});
    return;
  }
  std::printf("%zu triangles, %zu vertices, %zu materials, %zu textures\n",
              levels.front().mesh.triangles.size(), vertices, materials, textures);
  std::printf("%s; the ground is %s above its foot\n", size_text(extent.high_m - extent.low_m).c_str(),
              length_text(-extent.low_m.z, 3).c_str());
  for (std::size_t n = 1; n < levels.size(); ++n)
    std::printf("level %zu: %zu triangles, within %s\n", n, levels[n].mesh.triangles.size(),
                length_text(levels[n].geometric_error_m, 3).c_str());
}

void run_object(const ObjectArguments& arguments, const Common& common) {
  const bool is_volume = objects::is_volume_path(arguments.model);
  check_outputs({{"-o", arguments.output, is_volume ? FileKind::kVolume : FileKind::kSticks}},
                {arguments.model});
  const bool is_sticks = std::filesystem::path(arguments.model).extension() == ".sticks";
  if (is_sticks && !arguments.output.empty())
    throw UsageError(arguments.model + ": is a model of sticks already; name the model that it was made from");
  if (is_sticks) return describe_sticks(arguments, common);
  static const std::map<std::string, objects::UpAxis> kAxes{
      {"auto", objects::UpAxis::kAuto}, {"y", objects::UpAxis::kY}, {"z", objects::UpAxis::kZ}};
  const objects::ModelFileOptions options{.unit_m = arguments.unit_m, .up = kAxes.at(arguments.up)};
  if (is_volume)
    return run_volume({arguments.model, arguments.output, options, arguments.colour, arguments.density},
                      common);
  if (!arguments.colour.empty() || arguments.density != 1)
    throw UsageError("--colour and --density are for volumes (.volume, .vdb)");
  objects::ModelFile file = objects::read_model_file(arguments.model, options);
  if (!common.quiet) {
    for (const std::string& note : file.notes)
      std::fprintf(stderr, "vpe: note: %s: %s\n", arguments.model.c_str(), note.c_str());
  }
  if (arguments.output.empty()) return describe(arguments, std::move(file), common);
  std::vector<objects::TexturePyramid> textures;
  for (objects::Texture& t : file.mesh.textures) textures.emplace_back(std::move(t));
  file.mesh.textures.clear();
  const objects::StickModel sticks = objects::build_sticks(objects::voxelise(
      file.mesh, textures, {.voxels_longest = arguments.voxels, .is_tight = arguments.is_tight}));
  objects::write_stick_file(arguments.output, sticks);
  if (common.json) {
    print_json(sticks_json(sticks));
  } else if (!common.quiet) {
    std::printf("%s: ", arguments.output.c_str());
    print_sticks(sticks);
  }
}

}  // namespace

void add_object(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<ObjectArguments>();
  CLI::App* command =
      add_command(program, "object",
                  "Describe a model of an object, or make a model of sticks (voxels) from it", common, true);
  command
      ->add_option("MODEL", arguments->model,
                   "Model: .glb, .gltf, .obj, .ply, .stl, .sticks, or a volume: .volume, .vdb (OpenVDB)")
      ->required();
  command->add_option(
      "-o,--output", arguments->output,
      "Model of sticks to write (.sticks), from a volume a .volume; else the model is described");
  command->add_option("--voxels", arguments->voxels, "Voxels along the longest side")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_option("--unit", arguments->unit_m, "Length of the file's unit, metres")
      ->check(number_within(1e-9, 1e9))
      ->capture_default_str();
  command
      ->add_option("--up", arguments->up,
                   "Axis of the file that points up; auto: y for glTF, OBJ and OpenVDB, z for PLY and STL")
      ->check(CLI::IsMember({"auto", "y", "z"}))
      ->capture_default_str();
  command->add_flag(
      "--tight", arguments->is_tight,
      "Leave out voxels whose centres lie outside: silhouettes are then no larger than the model's");
  command->add_option("--colour", arguments->colour, "Colour of a volume in full light, rrggbb");
  command->add_option("--density", arguments->density, "Factor on the extinction of a volume")
      ->check(number_within(1e-9, 1e9))
      ->capture_default_str();
  add_examples(*command,
               {{"what a model holds, and how far it can be simplified", "vpe object rover.glb"},
                {"a model of sticks of it", "vpe object rover.glb -o rover.sticks --voxels 512"},
                {"a drawing in millimetres", "vpe object part.stl --unit 0.001 -o part.sticks"},
                {"a volume of OpenVDB", "vpe object smoke.vdb --density 0.2 --colour c8a078 -o smoke.volume"}});
  command->callback([arguments, &common] { run_object(*arguments, common); });
}

}  // namespace vpe::app
