// XMP packets in PNG, JPEG and TIFF, and damaged files.
#include "panorama/image/xmp_file.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "tests/panorama/test_images.h"
#include "vpe/base/file.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
using panorama::ImageFileFormat;
using panorama::ImageFileHeader;
using panorama::read_image_header;
using panorama_test::message_of;

ImageFileHeader header_of(const Bytes& bytes) {
  return read_image_header(std::span<const std::uint8_t>(bytes));
}

const std::string kPacket = "<?xpacket?><a>one</a>";

TEST(XmpFile, IsReadBackAndChangesNothingElse) {
  for (const Bytes& image : {panorama_test::png(31, 17), panorama_test::jpeg(31, 17)}) {
    const bool is_png = image[0] == 0x89;
    EXPECT_EQ(header_of(image).xmp, std::nullopt);
    const Bytes once = panorama::with_xmp(image, kPacket);
    const ImageFileHeader header = header_of(once);
    EXPECT_EQ(header.format, is_png ? ImageFileFormat::kPng : ImageFileFormat::kJpeg);
    EXPECT_EQ(header.width_px, 31);
    EXPECT_EQ(header.height_px, 17);
    EXPECT_EQ(header.xmp, kPacket);
    // Replaced, not added: the file with another packet of the same length differs in it alone.
    const Bytes twice = panorama::with_xmp(once, "<?xpacket?><a>two</a>");
    EXPECT_EQ(header_of(twice).xmp, "<?xpacket?><a>two</a>");
    EXPECT_EQ(twice.size(), once.size());
    EXPECT_EQ(panorama::with_xmp(twice, kPacket), once);
    const auto decode = [&](const Bytes& b) {
      return is_png ? vpe::core::decode_png(b).pixels : vpe::core::decode_jpeg(b).pixels;
    };
    EXPECT_EQ(decode(once), decode(image));
    if (is_png) {
      const std::string_view text(reinterpret_cast<const char*>(once.data()), once.size());
      EXPECT_LT(text.find("XML:com.adobe.xmp"), text.find("IDAT"));
    }
  }
}

TEST(XmpFile, IsWrittenIntoFiles) {
  const test_support::TempDir folder;
  vpe::base::write_file(folder / "a.jpg", panorama_test::jpeg(31, 17));
  panorama::write_xmp(folder / "a.jpg", kPacket);
  EXPECT_EQ(vpe::base::read_file(folder / "a.jpg", 1 << 20),
            panorama::with_xmp(panorama_test::jpeg(31, 17), kPacket));
  EXPECT_EQ(read_image_header(folder / "a.jpg").xmp, kPacket);
  vpe::base::write_file(folder / "a.txt", "no picture");
  EXPECT_EQ(read_image_header(folder / "a.txt").format, ImageFileFormat::kOther);
  EXPECT_SAYS(message_of([&] { panorama::write_xmp(folder / "a.txt", kPacket); }), "a.txt",
              "neither PNG nor JPEG");
  EXPECT_EQ(vpe::base::read_file(folder / "a.txt", 100).size(), 10U);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt.tmp"));
  EXPECT_SAYS(message_of([&] { read_image_header(folder / "none.png"); }), "none.png", "cannot read");
  EXPECT_SAYS(message_of([&] { read_image_header(folder.path()); }), "cannot read");
  EXPECT_EQ(read_image_header(std::span<const std::uint8_t>()).format, ImageFileFormat::kOther);
}

TEST(XmpFile, RefusesPacketsThatDoNotFit) {
  const Bytes largest =
      panorama::with_xmp(panorama_test::jpeg(3, 3), std::string(panorama::kMaxJpegXmpBytes, 'x'));
  EXPECT_EQ(header_of(largest).xmp->size(), panorama::kMaxJpegXmpBytes);
  const std::string too_long(panorama::kMaxJpegXmpBytes + 1, 'x');
  EXPECT_SAYS(message_of([&] { panorama::with_xmp(panorama_test::jpeg(3, 3), too_long); }), "65503", "65502");
  EXPECT_NO_THROW(panorama::with_xmp(panorama_test::png(3, 3), too_long));
  const std::string huge(panorama::kMaxXmpBytes + 1, 'x');
  EXPECT_SAYS(message_of([&] { panorama::with_xmp(panorama_test::png(3, 3), huge); }), "too large");
}

