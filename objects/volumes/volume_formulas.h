// Dust devils, clouds and plumes by formula.
//
// Typical usage:
//   VolumeFormula devil;
//   devil.height_m = 120;
//   const VolumeModel model = volume_by_formula(devil);
#pragma once

#include <cstdint>
#include <string>

#include "objects/volumes/volume_model.h"

namespace objects {

enum class VolumeKind : std::uint8_t {
  kDustDevil,  // a hollow column that widens upwards, with a skirt of dust at its foot
  kCloud,      // an ellipsoid with ragged sides and a flatter base
  kPlume,      // dust or smoke that rises, widens and is bent forward by the wind
};

// Describes a volume. It stands on the origin of the model frame. Dust devils and plumes reach down to a tenth of their
// height below it, so that no gap is left on slopes.
struct VolumeFormula {
  VolumeKind kind = VolumeKind::kDustDevil;
  double height_m = 100;  // from the origin to the top
  double radius_m = 15;   // the largest one: of the top, of the cloud across
  double optical_depth =
      1;  // of rays through the middle: level ones of dust devils and plumes, upright ones of clouds
  double lean_m = 0;                // by which the top lies forward of the foot; 0 for clouds
  Rgba colour{205, 165, 125, 255};  // in full light, sRGB
  std::uint64_t seed = 1;
  int voxels = 128;  // along the longest side

  bool operator==(const VolumeFormula&) const = default;
};

// Gives the limits of a formula.
struct VolumeFormulaLimits {
  static constexpr double kLeastSize_m = 0.01;  // of height and radius
  static constexpr double kMostSize_m = 1e6;
  static constexpr double kMostProportion = 50;     // of height, twice the radius and lean to each other
  static constexpr double kMostOpticalDepth = 100;  // more than 0
  static constexpr int kLeastVoxels = 16;
  static constexpr int kMostVoxels = 256;
};

// Returns "" if a volume can be made, else which number is out of range. Pure.
std::string check(const VolumeFormula& formula);

// Returns the field of a formula. The mean optical depth of rays through the middle, between three and seven tenths of the
// height (of a cloud: within three tenths of the radius), is that of the formula within 5 %. The same for the same formula.
// Throws std::invalid_argument with what check() says. Pure; works on all cores.
VolumeLevel level_by_formula(const VolumeFormula& formula);
VolumeModel volume_by_formula(const VolumeFormula& formula);

}  // namespace objects
