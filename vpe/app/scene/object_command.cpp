#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "objects/files/model_file.h"
#include "objects/files/volume_model_file.h"
#include "objects/points/voxelise_points.h"
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
#include "vpe/app/scene/model_figures.h"
#include "vpe/app/scene/point_command.h"
#include "vpe/app/scene/volume_command.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr int kCloseVoxels = objects::VoxelisePointsOptions().close_voxels;
constexpr const char* kCloseIsForPoints = "--close is for point clouds (PLY without faces)";

struct ObjectArguments {
  std::string model;
  std::string output;
  double unit_m = 1;
  std::string up = "auto";
  int voxels = 256;
  bool is_tight = false;
  std::optional<int> close_voxels;
  std::string colour;
  double density = 1;
  double levels_m = 0;  // 0: the model is no raster
};

// Says what a model of sticks holds.
void describe_sticks(const ObjectArguments& arguments, const Common& common) {
  print_sticks(objects::read_stick_file(arguments.model), common);
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
    print_json({{"vertices", vertices},
                {"triangles", levels.front().mesh.triangles.size()},
                {"materials", materials},
                {"textures", textures},
                {"low_m", vector_json(extent.low_m)},
                {"high_m", vector_json(extent.high_m)},
                {"levels", std::move(list)},
                {"notes", file.notes}});
    return;
  }
  std::printf("%zu triangles, %zu vertices, %zu materials, %zu textures\n",
              levels.front().mesh.triangles.size(), vertices, materials, textures);
  std::printf("%s; the ground is %s above its foot\n", extent_text(extent).c_str(),
              length_text(-extent.low_m.z, 3).c_str());
  for (std::size_t n = 1; n < levels.size(); ++n)
    std::printf("level %zu: %zu triangles, within %s\n", n, levels[n].mesh.triangles.size(),
                length_text(levels[n].geometric_error_m, 3).c_str());
}

void run_object(const ObjectArguments& arguments, const Common& common) {
  const bool is_volume = arguments.levels_m > 0 || objects::is_volume_path(arguments.model);
  check_outputs({{"-o", arguments.output, is_volume ? FileKind::kVolume : FileKind::kSticks}},
                {arguments.model});
  const bool is_sticks = std::filesystem::path(arguments.model).extension() == ".sticks";
  if (arguments.levels_m > 0 && (is_sticks || objects::is_volume_path(arguments.model)))
    throw UsageError("--levels is for rasters with a band for each level, and " + arguments.model +
                     " is a model already");
  if (is_sticks && !arguments.output.empty())
    throw UsageError(arguments.model + ": is a model of sticks already; name the model that it was made from");
  if (arguments.close_voxels && (is_sticks || is_volume)) throw UsageError(kCloseIsForPoints);
  if (is_sticks) return describe_sticks(arguments, common);
  static const std::map<std::string, objects::UpAxis> kAxes{
      {"auto", objects::UpAxis::kAuto}, {"y", objects::UpAxis::kY}, {"z", objects::UpAxis::kZ}};
  objects::ModelFileOptions options{.unit_m = arguments.unit_m, .up = kAxes.at(arguments.up)};
  if (is_volume)
    return run_volume(
        {arguments.model, arguments.output, options, arguments.colour, arguments.density, arguments.levels_m},
        common);
  if (!arguments.colour.empty() || arguments.density != 1)
    throw UsageError("--colour and --density are for volumes (.volume, .vdb, rasters with --levels)");
  options.allows_points = true;
  objects::ModelFile file = objects::read_model_file(arguments.model, options);
  const bool is_points = file.mesh.triangles.empty();
  if (is_points && arguments.is_tight)
    throw UsageError("--tight is for models with faces, and " + arguments.model + " has points alone");
  if (!is_points && arguments.close_voxels) throw UsageError(kCloseIsForPoints);
  if (!common.quiet) {
    for (const std::string& note : file.notes)
      std::fprintf(stderr, "vpe: note: %s: %s\n", arguments.model.c_str(), note.c_str());
  }
  if (is_points)
    return run_points(
        {arguments.model, arguments.output, arguments.voxels, arguments.close_voxels.value_or(kCloseVoxels)},
        file, common);
  if (arguments.output.empty()) return describe(arguments, std::move(file), common);
  std::vector<objects::TexturePyramid> textures;
  for (objects::Texture& t : file.mesh.textures) textures.emplace_back(std::move(t));
  file.mesh.textures.clear();
  const objects::StickModel sticks = objects::build_sticks(objects::voxelise(
      file.mesh, textures, {.voxels_longest = arguments.voxels, .is_tight = arguments.is_tight}));
  objects::write_stick_file(arguments.output, sticks);
  print_written_sticks(arguments.output, sticks, common);
}

}  // namespace

void add_object(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<ObjectArguments>();
  CLI::App* command =
      add_command(program, "object",
                  "Describe a model of an object, or make a model of sticks (voxels) from it", common, true);
  command
      ->add_option(
          "MODEL", arguments->model,
          "Model: .glb, .gltf, .obj, .ply (faces, or points alone), .stl, .sticks, or a volume: .volume, "
          ".vdb (OpenVDB)")
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
  command
      ->add_option("--close", arguments->close_voxels,
                   "Close gaps between points of a cloud that are up to twice so many voxels wide")
      ->check(CLI::Range(0, objects::kMostCloseVoxels))
      ->default_str(std::to_string(kCloseVoxels));
  command->add_option("--colour", arguments->colour, "Colour of a volume in full light, rrggbb");
  command->add_option("--density", arguments->density, "Factor on the extinction of a volume")
      ->check(number_within(1e-9, 1e9))
      ->capture_default_str();
  command
      ->add_option(
          "--levels", arguments->levels_m,
          "MODEL is a raster with a band for each level of a volume, from the lowest up; its values, 1/m, are so "
          "many metres apart each way")
      ->check(number_within(1e-4, 1e6));
  add_examples(
      *command,
      {{"what a model holds, and how far it can be simplified", "vpe object rover.glb"},
       {"a model of sticks of it", "vpe object rover.glb -o rover.sticks --voxels 512"},
       {"a model of sticks of a point cloud (PLY without faces)",
        "vpe object cloud.ply -o rock.sticks --voxels 512 --close 2"},
       {"a drawing in millimetres", "vpe object part.stl --unit 0.001 -o part.sticks"},
       {"a volume of OpenVDB", "vpe object smoke.vdb --density 0.2 --colour c8a078 -o smoke.volume"},
       {"a volume of a raster with a band for each level", "vpe object cube.vrt --levels 0.5 -o cave.volume"}});
  command->callback([arguments, &common] { run_object(*arguments, common); });
}

}  // namespace vpe::app
