// The files of a web page that do not depend on pixels: the viewer, its page, and the description of the
// panorama.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "panorama/metadata/open_panorama.h"
#include "panorama/page/page_layers.h"
#include "panorama/page/page_marks.h"
#include "panorama/page/page_pyramid.h"

namespace panorama {

// A file of the viewer, in the folder kViewerFolder of a page.
struct ViewerFile {
  std::string_view name;
  std::string_view text;
};
inline constexpr std::string_view kViewerFolder = "viewer";
// Returns the style sheet, then the scripts in the order in which they run. The last one starts the page, and
// needs what data_script() defines.
std::span<const ViewerFile> viewer_files();

// Holds what a page says of its panorama.
struct PageFacts {
  std::string title;
  PanoramaDescription description;
  PagePyramid pyramid;
  bool has_right_eye = false;
  std::optional<PageLayers> layers;
  PageMarks marks;
  std::string picture;  // file of the full picture in the page's folder; empty: none
};

// Returns index.html.
std::string index_html(const PageFacts& facts);

// Returns data.js. Its first line is kPageMark.
std::string data_script(const PageFacts& facts);
inline constexpr std::string_view kPageMark = "// vpe web page of a panorama, format 1";

// Return a text with what HTML or a script would take for its own escaped: the text of an element or a quoted
// attribute; JSON in a script element, which stays the same JSON.
std::string html_text(std::string_view text);
std::string script_json(std::string_view json);

}  // namespace panorama
