#include "mars/raster/placement/memory_file.h"

#include <cpl_vsi.h>

#include <atomic>

#include "mars/raster/gdal/gdal_scope.h"

namespace mars {

MemoryFile::MemoryFile(const std::string& extension) {
  static std::atomic<int> count{0};
  name_ = "/vsimem/vpe-placement-" + std::to_string(++count) + "." + extension;
}

MemoryFile::~MemoryFile() {
  const GdalScope scope;
  VSIUnlink(name_.c_str());
}

}  // namespace mars