// A chunk with the right checksum.
std::string chunk(const std::string& type_and_data) {
  const auto big_endian = [](std::size_t value) {
    std::string bytes;
    for (const int shift : {24, 16, 8, 0})
      bytes += static_cast<char>(static_cast<std::uint8_t>(value >> shift));
    return bytes;
  };
  const auto sum =
      ::crc32(0, reinterpret_cast<const Bytef*>(type_and_data.data()), static_cast<uInt>(type_and_data.size()));
  return big_endian(type_and_data.size() - 4) + type_and_data + big_endian(sum);
}

// A PNG with the chunk in front of its last one.
Bytes png_with(const std::string& more) {
  const Bytes png = panorama_test::png(31, 17);
  std::string text(png.begin(), png.end());
  text.insert(text.size() - 12, more);
  return {text.begin(), text.end()};
}

std::string itxt(const std::string& flags, const std::string& text) {
  return "iTXt" + std::string("XML:com.adobe.xmp\0", 18) + flags + text;
}

TEST(XmpFile, OddChunksOfPngAreReadOrRefused) {
  const std::string plain(4, '\0');
  EXPECT_EQ(header_of(png_with(chunk(itxt(plain, kPacket)))).xmp, kPacket);
  const std::string with_language = std::string("\0\0en\0title\0", 11);
  EXPECT_EQ(header_of(png_with(chunk(itxt(with_language, kPacket)))).xmp, kPacket);
  const auto refuses = [](const std::string& data) {
    return message_of([&] { header_of(png_with(chunk(data))); });
  };
  EXPECT_SAYS(refuses(itxt("", "")), "iTXt");
  EXPECT_SAYS(refuses(itxt(std::string("\0\0en", 4), "")), "iTXt");
  EXPECT_SAYS(refuses(itxt(std::string("\2\0\0\0", 4), "x")), "iTXt");
  EXPECT_SAYS(refuses(itxt(std::string("\1\0\0\0", 4), "not deflated")), "unpack");
  // A bomb: 64 MB of blanks in 64 kB.
  const Bytes blanks(std::size_t{1} << 26, ' ');
  uLongf size = ::compressBound(blanks.size());
  std::string packed(size, '\0');
  ASSERT_EQ(::compress2(reinterpret_cast<Bytef*>(packed.data()), &size, blanks.data(), blanks.size(), 9), Z_OK);
  packed.resize(size);
  EXPECT_SAYS(refuses(itxt(std::string("\1\0\0\0", 4), packed)), "unpack");
  std::string wrong = chunk(itxt(plain, kPacket));
  wrong[40] ^= 1;
  EXPECT_SAYS(message_of([&] { header_of(png_with(wrong)); }), "checksum");
}

TEST(XmpFile, LengthsThatLieAreSeen) {
  Bytes png = panorama_test::png(31, 17);
  png[33] = 0x7F;  // of the chunk behind the header
  EXPECT_SAYS(message_of([&] { header_of(png); }), "chunk", "cut short");
  EXPECT_SAYS(message_of([&] { panorama::with_xmp(png, kPacket); }), "chunk", "cut short");
  Bytes jpeg = panorama_test::jpeg(31, 17);
  jpeg[4] = 0xFF;  // of the segment behind the start
  EXPECT_SAYS(message_of([&] { header_of(jpeg); }), "segment", "cut short");
  jpeg[4] = 0;
  jpeg[5] = 1;
  EXPECT_SAYS(message_of([&] { header_of(jpeg); }), "segment");
  jpeg[5] = 9;
  EXPECT_SAYS(message_of([&] { header_of(jpeg); }), "no JPEG marker");
}

TEST(XmpFile, AnyCutIsAMessage) {
  for (const Bytes& image : {panorama_test::png(31, 17), panorama_test::jpeg(31, 17)}) {
    const Bytes whole = panorama::with_xmp(image, kPacket);
    const bool is_png = whole[0] == 0x89;
    int refused = 0;
    for (std::size_t size = 8; size < whole.size(); ++size) {
      const auto cut = std::span(whole).first(size);
      const std::string said = message_of([&] { read_image_header(cut); });
      if (is_png) {
        EXPECT_NE(said, "") << size;
      }
      refused += said.empty() ? 0 : 1;
    }
    // A JPEG is followed to its pixels, behind 600 bytes of tables.
    EXPECT_GT(refused, is_png ? 150 : 600);
  }
}

