// Files of surfaces: a base with height maps and reliefs on it.
//
// A file `*.surface.toml` has these tables; docs/guide/surfaces.md describes all keys.
//
//   version = 1
//   reliefs = "craters.relief.toml"     # on spheres and ellipsoids
//   [base]
//   kind = "ellipsoid"
//   semi_axes_m = [13000, 11400, 9100]
//   [[map]]
//   file = "radii.tif"
//   heights = "radius"
//
// Paths are relative to the folder of the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "relief/field/base.h"
#include "relief/field/patch.h"
#include "relief/field/stack.h"

namespace relief {

inline constexpr std::size_t kMostSurfaceFileBytes = std::size_t{1} << 20U;
inline constexpr std::size_t kMostSurfaceMaps = 64;
inline constexpr double kMostBaseLength_m = 1e9;
inline constexpr int kLeastFacePosts = 3;
inline constexpr int kMostFacePosts = 8193;

enum class MapHeights : std::uint8_t {
  kAboveBase,  // along the way in which Base measures heights
  kRadius,     // distances from the centre; of spheres and ellipsoids
};

// Describes a height map of a surface.
struct MapEntry {
  std::filesystem::path file;  // a raster, or a planet file
  MapHeights heights = MapHeights::kAboveBase;
  Interpolation interpolation = Interpolation::kBicubic;
  double scale = 1;              // factor of its heights
  std::optional<double> fill_m;  // in place of nodata; nullopt: nodata is an error
  std::optional<int> posts;      // of a side of a cube's face; nullopt: as many as the file has
  Compose compose = Compose::kSum;
  std::filesystem::path mask;  // shares 0 to 1, of Compose::kReplace
};

// Describes a surface. Planes and quadrics are there over `area_m` of the plane z = 0, along z.
struct SurfaceFile {
  std::filesystem::path path;
  Base base = Base::sphere({0, 0, 0}, 1);
  double radius_m = 1;  // of spheres, and the longest semi-axis of ellipsoids
  Rect area_m;
  std::vector<MapEntry> maps;
  std::filesystem::path reliefs;  // empty: none
  int relief_posts = 1025;        // of a side of a cube's face, at which reliefs are sampled
};

// Returns true for bases with six faces: spheres and ellipsoids.
bool is_round(const Base& base);

// Return the surface of a file, and of a text that messages call `path`. Throw std::runtime_error "FILE:LINE: what" for a
// text that is wrong, and vpe::base::FileError for a file that cannot be read.
SurfaceFile read_surface_file(const std::filesystem::path& path);
SurfaceFile parse_surface_toml(std::string_view text, const std::filesystem::path& path);

// Returns true for the names of files of surfaces: *.surface.toml.
bool is_surface_path(const std::filesystem::path& path);

}  // namespace relief
