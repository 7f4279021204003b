#include "vpe/core/appearance/light_choice.h"

namespace vpe::core {

void resolve_light(Appearance& appearance, bool imagery_has_own_light) {
  if (appearance.light != Light::kAuto) return;
  const bool shows_imagery = appearance.mode == Mode::kTextured ||
                             (appearance.mode == Mode::kColoured && appearance.colour == Colour::kImage);
  appearance.light = shows_imagery && imagery_has_own_light ? Light::kOff : Light::kOn;
}

bool is_lit_by_sun(const Appearance& appearance) { return appearance.light != Light::kOff; }

}  // namespace vpe::core
