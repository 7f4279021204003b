// The table `meta` of a planet file, its tile index, and the constants of the format.
#pragma once

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "lod/tree/posts.h"
#include "lod/tree/tree.h"
#include "mars/geodesy/sphere.h"
#include "mars/sources/source.h"
#include "paging/planet/planet_summary.h"

namespace paging {

class Database;

inline constexpr std::int64_t kApplicationId = 0x56504531;  // "VPE1"
inline constexpr int kFormatMajor = 1;
inline constexpr int kFormatMinor = 5;        // of files with image layers; 4 of all others
inline constexpr double kMinRadius_m = 1;     // of a planet, included
inline constexpr double kMaxRadius_m = 1e12;  // excluded
inline constexpr int kImageIntervals = 256;   // an image tile has 257 x 257 texels on its grid lines
inline constexpr const char* kMetaChecksumKey = "checksum";  // its row covers all other rows of `meta`
// Keys of the rows that tell how the file was built.
inline constexpr const char* kBuildSettingsKey = "build";
inline constexpr const char* kArgumentsKey = "arguments";

// Returns true if the file begins as a planet file of this program does, complete or not, sound or not. Does not
// throw.
bool is_planet_file(const std::string& path);

// Reports a planet file that cannot be used. what() names the file, the problem and what to do.
class PlanetError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Describes a layer of imagery: one image source, which the file holds apart beside the imagery composed of all.
struct ImageLayer {
  std::string name;  // unique; the settings and vpe info name it so
  int source = 0;    // index into PlanetMeta::image_sources
  int finest_level = -1;
  std::int64_t tiles = 0;
  std::int64_t bytes = 0;  // of its tiles as they are stored

  bool operator==(const ImageLayer&) const = default;
};

// Describes a planet file as a whole.
struct PlanetMeta {
  std::string body = "Mars";
  double radius_m = mars::kMarsRadius_m;
  mars::VerticalDatum datum;     // of the heights; the reference surface lies at radius_m + height
  std::string shape = "sphere";  // "radius": heights are true radii, datum is the sphere of radius_m
  lod::TileShape tile;
  double quantum_m = 1.0 / 16.0;
  double fill_m = 0;                      // drawn where no source has data; query answers null there
  std::vector<mars::SourceInfo> sources;  // elevation; tiles refer to them by index
  std::vector<mars::SourceInfo> image_sources;
  std::vector<ImageLayer> image_layers;  // the coarsest first; empty: the file has the composed imagery alone
  ResamplingError resampling;
  double lowest_radius_m = 0;   // no point of the reference surface lies below
  double highest_radius_m = 0;  // none above
  std::int64_t leaf_tiles = 0;
  std::int64_t tiles = 0;
  std::int64_t image_tiles = 0;
  int finest_level = 0;
  int finest_image_level = -1;
  std::string program;        // version that built it
  std::string identity;       // hexadecimal hash of all checksums: equal content, equal identity
  bool illustration = false;  // some source is made up
  // Lines of all that the content of a tile depends on beside the sources and what stands here; empty before 1.4.
  std::string build_settings;
  std::vector<std::string> arguments;  // of the command that opens the same sources; empty: not known
  std::vector<LevelSummary> levels;    // by level, coarsest first; empty in files of format 1.0
  std::optional<ShardMeta> shard;      // set when the file holds one shard of a divided build only

  bool operator==(const PlanetMeta&) const;
};

// Converts meta to rows of the table `meta`. from_rows(to_rows(m)) == m.
std::map<std::string, std::string> to_rows(const PlanetMeta& meta);
// Converts rows of the table `meta` back. Throws PlanetError when a key does not exist, is malformed or of a
// newer major format, or when the rows do not match their checksum; the message names the file and the key.
PlanetMeta from_rows(const std::map<std::string, std::string>& rows, const std::string& path);

// SQL that creates the tables, and the table of image layers, which only files with layers have.
extern const char* const kSchema;
extern const char* const kLayerSchema;

// Holds one row of the tile index (table `node`) with its rows of the tables `variant` and `posts_error`.
struct NodeRow {
  std::int64_t key = 0;
  double min_m = 0;
  double max_m = 0;
  bool inner = false;
  // Bit e is set where a finest tile one level coarser lies across edge e (lod::Edge). Column `steps`.
  int coarser_neighbour_mask = 0;
  double slope = 0;     // TileInfo::steepest_slope
  std::string sources;  // indices into meta.sources, comma-separated
  std::vector<lod::MeshVariant> variants;
  std::optional<lod::ErrorTerms> posts_terms;  // of an inner tile; has a checksum of its own (format 1.2)
};
// Returns the numbers of NodeRow::sources, or nullopt if it is not a list of numbers from 0 on.
std::optional<std::vector<int>> source_indices(const std::string& sources);

// Converts a row to the tile of the tree. Expects a key that a tile has.
lod::TileInfo tile_info(NodeRow row);

// Returns the intervals of the grid that a tile's meshes are made on: an inner tile is meshed over its
// children's posts.
inline int mesh_intervals(const lod::TileShape& shape, bool inner) {
  return (inner ? 2 : 1) * shape.intervals();
}

// Bounds how far a facet of a finest tile's cells lies below the sphere through its posts: a point of a flat
// triangle is within longest edge / sqrt(3) of a post.
inline double facet_sagitta_m(double spacing_m, double radius_m) {
  return 2.5 * spacing_m * spacing_m / (6.0 * radius_m);
}

// Returns the checksum of a row's canonical bytes; the second one covers posts_terms alone.
std::int64_t checksum(const NodeRow& row);
std::int64_t posts_checksum(const NodeRow& row);

// Reads the whole tile index in key order. Returns the key of the first row that does not match its checksum, or
// that no builder writes, if any; `rows` then ends before it. Throws DatabaseError.
std::optional<std::int64_t> read_nodes(const Database& db, std::vector<NodeRow>& rows);

// Summarizes what the tables hold of each level, except the resampling errors; `posts` is the number of posts of
// a tile. Throws DatabaseError, CodecError.
std::vector<LevelSummary> summarize_levels(const Database& db, std::size_t posts);

// Computes PlanetMeta::identity of what the tables hold. Throws DatabaseError.
std::string content_identity(const Database& db);

}  // namespace paging
