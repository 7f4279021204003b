// Building a planet file as users see it: progress, what is continued, what to do when it stops, what came out.
#pragma once

#include <string>
#include <vector>

#include "mars/sources/combine.h"
#include "paging/build/builder.h"
#include "paging/build/estimate.h"
#include "paging/build/merge.h"
#include "vpe/app/cli/program.h"
#include "vpe/base/shard.h"

namespace vpe::app {

// paging::build_planet with progress on stderr. SIGINT and SIGTERM end it with Interrupted; then, and on every
// error after the first tile, a line on stderr says that the same command continues.
paging::BuildSummary run_build(paging::BuildOptions options, const mars::ElevationSource& elevation,
                               const mars::ImageSource* image, const Common& common);

// What the build will take: on stderr, for a build that follows, or as the command's result on stdout, text or
// JSON.
void say_estimate(const paging::BuildEstimate& estimate, const Common& common);
void report_estimate(const paging::BuildEstimate& estimate, const Common& common);

// paging::merge_parts, likewise.
paging::BuildSummary run_merge(const paging::MergeOptions& options, const Common& common);

// What a build would destroy or could not write, said before hours of work. Throws UsageError when `output` is
// one of the inputs, std::runtime_error when it cannot be written or is there and no planet file.
void check_planet_file(const std::string& output, const std::vector<std::string>& inputs);

// "mars.vpe" -> "mars.03-of-16.vpe", so that names sort as parts do; unchanged where there is one part.
std::string part_file_name(const std::string& output, const base::Shard& part);

// The summary on stdout: text, or JSON with --json, then with what was found out of the sources; nothing with
// --quiet. combined may be null.
void report_build(const paging::BuildSummary& summary, const std::string& output, const Common& common,
                  const mars::Combined* combined = nullptr);

}  // namespace vpe::app
