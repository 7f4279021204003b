#include "vpe/app/scene/scene_library.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "objects/files/model_file.h"
#include "objects/files/model_references.h"
#include "objects/files/volume_model_file.h"
#include "objects/posters/kiosk.h"
#include "objects/scene/scatter.h"
#include "objects/scene/track.h"
#include "objects/sticks/stick_file.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/scene/level_cache.h"

namespace vpe::app {

namespace {

// The region of interest reaches this many radii of an object.
constexpr double kInterestRadii = 4;
constexpr double kLeastInterest_m = 10;

core::InterestRegion region_around(const mars::LonLat& place, double radius_m, double levels) {
  return {place.lon_deg, place.lat_deg, std::max(kLeastInterest_m, kInterestRadii * radius_m),
          static_cast<int>(std::lround(levels))};
}

// Returns the folder of kept levels; empty if nothing can be kept.
std::filesystem::path models_folder() {
  try {
    return cache_folder() / "models";
  } catch (const std::exception&) {
    return {};
  }
}

using Stamped = std::vector<std::pair<std::filesystem::path, std::optional<base::FileStamp>>>;

Stamped stamped(const std::filesystem::path& model) {
  Stamped files{{model, base::file_stamp(model)}};
  for (const std::filesystem::path& file : objects::model_references(model))
    files.emplace_back(file, base::file_stamp(file));
  return files;
}

bool is_unchanged(const Stamped& files) {
  return std::ranges::all_of(
      files, [](const auto& file) { return file.second && base::file_stamp(file.first) == file.second; });
}

}  // namespace

std::string object_name(const objects::Scene& scene, std::uint32_t instance) {
  const objects::Instance placed = scene.instance(instance);
  const std::string& name = scene.names()[placed.name];
  return name.empty() ? scene.models()[placed.model]->name() : name;
}

std::shared_ptr<const objects::Model> SceneLibrary::volume(const std::string& name,
                                                           const objects::VolumeFormula& formula) {
  KnownVolume& known = volumes_[name];
  if (known.model == nullptr || known.formula != formula) {
    known.model = std::make_shared<const objects::Model>(
        name, std::make_shared<const objects::VolumeModel>(objects::volume_by_formula(formula)));
    known.formula = formula;
  }
  return known.model;
}

std::shared_ptr<const objects::Model> SceneLibrary::model(const objects::ModelEntry& entry) {
  if (entry.formula) return volume(entry.name, *entry.formula);
  KnownModel& known = known_[entry.file];
  if (known.model && known.unit_m == entry.unit_m && known.up == entry.up && is_unchanged(known.files))
    return known.model;
  Stamped files = stamped(entry.file);
  if (entry.file.extension() == ".sticks") {
    known.model = std::make_shared<const objects::Model>(
        entry.name, std::make_shared<const objects::StickModel>(objects::read_stick_file(entry.file)));
  } else if (objects::is_volume_path(entry.file)) {
    known.model = std::make_shared<const objects::Model>(
        entry.name, std::make_shared<const objects::VolumeModel>(
                        objects::read_volume_model(entry.file, {.unit_m = entry.unit_m, .up = entry.up})));
  } else {
    objects::ModelFile file = objects::read_model_file(entry.file, {.unit_m = entry.unit_m, .up = entry.up});
    for (const std::string& note : file.notes) notes_.push_back(entry.file.string() + ": " + note);
    KeptLevels made = cached_levels(std::move(file.mesh), models_folder());
    if (!made.note.empty()) notes_.push_back(entry.file.string() + ": " + made.note);
    known.model = std::make_shared<const objects::Model>(entry.name, std::move(made.levels));
  }
  known.files = std::move(files);
  known.unit_m = entry.unit_m;
  known.up = entry.up;
  return known.model;
}

std::uint32_t SceneLibrary::name_index(const std::string& name) {
  const auto at = std::find(names_.begin(), names_.end(), name);
  if (at != names_.end()) return static_cast<std::uint32_t>(at - names_.begin());
  names_.push_back(name);
  return static_cast<std::uint32_t>(names_.size() - 1);
}

void SceneLibrary::read(const std::string& file) {
  const std::optional<base::FileStamp> stamp = base::file_stamp(file);
  const bool is_known = stamp && stamp_ == stamp && file_ == file;
  objects::Scene::Models models;
  if (!is_known) {
    // What fails leaves nothing half read.
    stamp_.reset();
    standing_.reset();
    entries_ = objects::read_scene_file(file);
    names_.assign(1, "");
  }
  for (const objects::ModelEntry& entry : entries_.models) models.push_back(model(entry));
  read_kiosks(is_known, models);
  if (images_.has_changed()) standing_.reset();
  if (models != models_) standing_.reset();
  models_ = std::move(models);
  file_ = file;
  stamp_ = stamp;
}

void SceneLibrary::read_kiosks(bool is_known, objects::Scene::Models& models) {
  const bool is_same = std::ranges::all_of(
      hotspots_, [](const auto& file) { return base::file_stamp(file.first) == file.second; });
  if (!is_known || !is_same) {
    standing_.reset();
    stamp_.reset();  // until all are read
    hotspots_.clear();
    for (const objects::KioskEntry& kiosk : entries_.kiosks) {
      if (!kiosk.hotspots.empty()) hotspots_.emplace_back(kiosk.hotspots, base::file_stamp(kiosk.hotspots));
    }
    kiosks_ = kiosk_places(entries_, surface_.planet_radius_m());
  }
  if (kiosks_.empty()) return;
  if (!kiosk_) {
    objects::Model::Level level;
    level.mesh = objects::make_kiosk();
    level.tree = objects::TriangleTree(level.mesh);
    std::vector<objects::Model::Level> levels;
    levels.push_back(std::move(level));
    kiosk_ = std::make_shared<const objects::Model>("kiosk", std::move(levels));
  }
  models.push_back(kiosk_);
}

objects::GroundRadius SceneLibrary::ground(double exaggeration) const {
  return [this, exaggeration](const glm::dvec3& direction) {
    return surface_.at(direction, exaggeration).radius_m;
  };
}

void SceneLibrary::place_standing(double exaggeration) {
  Standing standing;
  standing.exaggeration = exaggeration;
  const objects::GroundRadius radius_m = ground(exaggeration);
  const double planet_radius_m = surface_.planet_radius_m();
  const auto place = [&](const objects::Placing& placing, std::size_t model, std::uint32_t name) {
    const double size_m = static_cast<double>(models_[model]->ball().radius_m) * placing.scale;
    objects::Instance instance = objects::place_instance(placing, size_m, planet_radius_m, radius_m);
    instance.model = static_cast<std::uint32_t>(model);
    instance.name = name;
    return std::pair(instance, size_m);
  };
  PlacedParts parts;
  for (const objects::ObjectEntry& entry : entries_.objects) {
    const std::uint32_t name = name_index(entry.name);
    standing.begins.push_back({standing.instances.size(), standing.interest.size()});
    for (const objects::Placing& placing : entry.places) {
      const auto [instance, size_m] = place(placing, entry.model, name);
      if (entry.ground.kind != objects::GroundRole::Kind::kNone) {
        parts.push_back(
            {std::make_shared<const objects::Scene>(models_, std::vector<objects::Instance>{instance}, names_),
             entry.ground});
        if (entry.ground.kind == objects::GroundRole::Kind::kAdd) standing.added.push_back(instance);
      } else {
        standing.instances.push_back(instance);
      }
      if (entry.interest_levels != 0)
        standing.interest.push_back(region_around(placing.place, size_m, entry.interest_levels));
    }
  }
  for (const KioskPlace& kiosk : kiosks_)
    standing.instances.push_back(place(kiosk.placing, models_.size() - 1, name_index(kiosk.name)).first);
  if (!entries_.posters.empty()) {
    std::vector<objects::PlacedPoster> posters;
    for (const objects::PosterEntry& entry : entries_.posters)
      posters.push_back(images_.placed(entry, planet_radius_m, radius_m));
    standing.posters = std::make_shared<const std::vector<objects::PlacedPoster>>(std::move(posters));
  }
  std::vector<objects::RockModel> rocks;
  for (const auto& m : models_)
    rocks.push_back({2 * static_cast<double>(m->ball().radius_m), glm::dvec3(m->ball().centre_m)});
  for (const objects::ScatterEntry& entry : entries_.scatters) {
    const std::uint32_t name = name_index(entry.name);
    for (const objects::Scattered& rock : objects::scatter(entry, rocks, planet_radius_m))
      standing.instances.push_back(place(rock.placing, rock.model, name).first);
  }
  if (!parts.empty()) {
    standing.ground_parts = ground_parts(parts, planet_radius_m);
    standing.parts = std::make_shared<const PlacedParts>(std::move(parts));
  }
  standing_ = std::move(standing);
  if (entries_.paths.empty()) {
    const PlacedScene placed = with_parts(standing_->instances, {});
    standing_->scene = placed.scene;
    standing_->apart = placed.apart;
  }
}

PlacedScene SceneLibrary::with_parts(std::vector<objects::Instance> instances,
                                     std::vector<core::InterestRegion> interest) const {
  PlacedScene placed;
  placed.interest = std::move(interest);
  placed.parts = standing_->parts;
  placed.posters = standing_->posters;
  placed.ground_parts = standing_->ground_parts;
  if (standing_->added.empty()) {
    placed.apart = std::make_shared<const objects::Scene>(models_, std::move(instances), names_);
    placed.scene = placed.apart;
    return placed;
  }
  placed.apart = std::make_shared<const objects::Scene>(models_, instances, names_);
  instances.insert(instances.end(), standing_->added.begin(), standing_->added.end());
  placed.scene = std::make_shared<const objects::Scene>(models_, std::move(instances), names_);
  return placed;
}

void SceneLibrary::move(const core::ObjectTrack& track, double time_s, double exaggeration,
                        std::vector<objects::PathEntry>& paths, std::vector<objects::Instance>& instances,
                        std::vector<std::size_t>& hidden, std::vector<core::InterestRegion>& interest) const {
  const objects::TrackTarget target = objects::track_target(entries_, track);
  const bool is_shown = core::is_shown(track, time_s);
  if (target.is_path) {
    objects::PathEntry& path = paths[target.entry];
    if (!is_shown) {
      path.points.clear();
    } else if (!track.points.empty()) {
      path.points = objects::path_points(track);
    }
    return;
  }
  const Begin begin = standing_->begins[target.entry];
  objects::Instance& instance = instances[begin.instance];
  if (!is_shown) {
    hidden.push_back(begin.instance);
  } else if (!track.points.empty()) {
    const objects::ObjectEntry& entry = entries_.objects[target.entry];
    const objects::Placing placing =
        objects::placing_at(entry.places.front(), objects::path_points(track), time_s);
    const double size_m = static_cast<double>(models_[entry.model]->ball().radius_m) * placing.scale;
    objects::Instance moved =
        objects::place_instance(placing, size_m, surface_.planet_radius_m(), ground(exaggeration));
    moved.model = instance.model;
    moved.name = instance.name;
    instance = moved;
    if (entry.interest_levels != 0)
      interest[begin.interest] = region_around(placing.place, size_m, entry.interest_levels);
  }
}

PlacedScene SceneLibrary::scene(const std::string& file, double exaggeration, double time_s,
                                const std::vector<core::ObjectTrack>* tracks) {
  read(file);
  if (!standing_ || standing_->exaggeration != exaggeration) place_standing(exaggeration);
  const bool has_tracks = tracks != nullptr && !tracks->empty();
  if (standing_->scene && !has_tracks)
    return {standing_->scene,        standing_->interest, false, standing_->apart, standing_->parts,
            standing_->ground_parts, standing_->posters};
  std::vector<objects::Instance> instances = standing_->instances;
  std::vector<core::InterestRegion> interest = standing_->interest;
  std::vector<objects::PathEntry> paths = entries_.paths;
  std::vector<std::size_t> hidden;
  if (has_tracks) {
    for (const core::ObjectTrack& track : *tracks)
      move(track, time_s, exaggeration, paths, instances, hidden, interest);
  }
  std::ranges::sort(hidden, std::greater());
  for (const std::size_t n : hidden) instances.erase(instances.begin() + static_cast<std::ptrdiff_t>(n));
  for (const objects::PathEntry& path : paths) {
    if (path.points.empty()) continue;
    objects::Instance moving = objects::path_instance(path, time_s, ground(exaggeration));
    moving.model = static_cast<std::uint32_t>(path.model);
    moving.name = name_index(path.name);
    instances.push_back(moving);
  }
  PlacedScene placed = with_parts(std::move(instances), std::move(interest));
  placed.moves = true;
  return placed;
}

std::vector<std::string> SceneLibrary::take_notes() { return std::exchange(notes_, {}); }

std::size_t SceneLibrary::bytes() const {
  std::size_t sum = images_.bytes();
  for (const auto& m : models_) sum += m->bytes();
  if (standing_)
    sum += (standing_->instances.capacity() + standing_->added.capacity()) * sizeof(objects::Instance);
  if (standing_ && standing_->scene) sum += standing_->scene->bytes();
  return sum;
}

}  // namespace vpe::app
