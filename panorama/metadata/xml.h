// Helpers for pugixml, which does not know namespaces.
#pragma once

#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "panorama/image/metadata_error.h"

namespace panorama {

// Converts ASCII letters to lower case.
std::string lower_case(std::string_view text);

// Parses UTF-8 or the encoding that the document declares. Never expands entities other than XML's own. Throws
// MetadataError when `what` ("XMP", "label") is not well-formed, with the library's words and the place.
pugi::xml_document parse_xml(std::string_view text, std::string_view what);

// Returns the text without the control characters that XML 1.0 cannot hold.
std::string xml_text(std::string_view text);

// Returns all attributes and all elements without child elements that belong to a namespace, by local name,
// values trimmed. Throws MetadataError when one is given twice with different values.
std::map<std::string, std::string> fields_of_namespace(const pugi::xml_document& document,
                                                       std::string_view uri);

// Returns "pixel_scale_x" for "cart:pixel_scale_x".
std::string_view local_name(std::string_view name);

// Removes spaces, tabs and line ends from both ends.
std::string_view trim(std::string_view text);

}  // namespace panorama
