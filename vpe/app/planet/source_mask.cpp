#include "vpe/app/planet/source_mask.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "mars/sources/adjusted.h"
#include "paging/build/source_content.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

namespace {

constexpr std::size_t kSearchedPosts = 1'000'000;
constexpr double kLeastMask = 0.5;

bool has_data(const mars::ElevationSource& source) {
  bool found = false;
  source.visit_posts(kSearchedPosts, [&](std::span<const glm::dvec3>, std::span<const double> heights_m) {
    found = found || std::ranges::any_of(heights_m, [](double h) { return std::isfinite(h); });
  });
  return found;
}

std::shared_ptr<const mars::ElevationSource> masked(const std::shared_ptr<const mars::ElevationSource>& source,
                                                    const std::string& file) {
  const std::string name = source->infos().front().name;
  const auto mask = mars::open_elevation(file);
  const mars::PostMask leave_out = [mask](std::span<const glm::dvec3> directions, std::span<double> heights_m) {
    std::vector<double> values(directions.size());
    mask->sample(directions, 0, values);
    for (std::size_t n = 0; n < values.size(); ++n)
      if (!(values[n] >= kLeastMask)) heights_m[n] = std::numeric_limits<double>::quiet_NaN();
  };
  const auto* maskable = dynamic_cast<const mars::Maskable*>(source.get());
  const std::string content = paging::content_of(mask->infos().front());
  const std::string treatment = "posts left out where " + std::filesystem::path(file).filename().string() +
                                " is below 0.5" + (content.empty() ? "" : ", content " + content);
  std::shared_ptr<const mars::ElevationSource> result =
      maskable != nullptr ? maskable->with_mask(leave_out, 0, treatment) : nullptr;
  if (result == nullptr)
    throw mars::SourceError(name + ": cannot be masked by " + file + ": it is no raster with posts of its own");
  if (!has_data(*result)) {
    throw mars::SourceError(file + ": as a mask it leaves no post of " + name +
                            "; it must lie over it and be 1 where posts are wanted");
  }
  return result;
}

}  // namespace

NamedValue named_value(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos) return {"", text};
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::vector<std::size_t> named_sources(const std::vector<std::shared_ptr<const mars::ElevationSource>>& sources,
                                       const std::string& name) {
  std::vector<std::size_t> by_path;
  std::vector<std::size_t> by_file;
  for (std::size_t n = 0; n < sources.size(); ++n) {
    const std::string path = sources[n]->infos().front().name;
    if (path == name) by_path.push_back(n);
    if (std::filesystem::path(path).filename().string() == name) by_file.push_back(n);
  }
  return by_path.empty() ? by_file : by_path;
}

void apply_masks(const std::vector<std::string>& masks,
                 std::vector<std::shared_ptr<const mars::ElevationSource>>& sources) {
  for (const std::string& text : masks) {
    if (text.find('=') == std::string::npos) throw UsageError("--mask " + text + ": expected NAME=RASTER");
    // Both names may have equals signs.
    std::vector<std::size_t> found;
    std::size_t equals = 0;
    while (found.empty() && (equals = text.find('=', equals)) != std::string::npos)
      found = named_sources(sources, text.substr(0, equals++));
    if (found.empty()) {
      throw UsageError("--mask " + text + ": no raster is called '" + text.substr(0, text.find('=')) + "'");
    }
    std::shared_ptr<const mars::ElevationSource>& source = sources[found.front()];
    source = masked(source, text.substr(equals));
  }
}

}  // namespace vpe::app
