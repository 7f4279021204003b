// Texts of the files in vpe/overlook/shaders/, which cmake/embed_text.cmake turns into constants.
#pragma once

#include <string_view>

namespace vpe::overlook::shader_text {

extern const std::string_view kEnlargedFragment;
extern const std::string_view kFilteredFragment;
extern const std::string_view kPartVertex;

}  // namespace vpe::overlook::shader_text
