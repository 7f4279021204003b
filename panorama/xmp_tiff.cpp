#include <tiffio.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <memory>

#include "panorama/xmp_formats.h"

namespace panorama {

namespace {

struct Words {
  char text[512] = "unknown error";
};

int keep_words(TIFF* /*tiff*/, void* user, const char* /*module*/, const char* format, std::va_list arguments) {
  auto* words = static_cast<Words*>(user);
  std::vsnprintf(words->text, sizeof words->text, format, arguments);
  return 1;
}

int ignore_words(TIFF* /*tiff*/, void* /*user*/, const char* /*module*/, const char* /*format*/,
                 std::va_list /*arguments*/) {
  return 1;
}

// A picture of 100 000 x 20 000 in tiles of 16 x 16 has tables of 60 MB.
constexpr tmsize_t kMaxTableBytes = tmsize_t{1} << 28;

}  // namespace

bool is_tiff(const Input& input) {
  for (const std::array<std::uint8_t, 4> signature : {std::array<std::uint8_t, 4>{'I', 'I', 42, 0},
                                                      {'M', 'M', 0, 42},
                                                      {'I', 'I', 43, 0},
                                                      {'M', 'M', 0, 43}}) {
    if (starts_with(input, signature)) return true;
  }
  return false;
}

PictureHeader read_tiff_header(const std::filesystem::path& path) {
  Words words;
  const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                             TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_words, &words);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_words, nullptr);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMaxTableBytes);
  // m: no memory map; O: tables of strips and tiles only when asked for.
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpenExt(path.c_str(), "rmO", options.get()), TIFFClose);
  if (tiff == nullptr) throw MetadataError(std::string(words.text) + "; the file is damaged");
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width_px);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height_px);
  if (width_px < 1 || height_px < 1) throw MetadataError("TIFF without a size; the file is damaged");
  PictureHeader header{PictureFormat::kTiff, width_px, height_px, std::nullopt};
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
