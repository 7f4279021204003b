#include <array>

#include "panorama/image/xmp_formats.h"
#include "vpe/core/image/tiff_handle.h"

namespace panorama {

bool is_tiff(const Input& input) {
  for (const std::array<std::uint8_t, 4> signature : {std::array<std::uint8_t, 4>{'I', 'I', 42, 0},
                                                      {'M', 'M', 0, 42},
                                                      {'I', 'I', 43, 0},
                                                      {'M', 'M', 0, 43}}) {
    if (starts_with(input, signature)) return true;
  }
  return false;
}

ImageFileHeader read_tiff_header(const std::filesystem::path& path) {
  // m: no memory map; O: tables of strips and tiles only when asked for.
  const vpe::core::TiffHandle tiff(path, "rmO", vpe::core::TiffHandle::kMaxTableBytes);
  if (tiff.get() == nullptr) throw MetadataError(std::string(tiff.words()) + "; the file is damaged");
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width_px);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height_px);
  if (width_px < 1 || height_px < 1) throw MetadataError("TIFF without a size; the file is damaged");
  ImageFileHeader header{ImageFileFormat::kTiff, width_px, height_px, std::nullopt};
  std::uint32_t bytes = 0;
  const char* packet = nullptr;
  if (TIFFGetField(tiff.get(), TIFFTAG_XMLPACKET, &bytes, &packet) == 1 && packet != nullptr) {
    if (bytes > kMaxXmpBytes) {
      throw MetadataError("XMP of " + std::to_string(bytes) + " bytes is more than the " +
                          std::to_string(kMaxXmpBytes) + " that are accepted");
    }
    header.xmp = std::string(packet, bytes);
  }
  return header;
}

}  // namespace panorama
