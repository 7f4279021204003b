#include "panorama/image/tiff_file.h"

#include <string>
#include <utility>

namespace panorama {

// m: no memory map; O: tables of strips and tiles only when asked for.
TiffFile::TiffFile(std::filesystem::path path, const std::filesystem::path& opened)
    : path_(std::move(path)), tiff_(opened, "rmO", vpe::core::TiffHandle::kMaxTableBytes) {
  if (tiff_.get() == nullptr) throw damaged();
}

TiffFile::TiffFile(std::filesystem::path path) : TiffFile(path, path) {}

TiffFile::TiffFile(Same same)
    : TiffFile(same.other.path_, "/proc/self/fd/" + std::to_string(TIFFFileno(same.other.get()))) {}

vpe::base::FileError TiffFile::damaged() const {
  return vpe::base::file_error("read", path_, tiff_.words(), "the file is damaged, cut short, or no TIFF");
}

}  // namespace panorama
