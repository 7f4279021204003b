// Files of results that a user saves: the name's extension says the format.
#pragma once

#include <filesystem>
#include <string>

#include "mars/vector/feature_writer.h"

namespace vpe::explore {

// Returns the attributes of a layer as CSV (RFC 4180): a line of their names, then a line for each feature. Pure.
std::string csv_of_layer(const mars::FeatureLayer& layer);

// Writes a layer as .geojson, .json or .gpkg, and `csv` as .csv; other extensions are refused with what is possible. Replaces
// a file that exists. Throws std::runtime_error with the file, what is wrong and what to do.
void write_result(const std::filesystem::path& file, const mars::FeatureLayer& layer,
                  const mars::FeatureFileInfo& info, const std::string& csv);

}  // namespace vpe::explore
