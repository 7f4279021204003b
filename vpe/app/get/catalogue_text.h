// Text of mars/data/catalogue.toml, which cmake/embed_text.cmake turns into a constant.
#pragma once

#include <string_view>

namespace vpe::app::catalogue_text {

extern const std::string_view kCatalogue;

}  // namespace vpe::app::catalogue_text
