// Objects of scene files as they stand on a planet: models are read once, and placed when the ground or the time changes.
//
// Typical usage:
//   SceneLibrary library(planet, 64 << 20);
//   const auto scene = library.scene("gale.scene.toml", settings.exaggeration, time_s);
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "objects/files/scene_file.h"
#include "objects/scene/place.h"
#include "objects/scene/scene.h"
#include "paging/surface/surface.h"
#include "vpe/app/scene/kiosk_places.h"
#include "vpe/app/scene/placed_parts.h"
#include "vpe/app/scene/poster_images.h"
#include "vpe/base/file.h"
#include "vpe/core/interest.h"
#include "vpe/core/object_track.h"

namespace vpe::app {

// Holds a scene at one time.
struct PlacedScene {
  std::shared_ptr<const objects::Scene> scene;  // all but what is cut out of the ground
  std::vector<core::InterestRegion> interest;   // around objects that ask for finer ground
  bool moves = false;                           // other times may have objects elsewhere
  // The same without what is added to the ground, for images that draw the parts of the ground.
  std::shared_ptr<const objects::Scene> apart;
  std::shared_ptr<const PlacedParts> parts;  // of the ground; null: none
  std::shared_ptr<const core::GroundParts>
      ground_parts;  // the same; the same pointer as long as they are the same
  // Images in the world; null: none.
  std::shared_ptr<const std::vector<objects::PlacedPoster>> posters;
};

// Returns the name of an instance, or that of its model if it has none; never "".
std::string object_name(const objects::Scene& scene, std::uint32_t instance);

// Belongs to one thread at a time. Does not depend on what was asked before.
class SceneLibrary {
 public:
  // `surface` must outlive this.
  explicit SceneLibrary(const paging::Surface& surface) : surface_(surface) {}

  // Returns the objects of a scene file on ground with this exaggeration at a time of the flight, which may move some
  // (tracks; null: none). Reads the file, and the models that it names, when they are new or have changed. Throws what
  // read_scene_file(), read_model_file(), scatter() and track_target() throw, and paging::PlanetError.
  PlacedScene scene(const std::string& file, double exaggeration, double time_s,
                    const std::vector<core::ObjectTrack>* tracks = nullptr);

  // Returns what readers of models have ignored since the last call, a line each.
  std::vector<std::string> take_notes();
  std::size_t bytes() const;

 private:
  struct KnownModel {
    // The file and those that it consists of.
    std::vector<std::pair<std::filesystem::path, std::optional<base::FileStamp>>> files;
    double unit_m = 1;
    objects::UpAxis up = objects::UpAxis::kAuto;
    std::shared_ptr<const objects::Model> model;
  };
  struct KnownVolume {
    objects::VolumeFormula formula;
    std::shared_ptr<const objects::Model> model;
  };
  // The first instance and the first region of interest of an entry of objects.
  struct Begin {
    std::size_t instance = 0;
    std::size_t interest = 0;
  };
  // Objects that stand still, on ground of one exaggeration.
  struct Standing {
    double exaggeration = 1;
    std::vector<objects::Instance> instances;
    std::vector<objects::Instance> added;  // to the ground
    std::shared_ptr<const PlacedParts> parts;
    std::shared_ptr<const core::GroundParts> ground_parts;
    std::vector<core::InterestRegion> interest;
    std::vector<Begin> begins;  // of SceneFile::objects
    std::shared_ptr<const std::vector<objects::PlacedPoster>> posters;
    std::shared_ptr<const objects::Scene> scene;  // null where others move
    std::shared_ptr<const objects::Scene> apart;
  };

  void read(const std::string& file);
  std::shared_ptr<const objects::Model> model(const objects::ModelEntry& entry);
  std::shared_ptr<const objects::Model> volume(const std::string& name, const objects::VolumeFormula& formula);
  objects::GroundRadius ground(double exaggeration) const;
  std::uint32_t name_index(const std::string& name);
  // Reads kiosks and their model where that is new.
  void read_kiosks(bool is_known, objects::Scene::Models& models);
  void place_standing(double exaggeration);
  // Returns the scene of instances, and with what is added to the ground.
  PlacedScene with_parts(std::vector<objects::Instance> instances,
                         std::vector<core::InterestRegion> interest) const;
  // Moves what a track names, or hides it: an instance by adding its number to `hidden`, a path by taking its points.
  void move(const core::ObjectTrack& track, double time_s, double exaggeration,
            std::vector<objects::PathEntry>& paths, std::vector<objects::Instance>& instances,
            std::vector<std::size_t>& hidden, std::vector<core::InterestRegion>& interest) const;

  const paging::Surface& surface_;
  std::optional<base::FileStamp> stamp_;
  std::string file_;
  objects::SceneFile entries_;
  objects::Scene::Models models_;
  std::vector<std::string> names_{""};
  std::map<std::filesystem::path, KnownModel> known_;
  std::map<std::string, KnownVolume> volumes_;  // by formula, by name
  std::shared_ptr<const objects::Model> kiosk_;
  std::vector<KioskPlace> kiosks_;
  std::vector<std::pair<std::filesystem::path, std::optional<base::FileStamp>>> hotspots_;
  PosterImages images_;
  std::optional<Standing> standing_;
  std::vector<std::string> notes_;
};

}  // namespace vpe::app
