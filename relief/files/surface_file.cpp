#include "relief/files/surface_file.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "vpe/base/file.h"
#include "vpe/base/toml_table.h"

namespace relief {

namespace {

using vpe::base::NumberRange;
using vpe::base::TomlTable;

constexpr std::string_view kSurfaceExtension = ".surface.toml";
constexpr NumberRange kLengths_m{0, kMostBaseLength_m, true};
constexpr NumberRange kCoordinates_m{-kMostBaseLength_m, kMostBaseLength_m};
constexpr NumberRange kCoefficients{-1e18, 1e18};
constexpr NumberRange kScales{-1e6, 1e6};
constexpr NumberRange kFills_m{-1e9, 1e9};

std::string problem_of_file_name(std::string_view name) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  return name.empty() || name.size() > 4096 || std::ranges::any_of(name, is_control)
             ? "expected a file name of 1 to 4096 bytes without control characters"
             : "";
}

class SurfaceTomlReader {
 public:
  explicit SurfaceTomlReader(const std::filesystem::path& path) : file_(path.string()) { surface_.path = path; }

  SurfaceFile read(const toml::table& root) {
    const TomlTable top(root, "the file", file_);
    top.require_known({"version", "base", "map", "reliefs", "relief_posts"});
    if (!top.has("version")) top.fail("version is missing; expected version = 1");
    top.integer("version", 1, 1);
    const toml::node& base = top.at("base");
    if (!base.is_table()) top.fail_expecting(base, "base", "a table [base]");
    read_base(TomlTable(*base.as_table(), "[base]", file_));
    if (top.has("map")) read_maps(top);
    if (top.has("reliefs")) {
      if (!is_round(surface_.base))
        top.fail(top.at("reliefs"),
                 "reliefs: they have longitudes and latitudes; expected a sphere or an ellipsoid as base");
      surface_.reliefs = path_of(top, "reliefs");
    }
    if (top.has("relief_posts")) {
      if (surface_.reliefs.empty()) top.fail(top.at("relief_posts"), "relief_posts: expected reliefs too");
      surface_.relief_posts = static_cast<int>(top.integer("relief_posts", kLeastFacePosts, kMostFacePosts));
    }
    return std::move(surface_);
  }

 private:
  std::filesystem::path path_of(const TomlTable& table, std::string_view key) const {
    return (surface_.path.parent_path() / table.text(key, problem_of_file_name)).lexically_normal();
  }

  static glm::dvec3 vector_of(const TomlTable& table, const toml::node& node, std::string_view what,
                              const NumberRange& range) {
    const toml::array& parts = table.list_of(node, what, 3, 3, "three numbers [x, y, z]");
    return {table.number_of(parts[0], what, range), table.number_of(parts[1], what, range),
            table.number_of(parts[2], what, range)};
  }

  void read_base(const TomlTable& table) {
    switch (table.choice("kind", {"plane", "sphere", "ellipsoid", "quadric"})) {
      case 0:
        table.require_known({"kind", "size_m"});
        surface_.base = Base::plane({0, 0, 0}, {0, 0, 1});
        read_area(table);
        break;
      case 1:
        table.require_known({"kind", "radius_m"});
        surface_.radius_m = table.number("radius_m", kLengths_m);
        surface_.base = Base::sphere({0, 0, 0}, surface_.radius_m);
        break;
      case 2: {
        table.require_known({"kind", "semi_axes_m"});
        const glm::dvec3 axes_m = vector_of(table, table.at("semi_axes_m"), "semi_axes_m", kLengths_m);
        surface_.radius_m = std::max({axes_m.x, axes_m.y, axes_m.z});
        surface_.base = Base::ellipsoid({0, 0, 0}, axes_m);
        break;
      }
      default: read_quadric(table); read_area(table);
    }
  }

