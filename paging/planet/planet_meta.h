// What a planet file says of itself, and the constants of its format.
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
inline constexpr int kFormatMinor = 2;
inline constexpr double kMinRadius_m = 1;     // of a planet, included
inline constexpr double kMaxRadius_m = 1e12;  // excluded
inline constexpr int kImageIntervals = 256;   // an image tile has 257 x 257 texels on its grid lines

// A planet file that cannot be used. what() names the file, the trouble and what to do.
class PlanetError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct PlanetMeta {
  std::string body = "Mars";
  double radius_m = mars::kMarsRadius_m;
  mars::VerticalDatum datum;     // of the heights; S lies at radius_m + height
  std::string shape = "sphere";  // "radius": these are true radii, datum is the sphere of radius_m
  lod::TileShape tile;
  double quantum_m = 1.0 / 16.0;
  double fill_m = 0;                      // drawn where no source has data; query answers null there
  std::vector<mars::SourceInfo> sources;  // elevation, as tiles name them by index
  std::vector<mars::SourceInfo> image_sources;
  ResamplingError resampling;
  double lowest_radius_m = 0;   // no point of S lies below
  double highest_radius_m = 0;  // none above
  std::int64_t leaf_tiles = 0;
  std::int64_t tiles = 0;
  std::int64_t image_tiles = 0;
  int finest_level = 0;
  int finest_image_level = -1;
  std::string program;               // version that built it
  std::string identity;              // hexadecimal hash over all checksums: equal content, equal identity
  bool illustration = false;         // some source is made up
  std::vector<LevelSummary> levels;  // by level, coarsest first; empty in files of format 1.0
  std::optional<ShardMeta> share;    // the file holds this part of the tiles only

  bool operator==(const PlanetMeta&) const;
};

// meta <-> rows of the table `meta`. from_rows throws PlanetError naming the file and the key that is missing,
// malformed or of a newer major format, or that the rows do not fit their checksum. from_rows(to_rows(m)) == m.
std::map<std::string, std::string> to_rows(const PlanetMeta& meta);
PlanetMeta from_rows(const std::map<std::string, std::string>& rows, const std::string& path);

// The tables, as SQL to create them.
extern const char* const kSchema;

// Canonical bytes of one row of the tile index, for its checksum.
struct NodeRow {
  std::int64_t key = 0;
  double min_m = 0;
  double max_m = 0;
  bool inner = false;
  int coarser_neighbour_mask = 0;  // bit e set: across edge e (lod::Edge) lies a finest tile one level coarser
  double slope = 0;                // TileInfo::steepest_slope
  std::string sources;             // indices into meta.sources, comma-separated
  std::vector<lod::MeshVariant> variants;
  std::optional<lod::ErrorTerms> posts_terms;  // of an inner tile; has a checksum of its own (format 1.2)
};
std::int64_t checksum(const NodeRow& row);
std::int64_t posts_checksum(const NodeRow& row);

// All rows of the tile index, in key order, each with its variants. Returns the key of the first row that does
// not fit its checksum, if any (rows then ends before it). Throws DatabaseError.
std::optional<std::int64_t> read_nodes(const Database& db, std::vector<NodeRow>& rows);

// What the tables hold of each level, but for the resampling error; tiles of `posts` posts. Throws
// DatabaseError, CodecError.
std::vector<LevelSummary> summarize_levels(const Database& db, std::size_t posts);

// PlanetMeta::identity of what the tables hold. Throws DatabaseError.
std::string content_identity(const Database& db);

}  // namespace paging