TEST(XmpFile, AnyFlippedByteIsAMessageOrAHeader) {
  for (const Bytes& image : {panorama_test::png(31, 17), panorama_test::jpeg(31, 17)}) {
    const Bytes whole = panorama::with_xmp(image, kPacket);
    test_support::Random random(821);
    for (std::size_t at = 0; at < whole.size(); ++at) {
      Bytes bytes = whole;
      bytes[at] = static_cast<std::uint8_t>(random.integer(0, 255));
      message_of([&] {
        const ImageFileHeader header = header_of(bytes);
        EXPECT_GE(header.width_px, header.format == ImageFileFormat::kOther ? 0 : 1);
      });
      message_of([&] { panorama::with_xmp(bytes, kPacket); });
    }
  }
}

// Little-endian fields of a BigTIFF.
void put(std::string& out, std::uint64_t value, int bytes) {
  for (int n = 0; n < bytes; ++n) out += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * n)));
}

TEST(XmpFile, SizeOfAGigapixelBigTiffComesFromItsHeader) {
  // 100 000 x 20 000 in tiles of 512: the table of offsets is there, the pixels are a hole in the file.
  const std::uint64_t tiles = 196 * 40;
  const std::string packet = "<a/>    ";
  std::string head("II\x2B\0\x08\0\0\0", 8);
  put(head, 16, 8);
  struct Tag {
    int id, type;
    std::uint64_t count, value;
  };
  const std::uint64_t table = 16 + 8 + 10 * 20 + 8;
  std::uint64_t packet_bits = 0;
  std::memcpy(&packet_bits, packet.data(), 8);
  const Tag tags[] = {{256, 4, 1, 100000},     {257, 4, 1, 20000},      {258, 3, 1, 8},
                      {259, 3, 1, 1},          {262, 3, 1, 1},          {322, 3, 1, 512},
                      {323, 3, 1, 512},        {324, 16, tiles, table}, {325, 16, tiles, table + tiles * 8},
                      {700, 1, 8, packet_bits}};
  put(head, std::size(tags), 8);
  for (const Tag& tag : tags) {
    put(head, static_cast<std::uint64_t>(tag.id), 2);
    put(head, static_cast<std::uint64_t>(tag.type), 2);
    put(head, tag.count, 8);
    put(head, tag.value, 8);
  }
  put(head, 0, 8);
  for (std::uint64_t n = 0; n < tiles; ++n) put(head, 1000000 + n * 262144, 8);
  for (std::uint64_t n = 0; n < tiles; ++n) put(head, 262144, 8);
  const test_support::TempDir folder;
  std::ofstream(folder / "big.tif", std::ios::binary) << head;
  std::filesystem::resize_file(folder / "big.tif", 1000000 + tiles * 262144);
  const ImageFileHeader header = read_image_header(folder / "big.tif");
  EXPECT_EQ(header.format, ImageFileFormat::kTiff);
  EXPECT_EQ(header.width_px, 100000);
  EXPECT_EQ(header.height_px, 20000);
  EXPECT_EQ(header.xmp, packet);

  for (const std::size_t size : {8U, 12U, 20U, 60U, 200U}) {
    std::ofstream(folder / "cut.tif", std::ios::binary | std::ios::trunc) << head.substr(0, size);
    EXPECT_SAYS(message_of([&] { read_image_header(folder / "cut.tif"); }), "cut.tif", "damaged");
  }
  // A count of tag 700 that no file could hold.
  std::string liar = head;
  liar.replace(16 + 8 + 9 * 20 + 4, 8, "\xFF\xFF\xFF\xFF\0\0\0\0", 8);
  std::ofstream(folder / "liar.tif", std::ios::binary) << liar;
  const std::string said =
      message_of([&] { EXPECT_EQ(read_image_header(folder / "liar.tif").xmp, std::nullopt); });
  EXPECT_TRUE(said.empty() || said.find("liar.tif") != std::string::npos) << said;
}

TEST(XmpFile, AnyDamagedTiffIsAMessageOrAHeader) {
  const test_support::TempDir folder;
  vpe::core::write_tiff(folder / "a.tif", std::vector<float>(31 * 17, 1.0F), 31, 17);
  const Bytes whole = vpe::base::read_file(folder / "a.tif", 1 << 20);
  test_support::Random random(822);
  for (int n = 0; n < 1000; ++n) {
    Bytes bytes = whole;
    for (int k = random.integer(1, 3); k > 0; --k) {
      const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
      bytes[at] = static_cast<std::uint8_t>(random.integer(0, 255));
    }
    vpe::base::write_file(folder / "b.tif", bytes);
    message_of([&] {
      const ImageFileHeader header = read_image_header(folder / "b.tif");
      EXPECT_GE(header.width_px, header.format == ImageFileFormat::kOther ? 0 : 1);
    });
  }
}

}  // namespace
