// Inspects XML texts before a parser reads them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mars {

// Largest depth of elements within elements.
inline constexpr int kMostXmlDepth = 100;

// Holds what was found in a text.
struct XmlFindings {
  // Why the text must not reach an XML parser, as "reason; advice", or "".
  std::string problem;
  // The <href> of each <NetworkLink>; "" for one that has none.
  std::vector<std::string> links;
};

// Inspects a KML or GPX text. Problems are: a document type declaration, because its entities can expand to any size and
// name other files; elements deeper than kMostXmlDepth, because parsers recurse; UTF-16 and UTF-32, in which neither
// would be found. Whether the text is well-formed is left to the parser. Pure.
XmlFindings inspect_xml(std::string_view text);

}  // namespace mars
