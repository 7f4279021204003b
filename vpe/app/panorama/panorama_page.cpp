#include "vpe/app/panorama/panorama_page.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "mars/geodesy/sphere.h"
#include "panorama/page/page_writer.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/file.h"
#include "vpe/explore/files/hotspots.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMostJsonBytes = std::uintmax_t{1} << 24;

// What the JSON of a panorama says beside its projection.
struct JsonOfPanorama {
  panorama::PageMarks marks;
  double radius_m = mars::kMarsRadius_m;
};

JsonOfPanorama read_json_of(const panorama::PanoramaDescription& description) {
  JsonOfPanorama found;
  for (const fs::path& path : {fs::path(description.image).replace_extension(".json"),
                               description.image.parent_path() / "pano.json"}) {
    if (description.sources.empty() || description.sources.front() != "'" + path.string() + "'") continue;
    const auto bytes = base::read_file(path, kMostJsonBytes);
    const std::string text(bytes.begin(), bytes.end());
    try {
      found.marks = panorama::read_page_marks(text);
    } catch (const panorama::MetadataError& e) {
      throw base::FileError("cannot read '" + path.string() + "': " + e.what());
    }
    const auto json = nlohmann::json::parse(text);
    if (const auto radius = json.find("radius_m"); radius != json.end() && radius->is_number())
      found.radius_m = radius->get<double>();
    break;
  }
  return found;
}

std::vector<explore::Hotspot> read_hotspots(const std::string& file) {
  const explore::ParsedHotspots parsed = explore::load_hotspots(file);
  std::string wrong;
  for (const auto& error : parsed.errors) wrong += (wrong.empty() ? "" : "\n     ") + scripts::to_string(error);
  if (!wrong.empty()) throw std::runtime_error(wrong);
  return parsed.hotspots;
}

// Adds the hotspots of a file that this panorama sees: pages beside this one, named after their panoramas.
void add_hotspots(const PageArguments& arguments, const panorama::PanoramaDescription& here, double radius_m,
                  bool is_quiet, panorama::PageMarks& marks) {
  if (arguments.hotspots.empty()) return;
  if (!here.viewpoint || !here.viewpoint->alt_m) {
    throw std::runtime_error(
        here.image.string() +
        ": its JSON does not state the altitude of the camera (pose, alt_m), so the directions of "
        "hotspots are not known; add it, or leave --html-hotspots out");
  }
  const fs::path folder = fs::absolute(fs::path(arguments.folder) / "").parent_path();
  for (const explore::Hotspot& hotspot : read_hotspots(arguments.hotspots)) {
    const panorama::PanoramaDescription there = panorama::describe(hotspot.panorama);
    std::error_code none;
    if (fs::equivalent(there.image, here.image, none)) continue;
    auto seen =
        there.viewpoint ? panorama::seen_from(*here.viewpoint, *there.viewpoint, radius_m) : std::nullopt;
    if (!seen) {
      if (!is_quiet) {
        std::fprintf(stderr,
                     "vpe: note: the hotspot '%s' is left out: '%s' does not state its camera's altitude\n",
                     hotspot.name.c_str(), there.image.c_str());
      }
      continue;
    }
    seen->text = hotspot.name;
    const fs::path page = folder.parent_path() / there.image.stem() / "index.html";
    if (!fs::exists(page, none) && !is_quiet) {
      std::fprintf(stderr, "vpe: note: the hotspot '%s' leads to '%s', which is not there yet\n",
                   hotspot.name.c_str(), page.c_str());
    }
    marks.hotspots.push_back({*std::move(seen), panorama::address_of(page, folder)});
  }
}

std::unique_ptr<panorama::TiledImage> open_image(const panorama::PanoramaDescription& description,
                                                 std::size_t budget_bytes, ProgressLine& line) {
  panorama::TiledImageOptions options;
  options.budget_bytes = budget_bytes;
  options.cache_folder = [] {
    const fs::path folder = cache_folder() / "pictures";
    make_folder(folder);
    return folder;
  };
  options.progress = [&](double fraction) {
    InterruptGuard::check();
    line.show("copying " + description.image.filename().string() + " once, in tiles", fraction);
  };
  return panorama::open_tiled_image(description.image, description.format, options);
}

