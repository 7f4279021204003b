#include "mars/vector/memory_text.h"

#include <cpl_vsi.h>

#include <atomic>
#include <utility>

#include "mars/raster/gdal/gdal_scope.h"

namespace mars {

MemoryText::MemoryText(std::string text, const std::string& file_name) : text_(std::move(text)) {
  static std::atomic<int> count{0};
  name_ = "/vsimem/vpe-vector-" + std::to_string(++count) + "/" + file_name;
  const GdalScope scope;
  VSIFCloseL(VSIFileFromMemBuffer(name_.c_str(), reinterpret_cast<GByte*>(text_.data()), text_.size(), FALSE));
}

MemoryText::~MemoryText() {
  const GdalScope scope;
  VSIUnlink(name_.c_str());
}

}  // namespace mars
