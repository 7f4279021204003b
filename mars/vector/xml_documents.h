// Texts of KML, KMZ and GPX files that are safe to parse.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace mars {

// Returns the text of a KML or GPX file. Of a KMZ, which its extension tells, returns doc.kml, or else the first file
// .kml of the archive, and then the documents of the archive that <NetworkLink>s lead to. Unpacking stops with an error
// after `most_bytes` in all: sizes that the archive states are not trusted. Refused are texts with a problem of
// inspect_xml(), and links that lead out of the file: what they lead to is not read, and would be missing. Must be called
// inside a GdalScope. Throws SourceError.
std::vector<std::string> xml_documents(const std::string& path, std::size_t most_bytes);

// Returns all of a file. Throws SourceError, also for more than `most_bytes`.
std::string whole_text(const std::string& path, std::size_t most_bytes);

}  // namespace mars
