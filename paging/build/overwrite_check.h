// Comparison of a finished planet file with what a build or merge would write over it.
#pragma once

#include <string>
#include <vector>

#include "paging/build/builder.h"
#include "paging/plan/build_plan.h"

namespace paging {

// Describes what a build or merge will make, as far as it is known before.
struct PlannedContent {
  PlanetMeta meta;                   // as describe_planet() returns it; `shard` is set for a shard
  std::vector<std::int64_t> leaves;  // packed keys of finest tiles, sorted
  std::vector<std::int64_t> images;  // packed keys of image tiles, sorted
};

// Returns the content of a build. `image` may be null. Reads the source thinned out, as describe_planet() does.
PlannedContent planned_content(const BuildOptions& options, const BuildPlan& plan,
                               const mars::ElevationSource& elevation, const mars::ImageSource* image);
// Returns the content of a merge of these shards. Throws PlanetError for a file that is no shard or damaged.
PlannedContent planned_content(const std::vector<std::string>& shards);

// Returns in what the planet file or shard at `path` differs from the planned content: one text each; empty
// when both have the same sources and tiles, or the file is too damaged to be of use. Versions of the program
// are not compared. Throws DatabaseError if the file cannot be read.
std::vector<std::string> differences(const std::string& path, const PlannedContent& planned);

}  // namespace paging
