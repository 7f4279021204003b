#include "paging/shading/terrain_shader.h"

namespace paging {

namespace {

Surfacing surfacing_of(vpe::core::Colour colour, bool has_image) {
  switch (colour) {
    case vpe::core::Colour::kElevation: return Surfacing::kElevation;
    case vpe::core::Colour::kSlope: return Surfacing::kSlope;
    case vpe::core::Colour::kAspect: return Surfacing::kAspect;
    case vpe::core::Colour::kImage: return has_image ? Surfacing::kImageAtPosts : Surfacing::kPlain;
    case vpe::core::Colour::kNone: break;
  }
  return Surfacing::kPlain;
}

bool shows_scale(Surfacing s) {
  return s == Surfacing::kElevation || s == Surfacing::kSlope || s == Surfacing::kAspect;
}

}  // namespace

ShadeParams shade_params(const vpe::core::Appearance& a, const glm::dvec3& sun, bool has_image,
                         std::shared_ptr<const vpe::core::ColourScale> scale) {
  using vpe::core::Mode;
  ShadeParams look;
  const Surfacing shown = surfacing_of(a.colour, has_image);
  const bool of_vertices = a.mode == Mode::kWireframe || a.mode == Mode::kMarkers;
  look.exaggeration = a.exaggeration;
  look.flat = a.shading == vpe::core::Shading::kFlat && !of_vertices;
  look.lit = !of_vertices && a.mode != Mode::kUnlit;
  look.surfacing = a.mode == Mode::kWireframe || a.mode == Mode::kLit ? Surfacing::kPlain
                   : a.mode == Mode::kTextured && has_image           ? Surfacing::kImage
                                                                      : shown;
  if (look.surfacing == Surfacing::kImage && a.colourise) look.hue = shown;
  // What is not used is not set, so that it cannot change a look.
  if (look.lit) {
    look.sun = sun;
    look.ambient = a.sun_ambient;
    look.diffuse = a.sun_diffuse;
    look.shadows = a.shadows;
  }
  if (shows_scale(look.surfacing) || shows_scale(look.hue)) look.scale = std::move(scale);
  return look;
}

bool needs_scale(const vpe::core::Appearance& appearance, bool has_image) {
  const ShadeParams look = shade_params(appearance, {1, 0, 0}, has_image, nullptr);
  return shows_scale(look.surfacing) || shows_scale(look.hue);
}

}  // namespace paging