  void read_quadric(const TomlTable& table) {
    table.require_known({"kind", "matrix", "linear", "constant", "anchor_m", "size_m"});
    Quadratic f;
    const toml::array& rows = table.list_of(table.at("matrix"), "matrix", 3, 3, "three rows of three numbers");
    for (int row = 0; row < 3; ++row) {
      const glm::dvec3 numbers = vector_of(table, rows[static_cast<std::size_t>(row)], "matrix", kCoefficients);
      for (int column = 0; column < 3; ++column) f.matrix[column][row] = numbers[column];
    }
    if (table.has("linear")) f.linear = vector_of(table, table.at("linear"), "linear", kCoefficients);
    f.constant = table.number("constant", kCoefficients, 0);
    glm::dvec3 anchor_m{0, 0, 0};
    if (table.has("anchor_m")) anchor_m = vector_of(table, table.at("anchor_m"), "anchor_m", kCoordinates_m);
    try {
      surface_.base = Base::quadric(f, anchor_m);
    } catch (const std::invalid_argument& e) {
      table.fail(e.what());
    }
  }

  void read_area(const TomlTable& table) {
    const toml::array& sides =
        table.list_of(table.at("size_m"), "size_m", 2, 2, "two lengths [along x, along y]");
    const double x_m = 0.5 * table.number_of(sides[0], "size_m", kLengths_m);
    const double y_m = 0.5 * table.number_of(sides[1], "size_m", kLengths_m);
    surface_.area_m = {-x_m, -y_m, x_m, y_m};
  }

  void read_maps(const TomlTable& top) {
    const toml::node& node = top.at("map");
    const toml::array* tables = node.as_array();
    if (tables == nullptr) top.fail_expecting(node, "map", "tables [[map]]");
    if (tables->size() > kMostSurfaceMaps)
      top.fail(node, "expected at most " + std::to_string(kMostSurfaceMaps) + " maps, found " +
                         std::to_string(tables->size()));
    for (const toml::node& one : *tables) {
      if (!one.is_table()) top.fail_expecting(one, "map", "tables [[map]]");
      read_map(TomlTable(*one.as_table(), "[[map]]", file_));
    }
  }

  void read_map(const TomlTable& table) {
    table.require_known({"file", "heights", "interpolation", "scale", "fill_m", "posts", "compose", "mask"});
    MapEntry map;
    map.file = path_of(table, "file");
    if (table.has("heights"))
      map.heights = static_cast<MapHeights>(table.choice("heights", {"base", "radius"}));
    if (table.has("interpolation"))
      map.interpolation = static_cast<Interpolation>(table.choice("interpolation", {"bilinear", "bicubic"}));
    map.scale = table.number("scale", kScales, 1);
    if (table.has("fill_m")) map.fill_m = table.number("fill_m", kFills_m);
    if (table.has("posts"))
      map.posts = static_cast<int>(table.integer("posts", kLeastFacePosts, kMostFacePosts));
    if (table.has("compose"))
      map.compose = static_cast<Compose>(table.choice("compose", {"sum", "max", "replace"}));
    if (table.has("mask")) map.mask = path_of(table, "mask");
    if (!is_round(surface_.base)) {
      if (map.heights == MapHeights::kRadius)
        table.fail(table.at("heights"), "heights: a plane or a quadric has no centre; expected base");
      if (map.posts)
        table.fail(table.at("posts"),
                   "posts: the maps of a plane or a quadric have the posts of their rasters");
    }
    if ((map.compose == Compose::kReplace) == map.mask.empty())
      table.fail("expected a mask with compose = \"replace\", and none otherwise");
    surface_.maps.push_back(std::move(map));
  }

  std::string file_;
  SurfaceFile surface_;
};

}  // namespace

bool is_round(const Base& base) {
  return base.kind() == Base::Kind::kSphere || base.kind() == Base::Kind::kEllipsoid;
}

bool is_surface_path(const std::filesystem::path& path) {
  return path.filename().string().ends_with(kSurfaceExtension);
}

SurfaceFile parse_surface_toml(std::string_view text, const std::filesystem::path& path) {
  if (text.size() > kMostSurfaceFileBytes)
    throw std::runtime_error(path.string() + ":1: expected at most " +
                             std::to_string(kMostSurfaceFileBytes >> 20U) + " MiB");
  return SurfaceTomlReader(path).read(vpe::base::parse_toml(text, path.string()));
}

SurfaceFile read_surface_file(const std::filesystem::path& path) {
  if (!is_surface_path(path))
    throw vpe::base::file_error("read", path, "it is no file of a surface", "name it *.surface.toml");
  const std::vector<std::uint8_t> bytes = vpe::base::read_file(path, kMostSurfaceFileBytes);
  return parse_surface_toml({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

}  // namespace relief
