#include <array>
#include <functional>

#include "panorama/image/xmp_formats.h"

namespace panorama {

namespace {

// ITU T.81, annex B: markers FFxx, most with a length of two bytes that counts itself.
constexpr std::uint8_t kStartOfImage = 0xD8;
constexpr std::uint8_t kEndOfImage = 0xD9;
constexpr std::uint8_t kStartOfScan = 0xDA;
constexpr std::uint8_t kApp0 = 0xE0;
constexpr std::uint8_t kApp1 = 0xE1;
constexpr std::string_view kXmpName("http://ns.adobe.com/xap/1.0/\0", 29);
constexpr std::string_view kExifName("Exif\0", 5);
static_assert(2 + kXmpName.size() + kMaxJpegXmpBytes <= 0xFFFF);

struct Segment {
  std::uint64_t at = 0;  // of the FF of its marker
  std::uint8_t marker = 0;
  std::uint64_t data = 0;  // behind the length
  std::uint64_t end = 0;
};

std::uint32_t read_u16(const Input& input, std::uint64_t at) {
  std::array<std::uint8_t, 2> bytes{};
  input.read(at, bytes);
  return std::uint32_t{bytes[0]} << 8 | bytes[1];
}

std::uint8_t read_u8(const Input& input, std::uint64_t at) {
  std::array<std::uint8_t, 1> bytes{};
  input.read(at, bytes);
  return bytes[0];
}

// Visits the segments from the start of the image to its first scan, including the scan's.
void visit_segments(const Input& input, const std::function<void(const Segment&)>& visit) {
  for (std::uint64_t at = 2;;) {
    Segment segment;
    segment.at = at;
    if (read_u8(input, at) != 0xFF) {
      throw MetadataError("no JPEG marker at byte " + std::to_string(at) + "; the file is damaged");
    }
    do segment.marker = read_u8(input, ++at);
    while (segment.marker == 0xFF);  // markers may be padded
    ++at;
    const bool stands_alone =
        segment.marker == 0x01 || (segment.marker >= 0xD0 && segment.marker <= kEndOfImage);
    if (stands_alone || segment.marker == 0x00) {
      throw MetadataError("JPEG has no image before byte " + std::to_string(at) + "; the file is damaged");
    }
    const std::uint32_t length = read_u16(input, at);
    segment.data = at + 2;
    segment.end = at + length;
    if (length < 2 || segment.end > input.size()) {
      throw MetadataError("JPEG segment at byte " + std::to_string(segment.at) + " claims " +
                          std::to_string(length) + " bytes, which do not fit; it is cut short or damaged");
    }
    visit(segment);
    if (segment.marker == kStartOfScan) return;
    at = segment.end;
  }
}

bool begins_with(const Input& input, const Segment& segment, std::string_view name) {
  return segment.marker == kApp1 && segment.end - segment.data >= name.size() &&
         input.read_text(segment.data, name.size()) == name;
}

// SOF0 to SOF15 without DHT, JPG and DAC, which lie between them.
bool is_frame_header(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

}  // namespace

bool is_jpeg(const Input& input) {
  constexpr std::array<std::uint8_t, 3> kSignature{0xFF, kStartOfImage, 0xFF};
  return starts_with(input, kSignature);
}

ImageFileHeader read_jpeg_header(const Input& input) {
  ImageFileHeader header;
  header.format = ImageFileFormat::kJpeg;
  visit_segments(input, [&](const Segment& segment) {
    if (is_frame_header(segment.marker) && segment.end - segment.data >= 5) {
      header.height_px = read_u16(input, segment.data + 1);
      header.width_px = read_u16(input, segment.data + 3);
    } else if (!header.xmp && begins_with(input, segment, kXmpName)) {
      const std::uint64_t start = segment.data + kXmpName.size();
      header.xmp = input.read_text(start, static_cast<std::size_t>(segment.end - start));
    }
  });
  if (header.width_px < 1 || header.height_px < 1) {
    throw MetadataError("JPEG does not say its size before its pixels; write it again with another program");
  }
  return header;
}

void copy_jpeg_with_xmp(const Input& input, std::string_view packet, const Sink& sink) {
  if (packet.size() > kMaxJpegXmpBytes) {
    throw MetadataError("an XMP packet of " + std::to_string(packet.size()) +
                        " bytes does not fit a JPEG, which holds " + std::to_string(kMaxJpegXmpBytes) +
                        "; shorten it");
  }
  const auto length = static_cast<std::uint32_t>(2 + kXmpName.size() + packet.size());
  std::string segment_with_packet{'\xFF', static_cast<char>(kApp1), static_cast<char>(length >> 8),
                                  static_cast<char>(length & 0xFF)};
  segment_with_packet.append(kXmpName).append(packet);

  copy_range(input, 0, 2, sink);
  // JFIF and Exif come first in a file by their own rules.
  bool is_put = false;
  std::uint64_t rest = 2;
  visit_segments(input, [&](const Segment& segment) {
    if (!is_put && segment.marker != kApp0 && !begins_with(input, segment, kExifName)) {
      sink({reinterpret_cast<const std::uint8_t*>(segment_with_packet.data()), segment_with_packet.size()});
      is_put = true;
    }
    if (!begins_with(input, segment, kXmpName)) copy_range(input, segment.at, segment.end, sink);
    rest = segment.end;
  });
  copy_range(input, rest, input.size(), sink);
}

}  // namespace panorama
