// The planet of a flight whose ground changes, at each time.
//
// Typical usage:
//   FlightGround ground(planet, path.ground(), "tour.flight", common);
//   paging::change_planet(*renderer, ground.planet(path.ground().at(time_s)));
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "paging/live/patch_maker.h"
#include "paging/planet/planet_file.h"
#include "paging/surface/surface.h"
#include "scripts/ground_tracks.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

// Makes the planets of a flight, one after the other, from the planet without its changes. What it returns for a state
// does not depend on what was asked before. One thread at a time.
//
// - Patches come first, then reliefs. The zero of a relief that counts from the ground counts from the patched ground.
// - A file *.relief.toml changes the ground by its reliefs; any other file is a planet (*.vpe), of which the ground is
//   taken where it differs, or a raster. A raster without a datum is taken for heights of the planet's datum.
// - All planets of a flight have one finest distance of posts, so that no level of detail changes from frame to frame: where a
//   state at the time of a line needs more tiles than a patch may have, it is coarser in all of them.
class FlightGround {
 public:
  // Opens the files. `name` is that of the flight in messages. Throws std::runtime_error that names the flight, and the
  // time or the file, for files that cannot be opened, are there under two names, or are of another body, radius or datum, and
  // for reliefs that cannot be placed at the times of their lines. Keeps about `budget_bytes`. Smaller: the ground is
  // sampled again more often.
  FlightGround(std::shared_ptr<const paging::PlanetFile> planet, scripts::GroundTracks tracks, std::string name,
               const Common& common, std::size_t budget_bytes = std::size_t{128} << 20);
  ~FlightGround();
  FlightGround(const FlightGround&) = delete;
  FlightGround& operator=(const FlightGround&) = delete;

  // Returns the planet with the changes of a state of the tracks; the planet itself if there are none. Throws what
  // paging::PatchMaker::make() throws.
  std::shared_ptr<const paging::PlanetFile> planet(const scripts::GroundState& state);

  // Returns the height of the changed terrain at a time as scripts::ChangingTerrainHeight does, without the rounding of
  // a planet's heights.
  double height_m(mars::LonLat place, double exaggeration, double time_s);

  // Returns true if posts are farther apart than the flight asks for.
  bool is_coarser();

  const scripts::GroundTracks& tracks() const { return tracks_; }

 private:
  std::shared_ptr<const paging::GroundChange> change(const scripts::GroundState& state) const;
  paging::PatchOptions patch_options(double finest_spacing_m) const;
  std::shared_ptr<const paging::PlanetFile> make(const scripts::GroundState& state,
                                                 double finest_spacing_m) const;
  void open(const std::string& file);
  void find_spacing();

  std::shared_ptr<const paging::PlanetFile> base_;
  scripts::GroundTracks tracks_;
  std::string name_;
  int threads_;
  paging::PatchMaker maker_;
  paging::Surface surface_;
  struct File;
  std::map<std::string, std::unique_ptr<const File>> files_;
  std::optional<double> finest_spacing_m_;  // once it is known; 0: what the states ask for
  bool is_coarser_ = false;
  std::optional<scripts::GroundState> state_;  // of planet_
  std::shared_ptr<const paging::PlanetFile> planet_;
};

// Returns for each file a text of its content: of a planet its identity, of a file of reliefs a checksum, of a raster the state of its
// files. Throws std::runtime_error for files that cannot be read.
std::map<std::string, std::string> ground_file_stamps(const std::vector<std::string>& files);

}  // namespace vpe::app
