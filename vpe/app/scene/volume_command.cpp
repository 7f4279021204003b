#include "vpe/app/scene/volume_command.h"

#include <algorithm>
#include <cstdio>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "mars/raster/raster_levels.h"
#include "mars/sources/source.h"
#include "objects/files/volume_model_file.h"
#include "objects/volumes/volume_file.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/scene/rgb_argument.h"

namespace vpe::app {

namespace {

// Returns the volume of a raster with a band for each level, on the ground and about its origin.
objects::VolumeModel volume_of_levels(const VolumeArguments& arguments) {
  using Limits = objects::VolumeLimits;
  mars::RasterLevels cube =
      mars::read_raster_levels(arguments.model, {.side = Limits::kMostSide, .values = Limits::kMostPosts});
  const auto spacing_m = static_cast<float>(arguments.levels_m);
  objects::DenseVolume dense({{cube.width, cube.height, cube.levels},
                              spacing_m,
                              {-0.5F * spacing_m * static_cast<float>(cube.width - 1),
                               -0.5F * spacing_m * static_cast<float>(cube.height - 1), 0}});
  dense.values() = std::move(cube.values);
  const bool has_any = std::ranges::any_of(dense.values(), [](float v) { return v > 0; });
  if (!has_any)
    throw mars::SourceError(arguments.model +
                            ": no value is above 0; give a raster of extinctions, 1/m, and "
                            "--density for their unit");
  return {objects::build_level(dense), {200, 200, 200, 255}};
}

// Returns the volume with another colour and more or less extinction.
objects::VolumeModel changed(const objects::VolumeModel& volume, const VolumeArguments& arguments) {
  objects::VolumeLevel level = volume.levels().front();
  level.unit_per_m *= static_cast<float>(arguments.density);
  objects::Rgba colour = volume.colour();
  if (!arguments.colour.empty()) {
    const base::Rgb rgb = *parse_rgb(arguments.colour);
    colour = {rgb.r, rgb.g, rgb.b, 255};
  }
  return {std::move(level), colour};
}

void print_volume(const objects::VolumeModel& volume, const Common& common) {
  const objects::VolumeLevel& finest = volume.levels().front();
  const glm::vec3 size_m = volume.high_m() - volume.low_m();
  const objects::Rgba& colour = volume.colour();
  const double largest_per_m = 255 * static_cast<double>(finest.unit_per_m);
  const std::size_t bricks = finest.posts.size() / objects::VolumeLevel::kBrickPosts;
  if (common.json) {
    print_json({{"posts", finest.lattice.posts},
                {"spacing_m", finest.lattice.spacing_m},
                {"size_m", {size_m.x, size_m.y, size_m.z}},
                {"bricks", bricks},
                {"levels", volume.levels().size()},
                {"largest_extinction_per_m", largest_per_m},
                {"mean_opacity", volume.look().opacity},
                {"colour", {colour.r, colour.g, colour.b}}});
    return;
  }
  const auto text = [](float m) { return length_text(static_cast<double>(m), 3); };
  std::printf("%s wide, %s long, %s high; %d x %d x %d posts %s apart, %zu bricks, %zu levels\n",
              text(size_m.x).c_str(), text(size_m.y).c_str(), text(size_m.z).c_str(), finest.lattice.posts[0],
              finest.lattice.posts[1], finest.lattice.posts[2], text(finest.lattice.spacing_m).c_str(), bricks,
              volume.levels().size());
  std::printf("extinction up to %.3g a metre; it hides %.0f %% of what is behind it on average\n",
              largest_per_m, 100 * volume.look().opacity);
}

}  // namespace

void run_volume(const VolumeArguments& arguments, const Common& common) {
  if (!arguments.colour.empty() && !parse_rgb(arguments.colour))
    throw UsageError("--colour '" + arguments.colour + "': expected a colour such as d0c8c0");
  const objects::VolumeModel volume =
      changed(arguments.levels_m > 0 ? volume_of_levels(arguments)
                                     : objects::read_volume_model(arguments.model, arguments.options),
              arguments);
  if (arguments.output.empty()) return print_volume(volume, common);
  objects::write_volume_file(arguments.output, volume);
  if (common.json || !common.quiet) print_volume(volume, common);
}

}  // namespace vpe::app
