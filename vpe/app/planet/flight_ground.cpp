#include "vpe/app/planet/flight_ground.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "mars/sources/source.h"
#include "mars/sources/source_checks.h"
#include "paging/live/composed_change.h"
#include "paging/live/planet_change.h"
#include "paging/live/relief_patch.h"
#include "relief/files/relief_file.h"
#include "vpe/app/cli/digest.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

using paging::GroundChange;
using paging::PlanetFile;

// States that are tried for the distance of posts. More: a state between them that needs more tiles is less likely.
constexpr std::size_t kMostTried = 64;

// Opens a raster whose heights can be mixed with those of a planet.
std::shared_ptr<const mars::ElevationSource> fitting_raster(const std::string& file, const PlanetFile& planet) {
  auto source = mars::open_elevation(file);
  const paging::PlanetMeta& meta = planet.meta();
  for (const mars::SourceInfo& info : source->infos()) {
    mars::check_body(info, meta.radius_m);
    if (!info.body.empty() && info.body != meta.body)
      throw mars::SourceError(file + ": is of " + info.body + ", and the planet is " + meta.body +
                              "; give a raster of the planet's body");
    if (info.datum.is_known() && meta.datum.is_known() && !(info.datum == meta.datum))
      throw mars::SourceError(file + ": its heights count from " + mars::to_string(info.datum) +
                              ", and those of the planet from " + mars::to_string(meta.datum) +
                              "; convert it by 'vpe patch', and give the patched planet in its place");
  }
  std::vector<std::string> notes;
  mars::check_range(*source, source->infos().front(), meta.radius_m, notes);
  return source;
}

}  // namespace

// Holds a file of the flight; one member has a value.
struct FlightGround::File {
  std::vector<relief::ReliefSpec> reliefs;
  std::shared_ptr<const GroundChange> planet;
  std::shared_ptr<const mars::ElevationSource> raster;
};

FlightGround::FlightGround(std::shared_ptr<const PlanetFile> planet, scripts::GroundTracks tracks,
                           std::string name, const Common& common, std::size_t budget_bytes)
    : base_(planet),
      tracks_(std::move(tracks)),
      name_(std::move(name)),
      threads_(common.threads),
      maker_(planet, budget_bytes / 4 * 3),
      surface_(std::move(planet), budget_bytes / 4) {
  for (const std::string& file : tracks_.files()) open(file);
  for (const double time_s : tracks_.times_s()) {
    try {
      (void)change(tracks_.at(time_s));
    } catch (const std::runtime_error& e) {
      throw std::runtime_error(name_ + ": at " + base::format_number(time_s) + " s: " + e.what());
    }
  }
}

FlightGround::~FlightGround() = default;

void FlightGround::open(const std::string& file) {
  std::error_code none;
  for (const auto& other : files_) {
    if (fs::equivalent(other.first, file, none))
      throw std::runtime_error(name_ + ": patches \"" + other.first + "\" and \"" + file +
                               "\" are one file; give it the same name in all lines");
  }
  auto opened = std::make_unique<File>();
  try {
    if (relief::is_relief_path(file)) {
      opened->reliefs = relief::read_relief_file(file);
    } else if (is_raster_argument(file)) {
      opened->raster = fitting_raster(file, *base_);
    } else {
      opened->planet = paging::planet_change(*base_, PlanetFile::open(file));
    }
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(name_ + ": a patch cannot be used: " + e.what());
  }
  files_[file] = std::move(opened);
}

