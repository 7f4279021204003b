#include "vpe/app/planet_build.h"

#include <cstdio>
#include <filesystem>

#include "vpe/app/interrupt.h"
#include "vpe/app/progress.h"

namespace vpe::app {

namespace {

void say_what_is_kept(const paging::BuildOptions& options, const paging::BuildProgress& p) {
  const std::string part = options.output + ".part";
  if (p.replaced) {
    std::fprintf(stderr, "vpe: %s was of other sources or options, or damaged; starting anew\n", part.c_str());
  } else if (p.kept > 0) {
    std::fprintf(stderr, "Continuing %s\n", part.c_str());
  }
}

}  // namespace

paging::BuildSummary run_build(paging::BuildOptions options, const mars::ElevationSource& elevation,
                               const mars::ImageSource* image, const Common& common) {
  const InterruptGuard guard;
  // An analytic source is sampled one place at a time for the resampling error: enough for a figure that is
  // stable to a few per cent.
  const auto infos = elevation.infos();
  if (!infos.empty() && infos.front().illustration) options.resampling_posts = 100'000;
  try {
    ProgressLine line(common.quiet);
    bool first = true;
    return paging::build_planet(options, elevation, image, [&](const paging::BuildProgress& p) {
      InterruptGuard::check();
      if (first && !common.quiet) say_what_is_kept(options, p);
      first = false;
      line.show(std::string("building (") + p.stage + ")", p.fraction);
    });
  } catch (const std::exception&) {
    std::error_code none;
    if (std::filesystem::exists(options.output + ".part", none)) {
      std::fprintf(stderr, "vpe: what is built stays in %s.part; the same command continues it\n",
                   options.output.c_str());
    }
    throw;
  }
}

}  // namespace vpe::app
