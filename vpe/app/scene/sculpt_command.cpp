#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>

#include "objects/sticks/build_sticks.h"
#include "objects/sticks/sculpt.h"
#include "objects/sticks/stick_file.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/scene/commands.h"
#include "vpe/app/scene/rgb_argument.h"
#include "vpe/base/number.h"
#include "vpe/core/image/image.h"

namespace vpe::app {

namespace {

using objects::SculptSide;

struct SculptArguments {
  std::vector<std::string> photographs;  // from the right, from the front, from above
  std::string back;
  std::string left;
  std::string bottom;
  std::string size;
  std::string background = "corner";
  int tolerance = 24;
  std::vector<std::string> contours;
  int voxels = 256;
  std::string output;
};

struct Photograph {
  std::string file;
  SculptSide side;
};

std::vector<Photograph> photographs_of(const SculptArguments& a) {
  std::vector<Photograph> all;
  constexpr std::array<SculptSide, 3> kInOrder{SculptSide::kRight, SculptSide::kFront, SculptSide::kTop};
  for (std::size_t n = 0; n < a.photographs.size(); ++n) all.push_back({a.photographs[n], kInOrder.at(n)});
  if (!a.back.empty()) all.push_back({a.back, SculptSide::kBack});
  if (!a.left.empty()) all.push_back({a.left, SculptSide::kLeft});
  if (!a.bottom.empty()) all.push_back({a.bottom, SculptSide::kBottom});
  return all;
}

objects::PhotoMask mask_of(const SculptArguments& a, const core::RgbImage& image, std::size_t n) {
  if (n < a.contours.size())
    return objects::mask_by_contour(objects::read_contour_file(a.contours[n]), image.width, image.height);
  const base::Rgb colour = a.background == "corner" ? image.pixels.front() : *parse_rgb(a.background);
  return objects::mask_by_background(image, colour, a.tolerance);
}

void run_sculpt(const SculptArguments& a, const Common& common) {
  const auto size = parse_numbers(a.size);
  if (!size || size->size() != 3)
    throw UsageError("--size '" + a.size + "': expected LENGTH,WIDTH,HEIGHT in metres, as 6.9,3.4,2.4");
  if (a.background != "corner" && !parse_rgb(a.background))
    throw UsageError(
        "--background '" + a.background +
        "': expected a colour such as d0c8c0, or corner, that of each photograph's upper left pixel");
  const std::vector<Photograph> photographs = photographs_of(a);
  if (!a.contours.empty() && a.contours.size() != photographs.size())
    throw UsageError("--contour was given " + std::to_string(a.contours.size()) + " times for " +
                     std::to_string(photographs.size()) + " photographs; give one for each, in their order");
  std::vector<std::filesystem::path> inputs(a.contours.begin(), a.contours.end());
  for (const Photograph& p : photographs) inputs.emplace_back(p.file);
  check_outputs({{"-o", a.output, FileKind::kSticks}}, inputs);
  std::vector<objects::SculptView> views;
  for (std::size_t n = 0; n < photographs.size(); ++n) {
    core::RgbImage image = core::read_image(photographs[n].file);
    objects::PhotoMask mask = mask_of(a, image, n);
    views.push_back({std::move(image), std::move(mask), photographs[n].side});
  }
  const objects::StickModel sticks = objects::build_sticks(
      objects::sculpt(views, {.size_m = {(*size)[1], (*size)[0], (*size)[2]}, .voxels_longest = a.voxels}));
  objects::write_stick_file(a.output, sticks);
  const objects::StickModel::Level& finest = sticks.levels().front();
  if (common.json) {
    print_json({{"output", a.output},
                {"columns", {finest.grid.columns_x, finest.grid.columns_y}},
                {"height", finest.grid.height},
                {"voxel_m", finest.grid.voxel_m},
                {"sticks", finest.sticks.size()},
                {"coloured_voxels", finest.voxels.size()}});
  } else if (!common.quiet) {
    std::printf("%s: %d x %d columns of %d voxels, %zu different sticks, %zu coloured voxels\n",
                a.output.c_str(), finest.grid.columns_x, finest.grid.columns_y, finest.grid.height,
                finest.sticks.size(), finest.voxels.size());
  }
}

}  // namespace

void add_sculpt(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<SculptArguments>();
  CLI::App* command = add_command(
      program, "sculpt", "Carve a model of sticks (voxels) from photographs of an object", common, true);
  command
      ->add_option(
          "PHOTOGRAPHS", arguments->photographs,
          "Photographs from the right side, from the front and from above, in this order; taken from far away")
      ->required()
      ->expected(1, 3);
  command->add_option("--back", arguments->back, "Photograph from behind");
  command->add_option("--left", arguments->left, "Photograph from the left side");
  command->add_option("--bottom", arguments->bottom, "Photograph from below");
  command->add_option("--size", arguments->size, "LENGTH,WIDTH,HEIGHT of the object, metres")->required();
  command
      ->add_option("--background", arguments->background,
                   "Colour of the background, rrggbb, or corner: that of each photograph's upper left pixel")
      ->capture_default_str();
  command
      ->add_option("--background-tolerance", arguments->tolerance,
                   "Largest difference of a channel, 0 to 255, from that colour")
      ->check(CLI::Range(0, 255))
      ->capture_default_str();
  command
      ->add_option(
          "--contour", arguments->contours,
          "File with the outline of the object in a photograph, a line x,y in pixels for each corner, in place "
          "of the background; one for each photograph, in their order (repeatable)")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--voxels", arguments->voxels, "Voxels along the longest side")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "Model of sticks to write (.sticks)")->required();
  add_examples(
      *command,
      {{"a tank from three photographs on a grey wall",
        "vpe sculpt side.png front.png top.png --size 6.9,3.4,2.4 --background d0c8c0 -o tank.sticks"},
       {"with the outlines of the tank in the photographs",
        "vpe sculpt side.png front.png top.png --size 6.9,3.4,2.4 --contour side.txt --contour front.txt "
        "--contour top.txt -o tank.sticks"}});
  command->callback([arguments, &common] { run_sculpt(*arguments, common); });
}

}  // namespace vpe::app
