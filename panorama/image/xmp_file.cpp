#include "panorama/image/xmp_file.h"

#include <algorithm>
#include <array>

#include "panorama/image/xmp_formats.h"
#include "vpe/base/file.h"

namespace panorama {

namespace {

void copy_with_xmp(const Input& input, std::string_view packet, const Sink& sink) {
  if (packet.size() > kMaxXmpBytes)
    throw MetadataError("an XMP packet of " + std::to_string(packet.size()) + " bytes is too large");
  if (is_png(input)) return copy_png_with_xmp(input, packet, sink);
  if (is_jpeg(input)) return copy_jpeg_with_xmp(input, packet, sink);
  throw MetadataError("neither PNG nor JPEG, and XMP is put into those only; write the image as one of them");
}

vpe::base::FileError with_path(const char* operation, const std::filesystem::path& path,
                               const MetadataError& e) {
  return vpe::base::FileError(std::string("cannot ") + operation + " '" + path.string() + "': " + e.what());
}

}  // namespace

void copy_range(const Input& input, std::uint64_t from, std::uint64_t to, const Sink& sink) {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 16;
  std::vector<std::uint8_t> piece;
  while (from < to) {
    piece.resize(std::min(kPiece, to - from));
    input.read(from, piece);
    sink(piece);
    from += piece.size();
  }
}

bool starts_with(const Input& input, std::span<const std::uint8_t> signature) {
  if (input.size() < signature.size()) return false;
  std::vector<std::uint8_t> start(signature.size());
  input.read(0, start);
  return std::equal(signature.begin(), signature.end(), start.begin());
}

ImageFileHeader read_image_header(const std::filesystem::path& path) {
  try {
    const Input input(path);
    if (is_png(input)) return read_png_header(input);
    if (is_jpeg(input)) return read_jpeg_header(input);
    return is_tiff(input) ? read_tiff_header(path) : ImageFileHeader{};
  } catch (const MetadataError& e) {
    throw with_path("read", path, e);
  }
}

ImageFileHeader read_image_header(std::span<const std::uint8_t> bytes) {
  const Input input(bytes);
  if (is_png(input)) return read_png_header(input);
  return is_jpeg(input) ? read_jpeg_header(input) : ImageFileHeader{};
}

std::vector<std::uint8_t> with_xmp(std::span<const std::uint8_t> image, std::string_view packet) {
  std::vector<std::uint8_t> out;
  copy_with_xmp(Input(image), packet, [&out](std::span<const std::uint8_t> bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
  });
  return out;
}

void write_xmp(const std::filesystem::path& path, std::string_view packet) {
  try {
    const Input input(path);
    vpe::base::OutputFile file(path);
    copy_with_xmp(input, packet, [&file](std::span<const std::uint8_t> bytes) { file.write(bytes); });
    file.commit();
  } catch (const MetadataError& e) {
    throw with_path("put XMP into", path, e);
  }
}

}  // namespace panorama
