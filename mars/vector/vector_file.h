// Opens vector files that may be hostile.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mars/vector/memory_text.h"

class GDALDataset;
class OGRLayer;

namespace mars {

// Names a format.
enum class VectorFormat { geopackage, geojson, shapefile, kml, gpx, csv };

// Returns true if the extension of a path is that of a format. Upper and lower case do not matter.
bool has_vector_extension(const std::string& path);

// Holds an open vector file. One thread uses it at a time, inside an OfflineScope.
class VectorFile {
 public:
  // Opens a local file with the driver of its extension alone, for reading. XML is checked by xml_documents()
  // first. CSV is read without the .csvt beside it, which would let GDAL take words for 0.
  // Throws SourceError.
  VectorFile(const std::string& path, std::size_t most_bytes);
  ~VectorFile();
  VectorFile(const VectorFile&) = delete;
  VectorFile& operator=(const VectorFile&) = delete;

  VectorFormat format() const { return format_; }
  // Returns its layers, which exist as long as this.
  std::vector<OGRLayer*> layers() const;

 private:
  using Dataset = std::unique_ptr<GDALDataset, std::function<void(GDALDataset*)>>;

  void open(const std::string& name, const char* const* drivers);

  std::string path_;
  VectorFormat format_;
  std::vector<std::unique_ptr<MemoryText>> texts_;  // of XML and CSV
  std::vector<Dataset> datasets_;
};

}  // namespace mars
