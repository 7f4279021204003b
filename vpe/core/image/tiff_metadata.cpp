#include "vpe/core/image/tiff_metadata.h"

#include <cstdint>

namespace vpe::core {

namespace {

// GDAL's tags, which libtiff does not know by itself.
constexpr std::uint32_t kMetadataTag = 42112;
constexpr std::uint32_t kNodataTag = 42113;

bool set_text(TIFF* tiff, std::uint32_t tag, const char* tag_name, const std::string& text) {
  std::string name = tag_name;
  const TIFFFieldInfo field{tag, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, name.data()};
  return TIFFMergeFieldInfo(tiff, &field, 1) == 0 && TIFFSetField(tiff, tag, text.c_str()) == 1;
}

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string band_item(std::size_t band, const char* name, const char* role, const std::string& value) {
  return "  <Item name=\"" + std::string(name) + "\" sample=\"" + std::to_string(band) + "\" role=\"" + role +
         "\">" + xml_text(value) + "</Item>\n";
}

}  // namespace

bool set_metadata(TIFF* tiff, const TiffMetadata& metadata) {
  std::string items;
  for (const auto& [key, value] : metadata.items)
    items += "  <Item name=\"" + xml_text(key) + "\">" + xml_text(value) + "</Item>\n";
  for (std::size_t n = 0; n < metadata.bands.size(); ++n) {
    const TiffBand& band = metadata.bands[n];
    if (!band.name.empty()) items += band_item(n, "DESCRIPTION", "description", band.name);
    if (!band.unit.empty()) items += band_item(n, "UNITTYPE", "unittype", band.unit);
  }
  const bool has_metadata = items.empty() || set_text(tiff, kMetadataTag, "GDALMetadata",
                                                      "<GDALMetadata>\n" + items + "</GDALMetadata>\n");
  const bool has_software =
      metadata.software.empty() || TIFFSetField(tiff, TIFFTAG_SOFTWARE, metadata.software.c_str()) == 1;
  return has_metadata && has_software &&
         (metadata.nodata.empty() || set_text(tiff, kNodataTag, "GDALNoDataValue", metadata.nodata));
}

}  // namespace vpe::core
