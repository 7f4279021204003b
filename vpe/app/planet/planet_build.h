// Builds and merges planet files with messages for the user: estimate, progress, what an earlier build left,
// how to continue, and a summary.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mars/sources/combine.h"
#include "paging/build/builder.h"
#include "paging/build/estimate.h"
#include "paging/build/merge.h"
#include "paging/build/overwrite_check.h"
#include "vpe/app/cli/program.h"
#include "vpe/base/shard.h"

namespace vpe::app {

// Posts on which the resampling error of a planet with synthetic sources is measured. They are sampled one place at a time;
// so many give an error that is stable to a few per cent.
inline constexpr std::size_t kSyntheticResamplingPosts = 100'000;

// Sets the memory of rasters to their share of --memory. Call it before a raster is opened: opening reads some.
void limit_rasters(const Common& common);

// Runs paging::build_planet(), or paging::patch_planet() where `patched` is given, with progress on stderr, after the notes of the image sources. SIGINT and SIGTERM end it with Interrupted. After that,
// and after any error that leaves an incomplete file, a line on stderr says that the same command continues. A
// plan that was made before is not made again.
//
// Typical usage:
//   options.output = check_planet_file(options.output, inputs);
//   paging::BuildPlan plan = paging::plan_tiles(options, elevation);
//   print_estimate(paging::estimate_build(options, plan, elevation, image), common);
//   print_build(run_build(options, elevation, image, common, std::move(plan)), options.output, common);
paging::BuildSummary run_build(paging::BuildOptions options, const mars::ElevationSource& elevation,
                               const mars::ImageSource* image, const Common& common,
                               std::optional<paging::BuildPlan> plan = {},
                               const paging::PatchedPlanet* patched = nullptr);

// Runs paging::merge_shards() in the same way.
paging::BuildSummary run_merge(const paging::MergeOptions& options, const Common& common);

// Prints the estimate of a build that follows, on stderr.
void print_estimate(const paging::BuildEstimate& estimate, const Common& common);
// Prints the estimate as the command's result, on stdout, as text or JSON.
void print_estimate_only(const paging::BuildEstimate& estimate, const Common& common);

// Checks the output before hours of work, and returns the file that it names through symbolic links. Throws
// what check_outputs() throws.
std::string check_planet_file(const std::string& output, const std::vector<std::string>& inputs);

// Throws std::runtime_error that names the differences if a finished planet file at `output` has other sources
// or tiles than the one to be made, and --force is the advice.
void require_same_content(const std::string& output, const paging::PlannedContent& planned);

// Returns the name of a part's file: "mars.vpe" becomes "mars.03-of-16.vpe", so that names sort like parts. The
// name is unchanged where there is only one part.
std::string shard_file_name(const std::string& output, const base::Shard& shard);

// Prints the summary on stdout: as text, or as JSON, then with the findings about the sources (`combined` may
// be null). Prints nothing when quiet, unless as JSON.
void print_build(const paging::BuildSummary& summary, const std::string& output, const Common& common,
                 const mars::Combined* combined = nullptr);

}  // namespace vpe::app
