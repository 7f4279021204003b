// The arrows between folders (docs/architecture.md), checked on the sources themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Layer {
  std::string folder;
  std::string name_space;
  std::vector<std::string> may_use;  // besides itself
  bool may_draw = false;             // OpenGL, EGL, GLFW, OSMesa
  bool may_read_rasters = false;     // GDAL
  bool may_letter = false;           // Cairo
};

const std::vector<Layer>& layers() {
  static const std::vector<Layer> kLayers{
      {"mars", "mars", {}, false, true},
      {"vpe/core", "vpe::core", {"mars"}},
      {"cull", "cull", {"mars", "vpe/core"}},
      {"lod", "lod", {"mars", "vpe/core", "cull"}},
      {"paging", "paging", {"mars", "vpe/core", "lod"}},
      {"scripts", "scripts", {"mars", "vpe/core"}},
      {"vpe/overlay", "vpe::overlay", {"mars", "vpe/core"}, false, false, true},
      {"vpe/gl", "vpe::gl", {"mars", "vpe/core", "cull", "lod", "paging", "scripts"}, true},
      {"vpe/voxel", "vpe::voxel", {"mars", "vpe/core", "lod", "paging"}},
      {"panorama", "panorama", {"mars", "vpe/core", "paging"}},
      {"vpe/explore", "vpe::explore", {"mars", "vpe/core", "lod", "paging", "scripts", "panorama"}},
      {"vpe/report", "vpe::report", {"mars", "vpe/core"}},
      {"vpe/window",
       "vpe::window",
       {"mars", "vpe/core", "lod", "paging", "scripts", "vpe/overlay", "panorama", "vpe/explore"},
       true},
      {"vpe/app",
       "vpe::app",
       {"mars", "vpe/core", "cull", "lod", "paging", "scripts", "vpe/overlay", "vpe/gl", "vpe/voxel",
        "panorama", "vpe/explore", "vpe/report", "vpe/window"},
       true},
      {"tests",
       "",
       {"mars", "vpe/core", "cull", "lod", "paging", "scripts", "vpe/overlay", "vpe/gl", "vpe/voxel",
        "panorama", "vpe/explore", "vpe/report", "vpe/window", "vpe/app"},
       true,
       true},
  };
  return kLayers;
}

const Layer* layer_of(std::string_view path) {
  const auto found = std::find_if(layers().begin(), layers().end(),
                                  [path](const Layer& layer) { return path.starts_with(layer.folder + "/"); });
  return found == layers().end() ? nullptr : &*found;
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
  if (!quoted) return "";
  const Layer* used = layer_of(name);
  if (used == nullptr) return "\"" + name + "\" is not given from the root of the repository";
  const bool allowed = used == &layer || std::find(layer.may_use.begin(), layer.may_use.end(), used->folder) !=
                                             layer.may_use.end();
  return allowed ? "" : layer.folder + " must not use " + used->folder + " (" + name + ")";
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

// Sources of the tree, relative to its root; hidden folders and build folders left out.
std::vector<fs::path> all_sources(const fs::path& root) {
  std::vector<fs::path> sources;
  for (auto entry = fs::recursive_directory_iterator(root); entry != fs::end(entry); ++entry) {
    const std::string name = entry->path().filename().string();
    if (entry->is_directory() && (name.starts_with(".") || (entry.depth() == 0 && name.starts_with("build")))) {
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
      const auto above = std::find_if(layers().begin(), layers().begin() + static_cast<std::ptrdiff_t>(n),
                                      [&used](const Layer& layer) { return layer.folder == used; });
      EXPECT_NE(above, layers().begin() + static_cast<std::ptrdiff_t>(n))
          << layers()[n].folder << " uses " << used;
    }
  }
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
            "lod/a.cpp:2: lod must not use paging (paging/planet/planet_file.h)\n");
  EXPECT_NE(verdict("mars/a.cpp", "  #  include \"vpe/core/view.h\"\nnamespace mars {}"), "");
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
    EXPECT_EQ(verdict("mars/a.cpp", line + "namespace mars {}"), "") << header;
    EXPECT_EQ(verdict("tests/mars/a.cpp", line), "") << header;
  }
  EXPECT_EQ(verdict("vpe/overlay/a.cpp", "#include <cairo.h>\nnamespace vpe::overlay {}"), "");
  EXPECT_NE(verdict("vpe/app/a.cpp", "#include <cairo.h>\nnamespace vpe::app {}"), "");
  EXPECT_NE(verdict("vpe/core/a.cpp", "#include <cairo/cairo-ft.h>\nnamespace vpe::core {}"), "");
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