std::shared_ptr<const GroundChange> FlightGround::change(const scripts::GroundState& state) const {
  std::vector<std::shared_ptr<const GroundChange>> changes;
  // Returns the ground that the changes so far leave.
  const auto ground_m = [&](const glm::dvec3& direction) {
    double height_m = maker_.ground_m(direction);
    int decided = -1;
    for (const auto& one : changes) {
      const double spacing_m = one->spacing_in({direction, 0});
      one->change({&direction, 1}, std::isfinite(spacing_m) ? spacing_m : 1, {&height_m, 1}, {&decided, 1});
    }
    return height_m;
  };
  for (const scripts::PatchState& patch : state.patches) {
    const File& file = *files_.at(patch.file);
    if (file.planet) {
      changes.push_back(paging::partial_change(file.planet, patch.mix));
    } else if (file.raster) {
      changes.push_back(paging::mixed_ground(file.raster, patch.mix));
    } else if (!file.reliefs.empty()) {
      changes.push_back(paging::partial_change(
          paging::relief_change(relief::place(file.reliefs, base_->radius_m(), ground_m), patch.file),
          patch.mix));
    }
  }
  if (!state.reliefs.empty())
    changes.push_back(paging::relief_change(relief::place(state.reliefs, base_->radius_m(), ground_m)));
  return changes.empty() ? nullptr : paging::changes_in_order(std::move(changes));
}

paging::PatchOptions FlightGround::patch_options(double finest_spacing_m) const {
  paging::PatchOptions options;
  options.full_grids = true;
  options.finest_spacing_m = finest_spacing_m;
  options.threads = threads_;
  return options;
}

std::shared_ptr<const PlanetFile> FlightGround::make(const scripts::GroundState& state,
                                                     double finest_spacing_m) const {
  const std::shared_ptr<const GroundChange> changed = change(state);
  if (!changed) return base_;
  const paging::MadePatch made = maker_.make(*changed, patch_options(finest_spacing_m));
  return made.patch ? base_->with(made.patch, planet_) : base_;
}

// Finds the distance of posts that all states can have.
void FlightGround::find_spacing() {
  if (finest_spacing_m_) return;
  double spacing_m = 0;
  const std::vector<double>& times_s = tracks_.times_s();
  const std::size_t step = times_s.size() / kMostTried + 1;
  for (std::size_t n = 0; n < times_s.size(); n += step) {
    const std::shared_ptr<const GroundChange> changed = change(tracks_.at(times_s[n]));
    if (!changed) continue;
    const paging::MadePatch planned = maker_.plan(*changed, patch_options(spacing_m));
    if (!planned.is_coarser) continue;
    is_coarser_ = true;
    spacing_m = std::max(spacing_m, planned.spacing_m);
  }
  finest_spacing_m_ = spacing_m;
}

bool FlightGround::is_coarser() {
  find_spacing();
  return is_coarser_;
}

std::shared_ptr<const PlanetFile> FlightGround::planet(const scripts::GroundState& state) {
  if (state.empty()) return base_;
  if (state_ == state) return planet_;
  find_spacing();
  state_.reset();
  planet_ = make(state, *finest_spacing_m_);
  state_ = state;
  return planet_;
}

double FlightGround::height_m(mars::LonLat place, double exaggeration, double time_s) {
  const glm::dvec3 direction = mars::direction(place);
  const double base_m = surface_.at(direction, exaggeration).height_m;
  const std::shared_ptr<const GroundChange> changed = change(tracks_.at(time_s));
  if (!changed) return base_m;
  const double spacing_m = changed->spacing_in({direction, 0});
  const double before_m = maker_.ground_m(direction);
  double after_m = before_m;
  int decided = -1;
  changed->change({&direction, 1}, std::isfinite(spacing_m) ? spacing_m : 1, {&after_m, 1}, {&decided, 1});
  return std::isfinite(after_m - before_m) ? base_m + exaggeration * (after_m - before_m) : base_m;
}

std::map<std::string, std::string> ground_file_stamps(const std::vector<std::string>& files) {
  std::map<std::string, std::string> stamps;
  for (const std::string& file : files) {
    std::string& stamp = stamps[file];
    if (relief::is_relief_path(file)) {
      stamp = "reliefs " + checksum_of(fs::path(file));
    } else if (is_raster_argument(file)) {
      stamp = "raster " + mars::raster_state(file).text;
    } else {
      stamp = "planet " + PlanetFile::open(file)->meta().identity;
    }
  }
  return stamps;
}

}  // namespace vpe::app
