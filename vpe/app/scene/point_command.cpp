#include "vpe/app/scene/point_command.h"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "objects/points/voxelise_points.h"
#include "objects/sticks/build_sticks.h"
#include "objects/sticks/stick_file.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/scene/model_figures.h"
#include "vpe/base/file.h"

namespace vpe::app {

namespace {

void describe_points(const objects::ModelFile& file, const Common& common) {
  const objects::Mesh& points = file.mesh;
  const Extent extent = extent_of(points);
  if (common.json) {
    print_json({{"points", points.positions_m.size()},
                {"coloured", !points.colours.empty()},
                {"normals", !points.normals.empty()},
                {"low_m", vector_json(extent.low_m)},
                {"high_m", vector_json(extent.high_m)},
                {"notes", file.notes}});
    return;
  }
  std::printf("%zu points, %s colours, %s normals\n", points.positions_m.size(),
              points.colours.empty() ? "without" : "with", points.normals.empty() ? "without" : "with");
  std::printf("%s; the ground is %s above its foot\n", extent_text(extent).c_str(),
              length_text(-extent.low_m.z, 3).c_str());
}

objects::StickModel sticks_of_points(const PointArguments& arguments, const objects::Mesh& points) {
  try {
    return objects::build_sticks(objects::voxelise_points(
        points, {.voxels_longest = arguments.voxels, .close_voxels = arguments.close_voxels}));
  } catch (const std::invalid_argument& error) {
    throw base::file_error("make sticks of", arguments.model, error.what(),
                           "use other points, or fewer voxels (--voxels)");
  }
}

}  // namespace

void run_points(const PointArguments& arguments, const objects::ModelFile& file, const Common& common) {
  if (arguments.output.empty()) return describe_points(file, common);
  const objects::StickModel sticks = sticks_of_points(arguments, file.mesh);
  objects::write_stick_file(arguments.output, sticks);
  print_written_sticks(arguments.output, sticks, common);
}

}  // namespace vpe::app
