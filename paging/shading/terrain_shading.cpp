#include "paging/shading/terrain_shader.h"

namespace paging {

namespace {

ColourSource colour_source_of(vpe::core::Colour colour, bool has_image) {
  switch (colour) {
    case vpe::core::Colour::kElevation: return ColourSource::kElevation;
    case vpe::core::Colour::kSlope: return ColourSource::kSlope;
    case vpe::core::Colour::kAspect: return ColourSource::kAspect;
    case vpe::core::Colour::kImage: return has_image ? ColourSource::kImageAtPosts : ColourSource::kPlain;
    case vpe::core::Colour::kNone: break;
  }
  return ColourSource::kPlain;
}

bool shows_scale(ColourSource s) {
  return s == ColourSource::kElevation || s == ColourSource::kSlope || s == ColourSource::kAspect;
}

}  // namespace

ShadingParams shading_params(const vpe::core::Appearance& a, const glm::dvec3& sun, bool has_image,
                             std::shared_ptr<const vpe::core::ColourScale> scale) {
  using vpe::core::Mode;
  ShadingParams shading;
  const ColourSource shown = colour_source_of(a.colour, has_image);
  const bool of_vertices = a.mode == Mode::kWireframe || a.mode == Mode::kMarkers;
  shading.exaggeration = a.exaggeration;
  shading.flat = a.shading == vpe::core::Shading::kFlat && !of_vertices;
  shading.lit = !of_vertices && a.mode != Mode::kUnlit;
  shading.colour_source = a.mode == Mode::kWireframe || a.mode == Mode::kLit ? ColourSource::kPlain
                          : a.mode == Mode::kTextured && has_image           ? ColourSource::kImage
                                                                             : shown;
  if (shading.colour_source == ColourSource::kImage && a.colourise) shading.hue = shown;
  // What is not used is not set, so that it cannot change a look.
  if (shading.lit) {
    shading.sun = sun;
    shading.ambient = a.sun_ambient;
    shading.diffuse = a.sun_diffuse;
    shading.shadows = a.shadows;
  }
  if (shows_scale(shading.colour_source) || shows_scale(shading.hue)) shading.scale = std::move(scale);
  return shading;
}

bool needs_scale(const vpe::core::Appearance& appearance, bool has_image) {
  const ShadingParams shading = shading_params(appearance, {1, 0, 0}, has_image, nullptr);
  return shows_scale(shading.colour_source) || shows_scale(shading.hue);
}

}  // namespace paging
