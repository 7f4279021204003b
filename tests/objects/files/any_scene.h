// Scenes of any kind, for properties of what reads and writes them.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "objects/files/scene_file.h"
#include "objects/files/scene_limits.h"

namespace objects::test {

// Makes scenes of all kinds of entries, numbers and texts that a file may have.
class AnyScene {
 public:
  explicit AnyScene(unsigned seed) : random_(seed) {}

  SceneFile make() {
    SceneFile scene;
    scene.path = "/scenes/a.scene.toml";
    const auto files = static_cast<std::size_t>(below(4) + 1);
    const auto models = files + static_cast<std::size_t>(below(3));
    for (std::size_t n = 0; n < files; ++n) {
      scene.models.push_back({name() + std::to_string(n), std::filesystem::path(folder()) / (name() + ".glb"),
                              number(kUnitRange_m), static_cast<UpAxis>(below(3))});
    }
    // Volumes are read after the models.
    for (std::size_t n = files; n < models; ++n) {
      ModelEntry volume;
      volume.name = name() + std::to_string(n);
      VolumeFormula formula;
      do {
        formula = {static_cast<VolumeKind>(below(3)), number({1, 100}), number({1, 40}), number({0.1, 50})};
        if (formula.kind != VolumeKind::kCloud) formula.lean_m = number({0, 40});
      } while (!check(formula).empty());
      formula.colour = {static_cast<std::uint8_t>(below(256)), static_cast<std::uint8_t>(below(256)),
                        static_cast<std::uint8_t>(below(256)), 255};
      formula.seed = static_cast<std::uint64_t>(below(1'000'000));
      formula.voxels = 16 + below(241);
      volume.formula = formula;
      scene.models.push_back(volume);
    }
    const auto any_model = [&] { return static_cast<std::size_t>(below(static_cast<int>(models))); };
    for (int n = below(5); n > 0; --n) {
      const Placing like = placing();
      ObjectEntry object{maybe_name(), any_model(), {}, number(kInterestRange)};
      for (int k = below(3); k >= 0; --k) {
        object.places.push_back(like);
        object.places.back().place = place();
        object.places.back().heading_deg = number(kAngleRange_deg);
      }
      object.ground.kind = static_cast<GroundRole::Kind>(below(3));
      if (object.ground.kind != GroundRole::Kind::kNone && below(2) == 0) {
        object.ground.voxel_m = number(kGroundVoxelRange_m);
        if (object.model >= files) object.ground.solid_above_per_m = number(kExtinctionRange_per_m);
      }
      scene.objects.push_back(object);
    }
    for (int n = below(3); n > 0; --n) {
      PathEntry path{maybe_name(), any_model(), {}, number(kScaleRange)};
      if (below(2) == 0) {
        path.wheelbase_m = number(kWheelRange_m);
        path.track_m = number(kWheelRange_m);
      }
      double time_s = number({-1e6, 1e6});
      for (int k = below(3); k >= 0; --k) {
        path.points.push_back({time_s, place(), std::nullopt});
        if (below(2) == 0) path.points.back().heading_deg = number(kAngleRange_deg);
        if (below(2) == 0) path.points.back().height_m = number({-10, 1000});
        time_s += number({0.5, 1e6});
      }
      scene.paths.push_back(path);
    }
    for (int n = below(3); n > 0; --n) {
      ScatterEntry scatter;
      scatter.name = maybe_name();
      for (int k = below(3); k >= 0; --k) scatter.models.push_back(any_model());
      for (int k = below(4); k >= -2; --k) scatter.polygon.push_back(place());
      scatter.seed = random_() >> 1U;
      if (below(2) == 0)
        scatter.distribution = PowerLaw{number(kDensityRange_per_m2), number(kExponentRange)};
      else
        scatter.distribution = RockAbundance{number(kAbundanceRange)};
      scatter.least_diameter_m = number({0.001, 10});
      scatter.most_diameter_m = number({20, 1e5});
      scatter.buried = number(kShareRange);
      scatter.follows_slope = below(2) == 0;
      scatter.tumbles = below(2) == 0;
      scatter.most = static_cast<std::size_t>(below(1000));
      scene.scatters.push_back(scatter);
    }
    for (int n = below(6); n > 0; --n) scene.posters.push_back(poster());
    for (int n = below(3); n > 0; --n) scene.kiosks.push_back(kiosk());
    return scene;
  }

