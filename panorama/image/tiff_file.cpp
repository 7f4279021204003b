#include "panorama/image/tiff_file.h"

#include <utility>

namespace panorama {

// m: no memory map; O: tables of strips and tiles only when asked for.
TiffFile::TiffFile(std::filesystem::path path)
    : path_(std::move(path)), tiff_(path_, "rmO", vpe::core::TiffHandle::kMaxTableBytes) {
  if (tiff_.get() == nullptr) throw damaged();
}

vpe::base::FileError TiffFile::damaged() const {
  return vpe::base::file_error("read", path_, tiff_.words(), "the file is damaged, cut short, or no TIFF");
}

}  // namespace panorama
