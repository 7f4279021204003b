#include "vpe/app/scene/model_figures.h"

#include <cstdio>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

Extent extent_of(const objects::Mesh& mesh) {
  Extent e{glm::dvec3(mesh.positions_m.front()), glm::dvec3(mesh.positions_m.front())};
  for (const glm::vec3& p : mesh.positions_m) {
    e.low_m = glm::min(e.low_m, glm::dvec3(p));
    e.high_m = glm::max(e.high_m, glm::dvec3(p));
  }
  return e;
}

std::string extent_text(const Extent& extent) {
  const glm::dvec3 m = extent.high_m - extent.low_m;
  return length_text(m.x, 3) + " wide, " + length_text(m.y, 3) + " long, " + length_text(m.z, 3) + " high";
}

nlohmann::json vector_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

void print_sticks(const objects::StickModel& sticks, const Common& common) {
  const objects::StickModel::Level& finest = sticks.levels().front();
  if (common.json) {
    print_json({{"columns", {finest.grid.columns_x, finest.grid.columns_y}},
                {"height", finest.grid.height},
                {"voxel_m", finest.grid.voxel_m},
                {"sticks", finest.sticks.size()},
                {"runs", finest.runs.size()},
                {"coloured_voxels", finest.voxels.size()},
                {"levels", sticks.levels().size()}});
    return;
  }
  std::printf(
      "%d x %d columns of %d voxels of %s; %zu different sticks, %zu runs, %zu coloured voxels, %zu levels\n",
      finest.grid.columns_x, finest.grid.columns_y, finest.grid.height,
      length_text(static_cast<double>(finest.grid.voxel_m), 3).c_str(), finest.sticks.size(),
      finest.runs.size(), finest.voxels.size(), sticks.levels().size());
}

void print_written_sticks(const std::string& output, const objects::StickModel& sticks, const Common& common) {
  if (!common.json && common.quiet) return;
  if (!common.json) std::printf("%s: ", output.c_str());
  print_sticks(sticks, common);
}

}  // namespace vpe::app