 private:
  int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }

  double number(const NumberRange& range) {
    switch (below(4)) {
      case 0:  // whole
        return std::clamp(std::floor(std::uniform_real_distribution<double>(-100, 100)(random_)),
                          range.is_open ? 1.0 : range.least, range.most);
      case 1:  // small
        return std::clamp(std::ldexp(std::uniform_real_distribution<double>(1, 2)(random_), -30 - below(40)),
                          range.least, range.most);
      case 2:
        if (!range.is_open && range.least <= 0) return below(2) == 0 ? -0.0 : 0.0;
        [[fallthrough]];
      default:
        return std::uniform_real_distribution<double>(std::nextafter(range.least, range.most),
                                                      range.most)(random_);
    }
  }

  mars::LonLat place() { return {mars::normalize_lon_deg(number({-180, 180})), number(kLatRange_deg)}; }

  Placing placing() {
    Placing placing;
    placing.height_kind = static_cast<HeightKind>(below(2));
    placing.height_m = number(kHeightRange_m);
    placing.pitch_deg = number(kAngleRange_deg);
    placing.roll_deg = number(kAngleRange_deg);
    placing.follows_slope = below(2) == 0;
    placing.scale = number(kScaleRange);
    return placing;
  }

  // Members that belong to other forms of an image keep their usual values, for no file holds them.
  PosterEntry poster() {
    PosterEntry poster;
    poster.name = maybe_name();
    poster.file = std::filesystem::path(folder()) / (name() + ".png");
    poster.form = static_cast<PosterForm>(below(4));
    poster.opacity = number(kShareRange);
    if (poster.form != PosterForm::kDome || below(3) > 0) {
      poster.place = place();
      poster.height_kind = static_cast<HeightKind>(below(2));
      poster.height_m = number(kHeightRange_m);
    }
    switch (poster.form) {
      case PosterForm::kPane:
        poster.heading_deg = number(kAngleRange_deg);
        poster.pitch_deg = number(kTiltRange_deg);
        [[fallthrough]];
      case PosterForm::kBillboard:
        poster.width_m = number(kPosterSizeRange_m);
        if (below(2) == 0) poster.tall_m = number(kPosterSizeRange_m);
        break;
      case PosterForm::kPhotograph:
        poster.heading_deg = number(kAngleRange_deg);
        poster.pitch_deg = number(kAngleRange_deg);
        poster.roll_deg = number(kAngleRange_deg);
        poster.fov_deg = number(kPosterFovRange_deg);
        poster.distance_m = number(kPosterSizeRange_m);
        break;
      case PosterForm::kDome:
        poster.radius_m = number(kPosterSizeRange_m);
        poster.fade_m = number({kPosterSizeRange_m.least, poster.radius_m});
        poster.is_cylinder = below(2) == 0;
        poster.heading_deg = number(kAngleRange_deg);
        poster.replaces_ground = below(2) == 0;
        break;
    }
    return poster;
  }

  KioskEntry kiosk() {
    KioskEntry kiosk;
    kiosk.size_m = number(kPosterSizeRange_m);
    if (below(2) == 0) {
      kiosk.hotspots = std::filesystem::path(folder()) / (name() + ".txt");
      kiosk.beside_m = number(kLeanRange_m);
      return kiosk;
    }
    kiosk.name = maybe_name();
    kiosk.place = place();
    kiosk.heading_deg = number(kAngleRange_deg);
    if (below(2) == 0) kiosk.panorama = std::filesystem::path(folder()) / (name() + ".json");
    return kiosk;
  }

  std::string name() {
    static const std::vector<std::string> kParts{"a",   "\"",     "'", "\\",   "#", "=", "[", "]",     " ",
                                                 "'''", "\"\"\"", "ä", "火星", "{", ",", ".", "u0041", "\\n"};
    std::string text = "n";
    for (int n = below(8); n > 0; --n)
      text += kParts[static_cast<std::size_t>(below(static_cast<int>(kParts.size())))];
    return text;
  }
  std::string maybe_name() { return below(3) == 0 ? "" : name(); }
  std::string folder() {
    static const std::vector<std::string> kFolders{"/scenes", "/scenes/models", "/", "/other/place"};
    return kFolders[static_cast<std::size_t>(below(static_cast<int>(kFolders.size())))];
  }

  std::mt19937_64 random_;
};

}  // namespace objects::test
