// Recognition of files by their content, so that an output never replaces a file of another kind.
#pragma once

#include <cstdint>
#include <filesystem>

namespace vpe::app {

enum class FileKind : std::uint8_t {
  kImage,          // PNG or JPEG, of any program
  kRange,          // TIFF of one float32 band without georeference, of any program
  kPanorama,       // PNG, JPEG, or a TIFF of this program
  kPanoramaPlane,  // TIFF of this program
  kCertificate,
  kExplanation,
  kSkyline,
  kLandmarks,
  kLandscape,  // landscape.ini
  kHorizonList,
  kStatistics,
  kFlightLog,  // with the comment that begins every log
  kTraverse,   // flight with the comment that begins every traverse
  kFrame,      // PNG with this program's texts
  kManifest,
  kVideo,       // MP4 of this program: its manifest or its segments lie beside it
  kPlanet,      // planet file of this program, also a part of one
  kSticks,      // model of sticks
  kVolume,      // semi-transparent model
  kPlanetPage,  // of vpe info
  kPlot,        // SVG, of any program
  kMap,         // GeoTIFF of this program
  kFeatures,    // GeoJSON or GeoPackage of this program
};

// Returns a name for messages, such as "a certificate of vpe".
const char* name_of(FileKind kind);

// Returns true if a file exists whose content is of this kind, and by this program where the kind demands it.
// Reads no more than the beginning. Does not throw.
bool is_of_kind(const std::filesystem::path& file, FileKind kind);

}  // namespace vpe::app
