// Results of paths: profiles and lines of sight as JSON, features and text. All functions are pure.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "mars/vector/feature_writer.h"
#include "vpe/explore/measure/line_of_sight.h"
#include "vpe/explore/measure/profile.h"
#include "vpe/explore/results/ground_along.h"

namespace vpe::explore {

// Returns what `vpe profile --json` prints: the figures of the path, ground_json(), and an object for each point. Slopes of
// `limits_deg` are in rising order; a point has the largest one that the facet there exceeds, "steeper_than_deg". Without
// limits it has none.
nlohmann::json profile_json(const Profile& profile, const GroundAlong& ground, const paging::PlanetMeta& meta,
                            std::span<const double> limits_deg = {});

// Returns a line, "path", with the figures of the path, and the points of the profile, "point", with theirs.
// `places` are those that the path goes through.
mars::FeatureLayer profile_layer(const nlohmann::json& profile, std::span<const mars::LonLat> places);

// Returns how many of the limits, in rising order, the facet at a point exceeds; 0 at nodata.
int steepness(const paging::ProfilePoint& point, std::span<const double> limits_deg);

// Returns what `vpe sight --json` prints.
nlohmann::json sight_json(const LineOfSight& sight, const SightPoint& from, const SightPoint& to,
                          const GroundAlong& ground, const paging::PlanetMeta& meta);

// Returns a line, "line", with all figures, and points: "from", "to", "clearance" where the line is nearest to the ground,
// and "obstacle" where there is one.
mars::FeatureLayer sight_layer(const nlohmann::json& sight);

// Returns what a file says about itself: which command's figures these are, the datum, and what attributes mean.
// `command` is its name and what it has measured, as "profile: the ground along great circles".
mars::FeatureFileInfo result_info(const std::string& command, const paging::PlanetMeta& meta);

// Returns lines of labels and values as one text, a line each.
std::string text_of_lines(std::span<const ReadOutLine> lines);

}  // namespace vpe::explore
