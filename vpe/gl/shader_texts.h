// Texts of the files in vpe/gl/shaders/, which cmake/embed_text.cmake turns into constants.
#pragma once

#include <string_view>

namespace vpe::gl::shader_text {

extern const std::string_view kCornerFragment;
extern const std::string_view kFinishFragment;
extern const std::string_view kFinishVertex;
extern const std::string_view kGroundColour;
extern const std::string_view kInterpolate;
extern const std::string_view kNodataPattern;
extern const std::string_view kRibbonGeometry;
extern const std::string_view kSkirtFragment;
extern const std::string_view kSkirtGeometry;
extern const std::string_view kSkyFragment;
extern const std::string_view kSkyVertex;
extern const std::string_view kSurfaceFragment;
extern const std::string_view kTileVertex;
extern const std::string_view kTriangleGeometry;

}  // namespace vpe::gl::shader_text
