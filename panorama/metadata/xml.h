// Small helps around pugixml, which knows no namespaces.
#pragma once

#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "panorama/image/metadata_error.h"

namespace panorama {

// ASCII letters to lower case.
std::string lower_case(std::string_view text);

// UTF-8 or what the document declares. Throws MetadataError: what ("XMP", "label") is not well-formed, the
// library's words, where. Entities other than XML's own are never expanded.
pugi::xml_document parse_xml(std::string_view text, std::string_view what);

// Text without the control characters that XML 1.0 has no way to write.
std::string xml_text(std::string_view text);

// All attributes and all elements without child elements that belong to a namespace, by local name, values
// trimmed. Throws MetadataError when one is given twice with different values.
std::map<std::string, std::string> fields_of_namespace(const pugi::xml_document& document,
                                                       std::string_view uri);

// "pixel_scale_x" of "cart:pixel_scale_x".
std::string_view local_name(std::string_view name);

std::string_view trim(std::string_view text);

}  // namespace panorama
