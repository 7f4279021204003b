// Scene files: which models stand where on a planet.
//
// A scene file `*.scene.toml` has these tables. Paths are relative to its folder, angles are in degrees, lengths
// in metres. Places are longitude (east positive) and latitude (planetocentric).
//
//   version = 1
//   [[model]]                                  # name, file; unit_m = 1, up = "auto" | "y" | "z"
//   name = "rover"
//   file = "models/rover.glb"
//   [[volume]]                                 # a model by formula (objects/volumes/volume_formulas.h): name,
//   name = "devil"                             # height_m, radius_m, optical_depth = 1, lean_m = 0, colour, seed = 1,
//   kind = "dust-devil"                        # voxels = 128; kind: or "cloud", "plume"
//   height_m = 120
//   radius_m = 15
//   [[object]]                                 # model; name
//   model = "rover"                            # lon and lat, or at = [[lon, lat], [lon, lat, heading]]
//   lon = 137.4                                # height = 0 above the ground, or altitude above the sphere
//   lat = -4.6                                 # heading = 0, pitch = 0, roll = 0, scale = 1
//   align = "slope"                            # or "vertical"; interest_levels = 0
//   ground = "cut"                             # or "add": part of the ground; voxel_m, and solid_above for volumes
//   [[scatter]]                                # models = ["stone", ...]; name
//   models = ["rover"]                         # polygon = [[lon, lat], ...], its edges are great circles
//   polygon = [[0, 0], [0.1, 0], [0, 0.1]]     # seed = 1, buried = 0.3, align, tumble = false, most
//   rock_abundance = 0.05                      # or density_per_m2 and exponent
//   diameter_m = [0.5, 4]
//   [[path]]                                   # model; name, scale = 1
//   model = "rover"                            # wheelbase_m and track_m, or neither
//   points = [[0, 137.4, -4.6], [60, 137.5, -4.6, 90]]  # seconds, lon, lat, heading
//                                            # and height above the ground; "way": heading along the way
//   [[picture]] and [[kiosk]]: poster_entry.h
//
// GeoJSON (`*.geojson`, `*.json`) is a FeatureCollection of Points. The properties model (a path), name, height,
// altitude, heading, pitch, roll, scale and align are read; others are not, nor is a third coordinate.
//
// Typical usage:
//   const SceneFile scene = read_scene_file("gale.scene.toml");
//   for (const ObjectEntry& object : scene.objects) place(scene.models[object.model].file, object.places);
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "objects/files/height_kind.h"
#include "objects/files/poster_entry.h"
#include "objects/files/up_axis.h"
#include "objects/volumes/volume_formulas.h"

namespace objects {

inline constexpr std::size_t kMostInstances =
    1'000'000;  // of all objects and paths of a file, and of a scatter
inline constexpr std::size_t kMostSceneFileBytes = std::size_t{64} << 20U;
inline constexpr std::size_t kMostNameBytes = 200;
inline constexpr std::size_t kMostPolygonCorners = 2000;
inline constexpr std::size_t kMostPosters = 1000;  // tables [[picture]] of a file

struct ModelEntry {
  std::string name;            // unique in the file; of GeoJSON: the path as it stands there
  std::filesystem::path file;  // with the scene file's folder; empty: by formula
  double unit_m = 1;           // metres of a unit of the model file
  UpAxis up = UpAxis::kAuto;
  std::optional<VolumeFormula> formula = std::nullopt;
};

// Describes where and how a model stands. Heading, pitch and roll are applied in this order.
struct Placing {
  mars::LonLat place;
  HeightKind height_kind = HeightKind::kAboveGround;
  double height_m = 0;
  double heading_deg = 0;  // clockwise from north
  double pitch_deg = 0;    // up
  double roll_deg = 0;     // positive: the right side is down
  bool follows_slope = false;
  double scale = 1;
};

// Says how an object is part of the ground.
struct GroundRole {
  enum class Kind : std::uint8_t { kNone, kAdd, kCut };
  Kind kind = Kind::kNone;
  double voxel_m = 0;            // side of its voxels; 0: a 128th of its diameter
  double solid_above_per_m = 0;  // extinction from which on a volume is solid; 0: half of its largest one
};

struct ObjectEntry {
  std::string name;       // "": none
  std::size_t model = 0;  // of SceneFile::models
  std::vector<Placing> places;
  double interest_levels = 0;  // by which the ground around it is finer
  GroundRole ground = {};
};

// Describes N rocks of at least D for a square metre, N ~ D^-exponent, all within the diameters of the entry.
struct PowerLaw {
  double density_per_m2 = 0;
  double exponent = 0;
};

// Describes rocks as on Mars: those of at least D cover the share F(D) = k exp(-q D) of the ground, with
// q = 1.79 + 0.152 / k and D in metres (Golombek and Rapp 1997, J. Geophys. Res. 102(E2)).
struct RockAbundance {
  double k = 0;
};

struct ScatterEntry {
  std::string name;
  std::vector<std::size_t> models;    // of SceneFile::models, equally frequent
  std::vector<mars::LonLat> polygon;  // encloses the smaller side, whatever its orientation
  std::uint64_t seed = 1;
  std::variant<PowerLaw, RockAbundance> distribution;
  double least_diameter_m = 1;
  double most_diameter_m = 1;
  double buried = 0.3;  // share of the diameter below the ground
  bool follows_slope = false;
  bool tumbles = false;    // rotations of all directions, not only headings
  std::size_t most = 0;    // rocks; 0: kMostInstances, beyond which scatter() fails
  std::string where = "";  // "FILE:LINE", for messages
};

struct PathPoint {
  double time_s = 0;
  mars::LonLat place;
  std::optional<double> heading_deg = std::nullopt;  // from here to the next point; nullopt: along the way
  double height_m = 0;                               // above the ground; even between two points
};

struct PathEntry {
  std::string name;
  std::size_t model = 0;
  std::vector<PathPoint> points;  // at least one; times ascend strictly
  double scale = 1;
  double wheelbase_m = 0;  // from the front to the rear wheels, on the ground; 0: the model stays upright
  double track_m = 0;      // from the left to the right wheels
};

struct SceneFile {
  std::filesystem::path path;
  std::vector<ModelEntry> models;
  std::vector<ObjectEntry> objects;
  std::vector<ScatterEntry> scatters;
  std::vector<PathEntry> paths;
  std::vector<PosterEntry> posters;
  std::vector<KioskEntry> kiosks;
};

// Reads a scene file. Throws vpe::base::FileError for a file that cannot be read or is larger than
// kMostSceneFileBytes, and std::runtime_error "FILE:LINE: what" ("FILE: features[3].geometry: what" in GeoJSON,
// counted from 0) for what is wrong in it.
SceneFile read_scene_file(const std::filesystem::path& path);

// Read the text of a file that has this name, which decides nothing but the folder and the messages. Throw
// std::runtime_error as above.
SceneFile parse_scene_toml(std::string_view text, const std::filesystem::path& path);
SceneFile parse_scene_geojson(std::string_view text, const std::filesystem::path& path);

// Returns the scene file, the files of its models, those that they consist of (model_references.h), images and files of
// hotspots, each once; volumes by formula have none.
std::vector<std::filesystem::path> files_of(const SceneFile& scene);

}  // namespace objects
