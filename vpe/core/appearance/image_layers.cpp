#include "vpe/core/appearance/image_layers.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "vpe/base/number.h"

namespace vpe::core {
namespace {

struct Value {
  std::string_view key;
  double ImageLayerLook::*member;
  double least;
  double most;
};
constexpr Value kValues[] = {{"low", &ImageLayerLook::low, 0, 255},
                             {"high", &ImageLayerLook::high, 0, 255},
                             {"gamma", &ImageLayerLook::gamma, 0.1, 10}};

double number_within(std::string_view what, std::string_view text, double least, double most) {
  const std::optional<double> value = base::parse_number(text);
  if (!value || !(*value >= least && *value <= most)) {
    throw std::invalid_argument(std::string(what) + " '" + std::string(text) + "' must be a number within " +
                                base::format_number(least) + " to " + base::format_number(most));
  }
  return *value;
}

// Takes " key=value" from the end of `text`, if it is there.
bool take_value(std::string_view& text, ImageLayerLook& look) {
  const std::size_t space = text.rfind(' ');
  if (space == std::string_view::npos) return false;
  const std::string_view word = text.substr(space + 1);
  for (const Value& value : kValues) {
    if (!word.starts_with(value.key) || word.substr(value.key.size(), 1) != "=") continue;
    look.*value.member = number_within(value.key, word.substr(value.key.size() + 1), value.least, value.most);
    text = text.substr(0, space);
    return true;
  }
  return false;
}

ImageLayerLook parse_look(std::string_view text) {
  ImageLayerLook look;
  while (take_value(text, look)) {
  }
  const std::size_t at = text.rfind('@');
  if (at != std::string_view::npos && base::parse_number(text.substr(at + 1))) {
    look.opacity = number_within("opacity", text.substr(at + 1), 0, 1);
    text = text.substr(0, at);
  }
  look.name = text;
  if (look.name.empty())
    throw std::invalid_argument("a name is empty; expected NAME or NAME@OPACITY, with ';' between them");
  return look;
}

}  // namespace

std::vector<ImageLayerLook> parse_image_layers(std::string_view text) {
  std::vector<ImageLayerLook> layers;
  while (!text.empty()) {
    const std::size_t end = text.find(';');
    ImageLayerLook look = parse_look(text.substr(0, end));
    if (std::ranges::find(layers, look.name, &ImageLayerLook::name) != layers.end())
      throw std::invalid_argument("the layer '" + look.name + "' stands twice");
    layers.push_back(std::move(look));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
    if (text.empty()) throw std::invalid_argument("a name is empty: leave out the ';' at the end");
  }
  return layers;
}

std::string image_layers_text(const std::vector<ImageLayerLook>& layers) {
  static const ImageLayerLook kUsual;
  std::string text;
  for (const ImageLayerLook& look : layers) {
    text += (text.empty() ? "" : ";") + look.name;
    if (look.opacity != 1) text += "@" + base::format_number(look.opacity);
    for (const Value& value : kValues) {
      if (look.*value.member != kUsual.*value.member)
        text += " " + std::string(value.key) + "=" + base::format_number(look.*value.member);
    }
  }
  return text;
}

std::string image_layers_problem(const std::string& text) {
  try {
    parse_image_layers(text);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return {};
}

}  // namespace vpe::core
