#include "vpe/gl/shaders.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>

#include "vpe/gl/shader_texts.h"

namespace vpe::gl {

namespace {

void define(std::string& text, std::string_view name, const std::string& value = "") {
  text.append("#define ").append(name).append(" ").append(value).append("\n");
}

// What every stage of a program begins with: the version and the locations of the uniforms.
std::string preamble(std::span<const std::string_view> uniforms) {
  std::string text = "#version 450 core\n";
  for (std::size_t n = 0; n < uniforms.size(); ++n) {
    std::string name = "LOCATION_" + std::string(uniforms[n]);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    define(text, name, std::to_string(n));
  }
  return text;
}

std::string join(std::string text, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts) text += part;
  return text;
}

}  // namespace

ShaderSources tile_shaders(TilePart part, const TileFeatures& features) {
  std::string head = preamble(kTileUniforms);
  if (features.texture) define(head, "TEXTURE");
  if (features.facets) define(head, "FACETS");
  const bool has_geometry = part != TilePart::kSurface || features.by_triangle;
  if (features.facets && !has_geometry) define(head, "FACETS_FROM_FIRST");
  if (features.palette) define(head, "PALETTE");
  if (features.nodata) define(head, "NODATA");
  if (features.nodata_image) define(head, "NODATA_IMAGE");
  if (features.haze) define(head, "HAZE");
  if (features.placed) define(head, "PLACED");
  if (features.light) define(head, "LIGHT");
  if (features.thin) define(head, "THIN");
  if (features.texture || features.nodata) define(head, "CHART");
  const bool skirt = part == TilePart::kSkirt;
  ShaderSources out;
  out.vertex = join(head, {shader_text::kTileVertex});
  out.fragment = join(
      head, {shader_text::kGroundColour, features.nodata ? shader_text::kNodataPattern : std::string_view(),
             skirt ? shader_text::kSkirtFragment : shader_text::kSurfaceFragment});
  if (has_geometry) {
    out.geometry = join(head, {skirt                       ? shader_text::kSkirtGeometry
                               : part == TilePart::kRibbon ? shader_text::kRibbonGeometry
                                                           : shader_text::kTriangleGeometry,
                               shader_text::kInterpolate});
  }
  return out;
}

ShaderSources sky_shaders() {
  const std::string head = preamble(kSkyUniforms);
  return {join(head, {shader_text::kSkyVertex}), "", join(head, {shader_text::kSkyFragment})};
}

}  // namespace vpe::gl
