// The files and JSON objects that `vpe horizon` writes.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "panorama/horizon/landmarks.h"
#include "panorama/horizon/skyline.h"
#include "panorama/horizon/stellarium.h"
#include "vpe/app/cli/output.h"

namespace vpe::app {

// Returns CSV with the columns azimuth_deg,elevation_deg,range_m,lon_deg,lat_deg,elevation_m, and, where there are names
// of objects ("" where the skyline is ground; one for each point), object.
std::string skyline_csv(std::span<const panorama::GroundPoint> skyline,
                        std::span<const std::string> objects = {});

// Returns CSV with the columns name,lon_deg,lat_deg,diameter_km,azimuth_deg,elevation_deg,range_m,elevation_m,
// visible, and for hidden ones hidden_by_lon_deg,hidden_by_lat_deg,hidden_by_range_m,hidden_by_elevation_m,
// hidden_by_name.
std::string landmarks_csv(std::span<const panorama::Landmark> landmarks);

nlohmann::json point_json(const panorama::GroundPoint& point);
nlohmann::json landmark_json(const panorama::Landmark& landmark);

// Returns what write_landscape() writes, to be checked before the work.
std::vector<Output> landscape_files(const std::filesystem::path& folder);
// Writes the files of a Stellarium landscape, each complete or not at all, landscape.ini last.
void write_landscape(const std::filesystem::path& folder, const panorama::StellariumPlace& place,
                     std::span<const panorama::GroundPoint> skyline);

}  // namespace vpe::app
