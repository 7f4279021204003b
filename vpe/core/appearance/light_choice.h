// Whether the sun lights ground, as far as the planet's imagery decides it.
#pragma once

#include "vpe/core/appearance/appearance.h"

namespace vpe::core {

// Replaces Light::kAuto. It becomes kOff where the appearance shows imagery (mode=textured, or mode=coloured with
// colour=image) and `imagery_has_own_light`, which a planet without imagery has not; kOn otherwise. A second call changes
// nothing.
void resolve_light(Appearance& appearance, bool imagery_has_own_light);

// Returns true if the sun lights ground in the modes with light. It does for kAuto, which resolve_light() replaces before an
// image is drawn.
bool is_lit_by_sun(const Appearance& appearance);

}  // namespace vpe::core