// Returns where the right eye's image begins in the file of both.
panorama::ImageOrigin second_origin(const panorama::PanoramaDescription& description) {
  switch (description.pair) {
    case panorama::PairLayout::kSideBySide: return {description.map.width_px, 0};
    case panorama::PairLayout::kOverUnder: return {0, description.map.height_px};
    case panorama::PairLayout::kNone: break;
  }
  return {};
}

}  // namespace

void add_page_options(CLI::App& command, PageArguments& arguments) {
  CLI::Option* html =
      command.add_option("--html", arguments.folder,
                         "Folder of a web page to write, which any browser opens from disk (index.html)");
  command.add_option("--html-title", arguments.title, "Its title (default: the image's name)")->needs(html);
  command
      .add_option(
          "--html-hotspots", arguments.hotspots,
          "File of hotspots, as of 'vpe explore': links to pages of other panoramas, in folders beside this "
          "one that have the names of their images")
      ->needs(html);
  command
      .add_option("--html-tiles", arguments.tiles, "Format of its tiles: jpeg or png (without loss, larger)")
      ->check(CLI::IsMember({"jpeg", "png"}))
      ->capture_default_str()
      ->needs(html);
  command.add_option("--html-quality", arguments.quality, "Quality of JPEG tiles, 1 to 100")
      ->check(number_within(1, 100))
      ->capture_default_str()
      ->needs(html);
  command
      .add_option("--html-layers-step", arguments.layer_step,
                  "Read-outs for every N-th column and row only (default: as fine as 16 million values)")
      ->check(number_within(1, 4096))
      ->needs(html);
  command
      .add_flag("--html-without-image", arguments.without_image, "Leave out the copy of the image to download")
      ->needs(html);
  command
      .add_flag("--force", arguments.force, "Write the page also into a folder with other files, which stay")
      ->needs(html);
}

void check_page(const PageArguments& arguments) {
  if (arguments.folder.empty()) return;
  panorama::check_page_folder(arguments.folder, arguments.force);
  if (!arguments.hotspots.empty()) (void)read_hotspots(arguments.hotspots);
}

nlohmann::json write_page_of(const PageArguments& arguments, const PanoramaFiles& files,
                             std::vector<panorama::PageName> names, const Common& common) {
  const InterruptGuard guard;
  ProgressLine line(common.quiet);
  const auto left = panorama::describe(files.panorama, files.layout);
  const auto right =
      files.right.empty() ? std::nullopt : std::optional(panorama::describe(files.right, files.layout));
  if (right && panorama::largest_difference_px(left.map, right->map) > 1.0) {
    throw std::runtime_error("cannot write a page of '" + left.image.string() + "' and '" +
                             right->image.string() + "': their pixels show other directions");
  }
  // The rest of the memory is for tiles being made.
  const std::size_t budget_bytes = memory_bytes(common) / (right ? 4 : 2);
  const auto left_image = open_image(left, budget_bytes, line);
  const auto right_image = right ? open_image(*right, budget_bytes, line) : nullptr;
  JsonOfPanorama json = read_json_of(left);
  add_hotspots(arguments, left, json.radius_m, common.quiet, json.marks);
  json.marks.names.insert(json.marks.names.begin(), std::make_move_iterator(names.begin()),
                          std::make_move_iterator(names.end()));
  panorama::PageContent content{arguments.title, left, {*left_image, {}, left.map}, std::nullopt, json.marks};
  if (right) {
    content.right.emplace(panorama::PageImage{*right_image, {}, right->map});
  } else if (left.pair != panorama::PairLayout::kNone) {
    content.right.emplace(panorama::PageImage{*left_image, second_origin(left), left.map});
  }
  panorama::PageOptions options;
  options.tiles = arguments.tiles == "png" ? panorama::PageTileFormat::kPng : panorama::PageTileFormat::kJpeg;
  options.jpeg_quality = arguments.quality;
  options.layer_step = arguments.layer_step;
  options.with_image = !arguments.without_image;
  options.force = arguments.force;
  options.progress = [&](double fraction) {
    InterruptGuard::check();
    line.show("writing the page", fraction);
  };
  base::ThreadPool pool(common.threads);
  const panorama::PageReport report = panorama::write_page(arguments.folder, content, options, pool);
  return {{"folder", arguments.folder},
          {"tiles", report.tiles},
          {"levels", report.levels},
          {"layer_tiles", report.layer_tiles},
          {"layer_step", report.layer_step == 0 ? nlohmann::json() : nlohmann::json(report.layer_step)}};
}

}  // namespace vpe::app
