#include "vpe/app/planet/layer_names.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "mars/sources/colour_match.h"
#include "mars/sources/stack_walk.h"
#include "vpe/app/cli/program.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/image_layers.h"

namespace vpe::app {

namespace {

constexpr const char* kStem = "stem";

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(';', begin);
    names.push_back(text.substr(begin, end - begin));
    if (end == std::string::npos) return names;
    begin = end + 1;
  }
}

// Returns true if the setting image.layers can hold the name.
bool is_layer_name(const std::string& name) {
  core::ImageLayerLook look;
  look.name = name;
  try {
    return core::parse_image_layers(core::image_layers_text({look})) == std::vector<core::ImageLayerLook>{look};
  } catch (const std::invalid_argument&) {
    return false;
  }
}

std::string unused_name(const std::string& stem, const std::vector<std::string>& names) {
  std::string name = stem;
  for (int n = 2; std::ranges::count(names, name) > 0; ++n) name = stem + "-" + std::to_string(n);
  return name;
}

}  // namespace

std::vector<std::string> layer_names(const std::vector<std::string>& images, const std::string& images_apart) {
  std::vector<std::string> names;
  if (images_apart != kStem) names = split_names(images_apart);
  if (names.size() > images.size()) {
    throw UsageError("--images-apart '" + images_apart + "': " + std::to_string(names.size()) + " names for " +
                     std::to_string(images.size()) + " images");
  }
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (std::ranges::count(names, names[n]) > 1)
      throw UsageError("--images-apart '" + images_apart + "': the name '" + names[n] + "' stands twice");
  }
  for (std::size_t n = names.size(); n < images.size(); ++n)
    names.push_back(unused_name(std::filesystem::path(images[n]).stem().string(), names));
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (is_layer_name(names[n])) continue;
    throw UsageError("--images-apart: '" + names[n] + "' cannot name the layer of " + images[n] +
                     "; give names without ';' and values: --images-apart='NAME;NAME'");
  }
  return names;
}

std::vector<std::string> match_colours(std::vector<std::shared_ptr<const mars::ImageSource>>& images) {
  std::vector<std::string> notes;
  if (images.size() < 2) return notes;
  // Of equal ones the first lies above.
  const auto order = mars::by_resolution(images, mars::StackOptions());
  std::vector<std::shared_ptr<const mars::ImageSource>> below{order.back()};
  for (std::size_t s = order.size() - 1; s-- > 0;) {
    const std::string name = order[s]->infos().front().name;
    const auto stack = below.size() == 1 ? below.front() : mars::stack_images(below);
    const std::optional<mars::ColourMatch> match = mars::fit_colour_match(*order[s], *stack);
    auto matched = order[s];
    if (match) {
      matched = mars::with_colour_match(order[s], *match);
      *std::ranges::find(images, order[s]) = matched;
      notes.push_back(name + ": " + mars::to_string(*match) + "; the median difference there was " +
                      base::format_significant(match->difference_before, 3) + " of 255 and is now " +
                      base::format_significant(match->difference_after, 3) + " (" +
                      std::to_string(match->places) + " places)");
    } else {
      notes.push_back(name + ": its colours are not matched, as no imagery lies below it at enough places");
    }
    below.insert(below.begin(), matched);
  }
  return notes;
}

}  // namespace vpe::app
