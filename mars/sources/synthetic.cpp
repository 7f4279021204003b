#include "mars/sources/synthetic.h"

namespace mars {

namespace {

std::string names_of(std::span<const SourceInfo> sources, bool synthetic) {
  std::string names;
  for (const SourceInfo& source : sources)
    if (source.illustration == synthetic) names += (names.empty() ? "" : " and ") + source.name;
  return names;
}

}  // namespace

std::string synthetic_statement(std::span<const SourceInfo> sources) {
  const std::string made_up = names_of(sources, true);
  if (made_up.empty()) return {};
  const std::string data = names_of(sources, false);
  if (data.empty()) return "The elevations are synthetic (" + made_up + "), not data.";
  return "Elevations are those of " + data + "; ground smaller than their posts is synthetic (" + made_up +
         "), not data.";
}

}  // namespace mars
