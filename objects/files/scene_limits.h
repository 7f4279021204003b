// Says what values scene files may have, and how messages name them. Shared by the readers of TOML and GeoJSON.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vpe/base/number_range.h"

namespace objects {

using vpe::base::is_within;
using vpe::base::NumberRange;
using vpe::base::range_text;

inline constexpr NumberRange kLonRange_deg{-360, 360};
inline constexpr NumberRange kLatRange_deg{-90, 90};
inline constexpr NumberRange kAngleRange_deg{-360, 360};
inline constexpr NumberRange kHeightRange_m{-1e6, 1e9};
inline constexpr NumberRange kScaleRange{0, 1e6, true};
inline constexpr NumberRange kUnitRange_m{0, 1e6, true};
inline constexpr NumberRange kInterestRange{0, 16};
inline constexpr NumberRange kTimeRange_s{-1e12, 1e12};
inline constexpr NumberRange kWheelRange_m{0, 1e4, true};
inline constexpr NumberRange kShareRange{0, 1};
inline constexpr NumberRange kDensityRange_per_m2{0, 1e6, true};
inline constexpr NumberRange kExponentRange{0, 20};
inline constexpr NumberRange kAbundanceRange{0.001, 1};
inline constexpr NumberRange kDiameterRange_m{0.001, 1e5};
inline constexpr NumberRange kVolumeSizeRange_m{0.01, 1e6};
inline constexpr NumberRange kLeanRange_m{0, 1e6};
inline constexpr NumberRange kOpticalDepthRange{0, 100, true};
inline constexpr NumberRange kChannelRange{0, 255};
inline constexpr NumberRange kGroundVoxelRange_m{0.001, 1e5};
inline constexpr NumberRange kExtinctionRange_per_m{0, 1e6, true};
inline constexpr NumberRange kPosterSizeRange_m{0.01, 1e7};
inline constexpr NumberRange kPosterFovRange_deg{0.001, 179};
inline constexpr NumberRange kTiltRange_deg{-90, 90};

// Returns what is wrong with a name, or with the path of a model file; "" if nothing is.
std::string problem_of_name(std::string_view name);
std::string problem_of_path(std::string_view path);

// Returns the path of a model file that a scene file names.
std::filesystem::path model_path(const std::filesystem::path& scene_file, const std::string& text);

// Returns the message that there are too many instances.
std::string too_many_instances();

// Returns what makes a text too costly to parse: values without end. "" if nothing does.
std::string problem_of_size(std::string_view text);

}  // namespace objects
