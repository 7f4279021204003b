// Texts of the files in panorama/page/web/, which cmake/embed_text.cmake turns into constants.
#pragma once

#include <string_view>

namespace panorama::page_text {

extern const std::string_view kFlatRenderer;
extern const std::string_view kFlatView;
extern const std::string_view kInput;
extern const std::string_view kLoader;
extern const std::string_view kMain;
extern const std::string_view kMarks;
extern const std::string_view kPace;
extern const std::string_view kPage;
extern const std::string_view kPanel;
extern const std::string_view kPlanes;
extern const std::string_view kProjection;
extern const std::string_view kPyramid;
extern const std::string_view kStyle;
extern const std::string_view kTemplate;
extern const std::string_view kText;
extern const std::string_view kView;
extern const std::string_view kWebgl;

}  // namespace panorama::page_text
