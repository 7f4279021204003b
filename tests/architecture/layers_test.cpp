// The arrows between folders and between their rooms (docs/design/architecture.md), checked on the sources.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Layer {
  std::string folder;  // of the module, or of one of its rooms
  std::string name_space;
  std::vector<std::string>
      may_use;            // besides itself: rooms of the own module, and other modules with all their rooms
  bool may_draw = false;  // OpenGL, EGL, GLFW, OSMesa
  bool may_read_rasters = false;  // GDAL
  bool may_letter = false;        // Cairo
  bool may_fetch = false;         // libcurl, libcrypto
};

// Every module that a room of vpe/app may use.
const std::vector<std::string> kBelowApp{
    "vpe/base",   "mars",       "vpe/core",    "cull",         "lod",       "objects",  "relief",
    "paging",     "scripts",    "vpe/overlay", "vpe/gl",       "vpe/voxel", "panorama", "vpe/explore",
    "vpe/report", "vpe/window", "vpe/warp",    "vpe/overlook", "vpe/map"};

std::vector<std::string> below_app(std::vector<std::string> rooms) {
  rooms.insert(rooms.end(), kBelowApp.begin(), kBelowApp.end());
  return rooms;
}

const std::vector<Layer>& layers() {
  static const std::vector<Layer> kLayers{
      {"vpe/base", "vpe::base", {}},
      {"mars/geodesy", "mars", {"vpe/base"}, false, true},
      {"mars/sources", "mars", {"vpe/base", "mars/geodesy"}, false, true},
      {"mars/remote", "mars", {"vpe/base"}, false, true},
      {"mars/raster/gdal", "mars", {"vpe/base", "mars/sources"}, false, true},
      {"mars/raster/placement",
       "mars",
       {"vpe/base", "mars/geodesy", "mars/sources", "mars/raster/gdal"},
       false,
       true},
      {"mars/raster",
       "mars",
       {"vpe/base", "mars/geodesy", "mars/sources", "mars/remote", "mars/raster/gdal", "mars/raster/placement"},
       false,
       true},
      {"mars/raster/elevation",
       "mars",
       {"vpe/base", "mars/geodesy", "mars/sources", "mars/remote", "mars/raster/gdal", "mars/raster/placement",
        "mars/raster"},
       false,
       true},
      {"mars/raster/output",
       "mars",
       {"vpe/base", "mars/geodesy", "mars/sources", "mars/raster/gdal", "mars/raster"},
       false,
       true},
      {"mars/vector",
       "mars",
       {"vpe/base", "mars/geodesy", "mars/sources", "mars/raster/gdal", "mars/raster/placement", "mars/raster"},
       false,
       true},
      {"mars/embedded",
       "mars",
       {"vpe/base", "mars/geodesy", "mars/sources", "mars/raster", "mars/raster/elevation"}},
      {"vpe/core/registry", "vpe::core", {"vpe/base", "mars"}},
      {"vpe/core/appearance", "vpe::core", {"vpe/base", "mars", "vpe/core/registry"}},
      {"vpe/core/image", "vpe::core", {"vpe/base", "mars"}},
      {"vpe/core",
       "vpe::core",
       {"vpe/base", "mars", "vpe/core/registry", "vpe/core/appearance", "vpe/core/image"}},
      {"cull", "cull", {"vpe/base", "mars", "vpe/core"}},
      {"lod/tree", "lod", {"vpe/base", "mars", "vpe/core", "cull"}},
      {"lod/mesh", "lod", {"vpe/base", "mars", "vpe/core", "cull", "lod/tree"}},
      {"lod", "lod", {"vpe/base", "mars", "vpe/core", "cull", "lod/tree", "lod/mesh"}},
      {"relief", "relief", {"vpe/base", "mars", "vpe/core"}},
      {"relief/field", "relief", {"vpe/base", "mars", "vpe/core", "relief"}},
      {"relief/files", "relief", {"vpe/base", "mars", "vpe/core", "relief", "relief/field"}},
      {"relief/cast", "relief", {"vpe/base", "mars", "vpe/core", "relief", "relief/field"}},
      {"objects/model", "objects", {"vpe/base", "mars", "vpe/core", "cull", "lod"}},
      {"objects/volumes", "objects", {"vpe/base", "mars", "vpe/core", "objects/model"}},
      {"objects/files",
       "objects",
       {"vpe/base", "mars", "vpe/core", "cull", "lod", "objects/model", "objects/volumes"}},
      {"objects/sticks", "objects", {"vpe/base", "mars", "vpe/core", "objects/model", "objects/files"}},
      {"objects/points",
       "objects",
       {"vpe/base", "mars", "vpe/core", "objects/model", "objects/files", "objects/sticks"}},
      {"objects/scene",
       "objects",
       {"vpe/base", "mars", "vpe/core", "cull", "lod", "objects/model", "objects/volumes", "objects/files",
        "objects/sticks"}},
      {"objects/posters",
       "objects",
       {"vpe/base", "mars", "vpe/core", "objects/model", "objects/files", "objects/sticks", "objects/scene"}},
      {"objects/draw",
       "objects",
       {"vpe/base", "mars", "vpe/core", "cull", "lod", "objects/model", "objects/volumes", "objects/files",
        "objects/sticks", "objects/scene", "objects/posters"}},
      {"objects/levels", "objects", {"vpe/base", "mars", "vpe/core", "objects/model", "objects/files"}},
      {"objects/reader",
       "objects",
       {"vpe/base", "mars", "vpe/core", "objects/model", "objects/volumes", "objects/files"}},
      {"paging/planet", "paging", {"vpe/base", "mars", "vpe/core", "lod"}},
      {"paging/plan", "paging", {"vpe/base", "mars", "vpe/core", "lod", "paging/planet"}},
      {"paging/build", "paging", {"vpe/base", "mars", "vpe/core", "lod", "paging/planet", "paging/plan"}},
      {"paging/surface", "paging", {"vpe/base", "mars", "vpe/core", "lod", "paging/planet"}},
      {"paging/shading", "paging", {"vpe/base", "mars", "vpe/core", "lod", "paging/planet", "paging/surface"}},
      {"paging/live",
       "paging",
       {"vpe/base", "mars", "vpe/core", "lod", "relief", "paging/planet", "paging/plan", "paging/build",
        "paging/surface"}},
      {"paging", "paging", {"vpe/base"}},
      {"scripts", "scripts", {"vpe/base", "mars", "vpe/core", "relief"}},
      {"vpe/overlay", "vpe::overlay", {"vpe/base", "mars", "vpe/core"}, false, false, true},
      {"vpe/warp", "vpe::warp", {"vpe/base", "mars", "vpe/core"}},
      {"vpe/gl", "vpe::gl", {"vpe/base", "mars", "vpe/core", "cull", "lod", "paging", "scripts"}, true},
      {"vpe/voxel/columns", "vpe::voxel", {"vpe/base", "mars", "vpe/core", "lod", "paging"}},
      {"vpe/voxel/volume", "vpe::voxel", {"vpe/base", "mars", "vpe/core", "vpe/voxel/columns"}},
      {"vpe/voxel/cast",
       "vpe::voxel",
       {"vpe/base", "mars", "vpe/core", "lod", "paging", "vpe/voxel/columns", "vpe/voxel/volume"}},
      {"vpe/voxel/paint",
       "vpe::voxel",
       {"vpe/base", "mars", "vpe/core", "lod", "paging", "vpe/voxel/columns", "vpe/voxel/cast"}},
      {"vpe/voxel/smooth",
       "vpe::voxel",
       {"vpe/base", "mars", "vpe/core", "lod", "paging", "vpe/voxel/columns", "vpe/voxel/cast",
        "vpe/voxel/paint"}},
      {"vpe/voxel",
       "vpe::voxel",
       {"vpe/base", "mars", "vpe/core", "lod", "paging", "vpe/voxel/columns", "vpe/voxel/cast",
        "vpe/voxel/paint", "vpe/voxel/smooth", "vpe/voxel/volume"}},
      {"panorama/image", "panorama", {"vpe/base", "mars", "vpe/core", "paging"}},
      {"panorama", "panorama", {"vpe/base", "mars", "vpe/core", "paging", "panorama/image"}},
      {"panorama/metadata", "panorama", {"vpe/base", "mars", "vpe/core", "panorama/image", "panorama"}},
      {"panorama/viewer",
       "panorama",
       {"vpe/base", "mars", "vpe/core", "panorama/image", "panorama", "panorama/metadata"}},
      {"panorama/page",
       "panorama",
       {"vpe/base", "mars", "vpe/core", "panorama/image", "panorama", "panorama/metadata", "panorama/viewer"}},
      {"panorama/horizon",
       "panorama",
       {"vpe/base", "mars", "vpe/core", "paging", "panorama/image", "panorama"}},
      {"panorama/match", "panorama", {"vpe/base", "mars", "vpe/core", "panorama/image", "panorama"}},
      {"vpe/explore/images", "vpe::explore", {"vpe/core", "lod"}},
      {"vpe/explore/input", "vpe::explore", {"vpe/base", "mars", "vpe/core"}},
      {"vpe/explore/files",
       "vpe::explore",
       {"vpe/base", "mars", "vpe/core", "scripts", "panorama", "vpe/explore/input"}},
      {"vpe/explore/measure",
       "vpe::explore",
       {"vpe/base", "mars", "vpe/core", "lod", "paging", "scripts", "vpe/explore/files"}},
      {"vpe/explore/drawing",
       "vpe::explore",
       {"vpe/base", "mars", "vpe/core", "lod", "paging", "scripts", "vpe/explore/files",
        "vpe/explore/measure"}},
      {"vpe/explore/screens", "vpe::explore", {"vpe/base", "mars", "vpe/core", "vpe/explore/input"}},
      {"vpe/explore/results",
       "vpe::explore",
       {"vpe/base", "mars", "vpe/core", "paging", "vpe/explore/measure", "vpe/explore/drawing"}},
      {"vpe/explore",
       "vpe::explore",
       {"vpe/base", "mars", "vpe/core", "lod", "paging", "scripts", "panorama", "vpe/explore/input",
        "vpe/explore/files", "vpe/explore/measure", "vpe/explore/drawing"}},
      {"vpe/explore/places", "vpe::explore", {"vpe/base", "mars", "vpe/core", "vpe/explore"}},
      {"vpe/explore/traverse",
       "vpe::explore",
       {"vpe/base", "mars", "vpe/core", "scripts", "vpe/explore/input", "vpe/explore"}},
      {"vpe/explore/objects",
       "vpe::explore",
       {"vpe/base", "mars", "vpe/core", "objects", "vpe/explore/files", "vpe/explore/drawing", "vpe/explore"}},
      {"vpe/explore/layers",
       "vpe::explore",
       {"vpe/base", "mars", "vpe/core", "vpe/explore/measure", "vpe/explore"}},
      {"vpe/explore/reliefs",
       "vpe::explore",
       {"vpe/base", "mars", "vpe/core", "relief", "relief/files", "scripts", "vpe/explore/files",
        "vpe/explore/drawing", "vpe/explore"}},
      {"vpe/report/plots", "vpe::report", {"vpe/base"}},
      {"vpe/report", "vpe::report", {"vpe/base", "mars", "vpe/core", "vpe/report/plots"}},
      {"vpe/map", "vpe::map", {"vpe/base", "mars", "lod", "paging"}},
      {"vpe/map/viewshed", "vpe::map", {"vpe/base", "vpe/map"}},
      {"vpe/map/contour", "vpe::map", {"vpe/base", "vpe/map"}},
      {"vpe/map/route", "vpe::map", {"vpe/base", "vpe/map"}},
      {"vpe/window/workers",
       "vpe::window",
       {"vpe/base", "mars", "vpe/core", "paging", "relief", "scripts", "vpe/overlay", "vpe/explore",
        "vpe/warp"}},
      {"vpe/window/ui", "vpe::window", {"vpe/base", "vpe/core"}, true},
      {"vpe/window/marks",
       "vpe::window",
       {"vpe/base", "mars", "vpe/core", "paging", "scripts", "vpe/explore", "vpe/window/ui"}},
      {"vpe/window/menu",
       "vpe::window",
       {"vpe/base", "mars", "vpe/core", "paging", "vpe/explore", "vpe/window/ui"},
       true},
      {"vpe/window/panels",
       "vpe::window",
       {"vpe/base", "mars", "vpe/core", "lod", "paging", "scripts", "vpe/explore", "vpe/window/ui",
        "vpe/window/workers", "vpe/window/marks", "vpe/window/menu"},
       true},
      {"vpe/window/objects",
       "vpe::window",
       {"vpe/base", "mars", "vpe/core", "objects", "paging", "vpe/explore", "vpe/window/ui",
        "vpe/window/workers", "vpe/window/marks", "vpe/window/panels"},
       true},
      {"vpe/window/layers",
       "vpe::window",
       {"vpe/base", "mars", "vpe/core", "vpe/overlay", "vpe/explore", "vpe/window/ui", "vpe/window/marks",
        "vpe/window/menu", "vpe/window/panels"},
       true},
      {"vpe/window/reliefs",
       "vpe::window",
       {"vpe/base", "mars", "vpe/core", "paging", "relief", "relief/files", "scripts", "vpe/explore",
        "vpe/window/ui", "vpe/window/marks", "vpe/window/panels"},
       true},
      {"vpe/window/screens",
       "vpe::window",
       {"vpe/base", "mars", "vpe/core", "lod", "vpe/explore", "vpe/window/ui", "vpe/window/workers"},
       true},
      {"vpe/window",
       "vpe::window",
       {"vpe/base",
        "mars",
        "vpe/core",
        "lod",
        "objects",
        "paging",
        "relief",
        "relief/files",
        "scripts",
        "vpe/overlay",
        "panorama",
        "vpe/explore",
        "vpe/warp",
        "vpe/window/workers",
        "vpe/window/marks",
        "vpe/window/ui",
        "vpe/window/menu",
        "vpe/window/panels",
        "vpe/window/objects",
        "vpe/window/reliefs",
        "vpe/window/layers",
        "vpe/window/screens"},
       true},
      {"vpe/overlook", "vpe::overlook", {"vpe/base", "mars", "vpe/core", "panorama", "vpe/gl"}, true},
      {"vpe/app/cli", "vpe::app", kBelowApp, true},
      {"vpe/app/get", "vpe::app", below_app({"vpe/app/cli"}), false, false, false, true},
      {"vpe/app/planet", "vpe::app", below_app({"vpe/app/cli"}), true},
      {"vpe/app/places", "vpe::app", below_app({"vpe/app/cli", "vpe/app/planet"})},
      {"vpe/app/planet/info", "vpe::app", below_app({"vpe/app/cli", "vpe/app/planet"})},
      {"vpe/app/map", "vpe::app", below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/places"})},
      {"vpe/app/contour", "vpe::app", below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/map"})},
      {"vpe/app/route", "vpe::app",
       below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/places", "vpe/app/contour"})},
      {"vpe/app/viewshed", "vpe::app",
       below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/places", "vpe/app/map"})},
      {"vpe/app/measure", "vpe::app", below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/places"})},
      {"vpe/app/sun", "vpe::app", below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/places"})},
      {"vpe/app/visibility", "vpe::app", below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/places"})},
      {"vpe/app/scene", "vpe::app", below_app({"vpe/app/cli", "vpe/app/planet"})},
      {"vpe/app/picture", "vpe::app",
       below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/places", "vpe/app/scene"}), true},
      {"vpe/app/match", "vpe::app",
       below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/places", "vpe/app/picture"})},
      {"vpe/app/film", "vpe::app", below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/picture"}), true},
      {"vpe/app/panorama", "vpe::app",
       below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/places", "vpe/app/scene", "vpe/app/picture"}),
       true},
      {"vpe/app/surface", "vpe::app", below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/picture"})},
      {"vpe/app/report/papers", "vpe::app",
       below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/picture", "vpe/app/panorama"})},
      {"vpe/app/report", "vpe::app",
       below_app({"vpe/app/cli", "vpe/app/planet", "vpe/app/picture", "vpe/app/film", "vpe/app/panorama",
                  "vpe/app/report/papers"}),
       true},
      {"vpe/app", "vpe::app",
       below_app({"vpe/app/cli",         "vpe/app/get",     "vpe/app/planet",  "vpe/app/places",
                  "vpe/app/planet/info", "vpe/app/measure", "vpe/app/match",   "vpe/app/sun",
                  "vpe/app/visibility",  "vpe/app/map",     "vpe/app/contour", "vpe/app/route",
                  "vpe/app/viewshed",    "vpe/app/scene",   "vpe/app/picture", "vpe/app/film",
                  "vpe/app/panorama",    "vpe/app/surface", "vpe/app/report",  "vpe/app/report/papers"}),
       true},
      {"tests", "", below_app({"vpe/app"}), true, true},
  };
  return kLayers;
}

// The module of a folder: all folders of one namespace.
bool is_same_module(const Layer& a, const Layer& b) { return a.name_space == b.name_space; }

bool may_use(const Layer& layer, const Layer& used) {
  if (&layer == &used) return true;
  return std::any_of(layer.may_use.begin(), layer.may_use.end(), [&](const std::string& allowed) {
    return used.folder == allowed || (!is_same_module(layer, used) && used.folder.starts_with(allowed + "/"));
  });
}

// The row whose folder holds the path: the longest one, as rooms lie in the folders of their modules.
const Layer* layer_of(std::string_view path) {
  const Layer* found = nullptr;
  for (const Layer& layer : layers()) {
    const bool holds = path.starts_with(layer.folder + "/");
    if (holds && (found == nullptr || layer.folder.size() > found->folder.size())) found = &layer;
  }
  return found;
}

bool is_drawing_header(const std::string& name) {
  static const std::regex kPattern(
      R"((GL|GLES\d?|EGL|KHR|GLFW|OpenGL|GLUT)/.*|epoxy/.*|glad.*|glew.*|osmesa.*)", std::regex::icase);
  return std::regex_match(name, kPattern);
}

bool is_raster_header(const std::string& name) {
  static const std::regex kPattern(R"((gdal/)?(gdal|ogr|cpl_|vrtdataset|rawdataset)[^/]*\.h)");
  return std::regex_match(name, kPattern);
}

bool is_lettering_header(const std::string& name) {
  static const std::regex kPattern(R"((cairo|pango)[^/]*(/.*)?\.h)");
  return std::regex_match(name, kPattern);
}

bool is_fetching_header(const std::string& name) {
  return name.starts_with("curl/") || name.starts_with("openssl/");
}

bool is_source(const fs::path& path) {
  static const std::vector<std::string> kExtensions{".h", ".hpp", ".hh", ".c", ".cc", ".cpp", ".cxx", ".inl"};
  return std::find(kExtensions.begin(), kExtensions.end(), path.extension().string()) != kExtensions.end();
}

// What is wrong with one include, empty when nothing is.
std::string include_problem(const Layer& layer, const std::string& name, bool quoted) {
  if (is_drawing_header(name) && !layer.may_draw)
    return "only vpe/gl, vpe/window and vpe/app may include " + name;
  if (is_raster_header(name) && !layer.may_read_rasters) return "only mars may include " + name;
  if (is_lettering_header(name) && !layer.may_letter) return "only vpe/overlay may include " + name;
  if (is_fetching_header(name) && !layer.may_fetch) return "only vpe/app/get may include " + name;
  if (name.starts_with("assimp/") && layer.folder != "objects/reader")
    return "only objects/reader may include " + name;
  if (name.starts_with("openvdb/") && layer.folder != "objects/reader" && !layer.folder.starts_with("tests"))
    return "only objects/reader and tests may include " + name;
  if (!quoted) return "";
  const Layer* used = layer_of(name);
  if (used == nullptr) return "\"" + name + "\" is not given from the root of the repository";
  return may_use(layer, *used) ? "" : layer.folder + " must not use " + used->folder + " (" + name + ")";
}

// Everything wrong with one source, each as "path:line: what".
std::vector<std::string> check_source(const std::string& path, const std::string& text) {
  std::vector<std::string> problems;
  const auto report = [&](int line, const std::string& what) {
    problems.push_back(path + ":" + std::to_string(line) + ": " + what);
  };
  const Layer* layer = layer_of(path);
  if (layer == nullptr) {
    report(1, "no folder of the table in tests/architecture/layers_test.cpp holds this source");
    return problems;
  }
  static const std::regex kName(R"((.*/)?[a-z][a-z0-9_]*(-inl\.h|\.h|\.cpp))");
  if (!std::regex_match(path, kName)) report(1, "names are lower_case.h, lower_case-inl.h or lower_case.cpp");
  // Headers of Highway's kernels are read once for each instruction set.
  if (path.ends_with("-inl.h")) {
    if (text.find(" == defined(HWY_TARGET_TOGGLE)\n") == std::string::npos)
      report(1, "a header -inl.h needs a guard with HWY_TARGET_TOGGLE");
  } else if (path.ends_with(".h") && text.find("\n#pragma once\n") == std::string::npos &&
             !text.starts_with("#pragma once\n")) {
    report(1, "a header needs #pragma once");
  }
  // A header of nothing but includes and macros needs no namespace.
  const bool declares = path.ends_with(".cpp") || text.find("\nnamespace ") != std::string::npos;
  if (declares && !layer->name_space.empty() && !path.ends_with("/main.cpp") &&
      text.find("namespace " + layer->name_space) == std::string::npos) {
    report(1, "nothing in namespace " + layer->name_space);
  }
  static const std::regex kInclude(R"(\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::smatch match;
    if (line.find("include") == std::string::npos || !std::regex_match(line, match, kInclude)) continue;
    const std::string problem = include_problem(*layer, match[2], match[1] == "\"");
    if (!problem.empty()) report(number, problem);
  }
  return problems;
}

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Sources of the tree, relative to its root; hidden folders, build folders and cmake/ left out.
std::vector<fs::path> all_sources(const fs::path& root) {
  std::vector<fs::path> sources;
  for (auto entry = fs::recursive_directory_iterator(root); entry != fs::end(entry); ++entry) {
    const std::string name = entry->path().filename().string();
    const bool is_tooling = entry.depth() == 0 && (name.starts_with("build") || name == "cmake");
    if (entry->is_directory() && (name.starts_with(".") || is_tooling)) {
      entry.disable_recursion_pending();
    } else if (entry->is_regular_file() && is_source(entry->path())) {
      sources.push_back(fs::relative(entry->path(), root));
    }
  }
  std::sort(sources.begin(), sources.end());
  return sources;
}

TEST(Layers, EverySourceKeepsToItsRow) {
  const fs::path root = VPE_SOURCE_DIR;
  const std::vector<fs::path> sources = all_sources(root);
  ASSERT_GT(sources.size(), 20U);
  for (const fs::path& source : sources) {
    for (const std::string& problem : check_source(source.generic_string(), read(root / source))) {
      ADD_FAILURE() << problem;
    }
  }
}

TEST(Layers, EveryQuotedIncludeExists) {
  const fs::path root = VPE_SOURCE_DIR;
  static const std::regex kQuoted("(?:^|\\n)#include \"([^\"]+)\"");
  for (const fs::path& source : all_sources(root)) {
    const std::string text = read(root / source);
    for (auto match = std::sregex_iterator(text.begin(), text.end(), kQuoted); match != std::sregex_iterator();
         ++match) {
      EXPECT_TRUE(fs::exists(root / (*match)[1].str())) << source << " includes " << (*match)[1];
    }
  }
}

TEST(Layers, ArrowsHaveNoCycle) {
  // The table is in the order of the arrows: each row uses only rows above it.
  for (std::size_t n = 0; n < layers().size(); ++n) {
    for (const std::string& used : layers()[n].may_use) {
      const auto end = layers().begin() + static_cast<std::ptrdiff_t>(n);
      const bool is_above = std::any_of(layers().begin(), end, [&used](const Layer& layer) {
        return layer.folder == used || layer.folder.starts_with(used + "/");
      });
      EXPECT_TRUE(is_above) << layers()[n].folder << " uses " << used;
      const bool is_below = std::any_of(end, layers().end(), [&](const Layer& layer) {
        return layer.folder == used ||
               (layer.folder.starts_with(used + "/") && !is_same_module(layer, layers()[n]));
      });
      EXPECT_FALSE(is_below) << layers()[n].folder << " uses " << used;
    }
  }
}

TEST(Layers, NoRoomIsAHall) {
  constexpr std::size_t kMostSources = 40;
  const fs::path root = VPE_SOURCE_DIR;
  std::map<fs::path, std::size_t> sources;
  for (const fs::path& source : all_sources(root)) ++sources[source.parent_path()];
  for (const auto& [folder, count] : sources) EXPECT_LE(count, kMostSources) << folder;
}

// What the checker says about a made-up source, joined.
std::string verdict(const std::string& path, const std::string& body) {
  std::string all;
  for (const std::string& problem : check_source(path, body)) all += problem + "\n";
  return all;
}

TEST(LayersSelfTest, FabricatedViolationsAreCaught) {
  const std::string lod = "namespace lod {}\n";
  EXPECT_EQ(verdict("lod/a.cpp", "#include \"cull/frustum.h\"\n#include <vector>\n" + lod), "");
  EXPECT_EQ(verdict("lod/a.cpp", "\n#include \"paging/planet/planet_file.h\"\n" + lod),
            "lod/a.cpp:2: lod must not use paging/planet (paging/planet/planet_file.h)\n");
  EXPECT_EQ(
      verdict("lod/mesh/a.cpp", "#include \"lod/tree/posts.h\"\n#include \"mars/geodesy/cube.h\"\n" + lod), "");
  EXPECT_NE(verdict("lod/tree/a.cpp", "#include \"lod/mesh/mesh.h\"\n" + lod), "");
  const std::string app = "namespace vpe::app {}\n";
  EXPECT_EQ(verdict("vpe/app/film/a.cpp", "#include \"vpe/app/cli/program.h\"\n" + app), "");
  EXPECT_NE(verdict("vpe/app/cli/a.cpp", "#include \"vpe/app/film/video.h\"\n" + app), "");
  EXPECT_NE(verdict("vpe/app/picture/a.cpp", "#include \"vpe/app/panorama/commands.h\"\n" + app), "");
  EXPECT_NE(verdict("vpe/app/panorama/a.cpp", "#include \"vpe/app/commands.h\"\n" + app), "");
  EXPECT_NE(verdict("mars/sources/a.cpp", "  #  include \"vpe/core/view.h\"\nnamespace mars {}"), "");
  EXPECT_NE(verdict("objects/files/a.cpp", "#include <assimp/scene.h>\nnamespace objects {}"), "");
  EXPECT_NE(verdict("objects/volumes/a.cpp", "#include <openvdb/openvdb.h>\nnamespace objects {}"), "");
  EXPECT_NE(verdict("lod/a.cpp", "#include \"posts.h\"\n" + lod), "");
  EXPECT_NE(verdict("lod/a.cpp", "#include \"../mars/cube.h\"\n" + lod), "");
  EXPECT_NE(verdict("lod/a.cpp", "#include <paging/../GL/gl.h>\n#include <GL/gl.h>\n" + lod), "");
  for (const char* header :
       {"GL/gl.h", "EGL/egl.h", "GLFW/glfw3.h", "GL/osmesa.h", "GL/glcorearb.h", "epoxy/gl.h"}) {
    const std::string line = std::string("#include <") + header + ">\n";
    EXPECT_NE(verdict("vpe/core/a.cpp", line + "namespace vpe::core {}"), "") << header;
    EXPECT_EQ(verdict("vpe/gl/a.cpp", line + "namespace vpe::gl {}"), "") << header;
    EXPECT_EQ(verdict("vpe/app/a.cpp", line + "namespace vpe::app {}"), "") << header;
  }
  for (const char* header : {"gdal_priv.h", "gdal.h", "ogr_spatialref.h", "cpl_conv.h", "gdal/gdal.h"}) {
    const std::string line = std::string("#include <") + header + ">\n";
    EXPECT_NE(verdict("paging/a.cpp", line + "namespace paging {}"), "") << header;
    EXPECT_EQ(verdict("mars/raster/a.cpp", line + "namespace mars {}"), "") << header;
    EXPECT_EQ(verdict("tests/mars/a.cpp", line), "") << header;
  }
  EXPECT_EQ(verdict("vpe/overlay/a.cpp", "#include <cairo.h>\nnamespace vpe::overlay {}"), "");
  EXPECT_NE(verdict("vpe/app/a.cpp", "#include <cairo.h>\nnamespace vpe::app {}"), "");
  EXPECT_NE(verdict("vpe/core/a.cpp", "#include <cairo/cairo-ft.h>\nnamespace vpe::core {}"), "");
  EXPECT_EQ(verdict("vpe/app/get/a.cpp", "#include <curl/curl.h>\n#include <openssl/evp.h>\n" + app), "");
  EXPECT_NE(verdict("vpe/app/cli/a.cpp", "#include <curl/curl.h>\n" + app), "");
  EXPECT_NE(verdict("vpe/app/a.cpp", "#include <openssl/evp.h>\n" + app), "");
  EXPECT_NE(verdict("lod/a.h", lod), "");
  EXPECT_EQ(verdict("lod/a.h", "// What it is.\n#pragma once\n" + lod), "");
  EXPECT_NE(verdict("lod/a.cpp", "namespace mars {}\n"), "");
  EXPECT_NE(verdict("lod/a.h", "#pragma once\n\nnamespace mars {}\n"), "");
  EXPECT_EQ(verdict("lod/a.h", "#pragma once\n#include <vector>\n"), "");
  const std::string guard = "#if defined(LOD_A) == defined(HWY_TARGET_TOGGLE)\n#endif\n";
  EXPECT_EQ(verdict("lod/a-inl.h", guard + lod), "");
  EXPECT_NE(verdict("lod/a-inl.h", "#pragma once\n" + lod), "");
  EXPECT_NE(verdict("lod/a-b.h", "#pragma once\n" + lod), "");
  EXPECT_NE(verdict("lod/CamelCase.cpp", lod), "");
  EXPECT_NE(verdict("lod/a.cc", lod), "");
  EXPECT_NE(verdict("util/a.cpp", "namespace util {}\n"), "");
}

}  // namespace
