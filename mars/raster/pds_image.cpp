#include "mars/raster/pds_image.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "mars/raster/gdal/gdal_scope.h"

namespace mars {
namespace {

const char* const kConvert = "convert it to GeoTIFF first, e.g. with ISIS (pds2isis, then gdal_translate)";

std::string upper(const std::string& text) {
  CPLString result(text);
  return result.toupper();
}

// Returns a whole number from `least` to `most`, or the default if the label has none. Throws SourceError.
std::int64_t whole(const std::string& path, const PdsLabel& label, const std::string& key, std::int64_t least,
                   std::int64_t most, std::optional<std::int64_t> otherwise = std::nullopt) {
  if (label.text(key).empty() && otherwise) return *otherwise;
  const auto value = label.number(key);
  if (!value || *value != std::floor(*value) || *value < static_cast<double>(least) ||
      *value > static_cast<double>(most)) {
    throw source_error(path, "its label has no usable " + key, label.text(key), "check the label");
  }
  return static_cast<std::int64_t>(*value);
}

struct Pointer {
  std::string file;  // empty: the label's file
  std::int64_t place = 1;
  bool in_bytes = false;
};

// Parses 14, 5594 <BYTES>, "A.IMG", A.IMG, ("A.IMG", 3), ("A.IMG", 5 <BYTES>).
std::optional<Pointer> parse_pointer(std::string text) {
  Pointer pointer;
  if (text.size() >= 2 && text.front() == '(' && text.back() == ')') text = text.substr(1, text.size() - 2);
  const CPLStringList parts(
      CSLTokenizeString2(text.c_str(), ",", CSLT_HONOURSTRINGS | CSLT_STRIPLEADSPACES | CSLT_STRIPENDSPACES));
  for (int i = 0; i < parts.size(); ++i) {
    std::string part = parts[i];
    part.erase(std::remove(part.begin(), part.end(), '\''), part.end());
    std::int64_t number = 0;
    const auto [rest, error] = std::from_chars(part.data(), part.data() + part.size(), number);
    const std::string tail = upper(part.substr(static_cast<std::size_t>(rest - part.data())));
    const bool bytes = tail.find("<BYTES>") != std::string::npos;
    if (error == std::errc() && (bytes || tail.find_first_not_of(" \t\r\n") == std::string::npos)) {
      if (number < 1) return std::nullopt;
      pointer.place = number;
      pointer.in_bytes = bytes;
    } else if (i == 0 && !part.empty()) {
      pointer.file = part;
    } else {
      return std::nullopt;
    }
  }
  if (parts.empty()) return std::nullopt;
  return pointer;
}

std::string find_beside(const std::string& label_path, const std::string& name) {
  const std::string folder = CPLGetPath(label_path.c_str());
  CPLString lower(name);
  CPLString capital(name);
  lower.tolower();
  capital.toupper();
  for (const std::string& each : {name, std::string(lower), std::string(capital)}) {
    std::string path = CPLFormFilename(folder.c_str(), CPLGetFilename(each.c_str()), nullptr);
    VSIStatBufL stat{};
    if (VSIStatExL(path.c_str(), &stat, VSI_STAT_EXISTS_FLAG) == 0) return path;
  }
  throw source_error(label_path, "its label names an image that does not exist", name,
                     "put both into one folder");
}

std::int64_t file_size(const std::string& path) {
  VSIStatBufL stat{};
  if (VSIStatExL(path.c_str(), &stat, VSI_STAT_EXISTS_FLAG | VSI_STAT_SIZE_FLAG) != 0) return 0;
  return static_cast<std::int64_t>(stat.st_size);
}

bool says(const std::string& text, const char* word) { return text.find(word) != std::string::npos; }

std::string data_type(const std::string& path, const std::string& sample_type, std::int64_t bits) {
  const std::string advice = "of type " + sample_type + " in " + std::to_string(bits) + " bits";
  if (says(sample_type, "REAL") || says(sample_type, "FLOAT")) {
    if (!says(sample_type, "VAX") && bits == 32) return "Float32";
    if (!says(sample_type, "VAX") && bits == 64) return "Float64";
  } else {
    const bool is_unsigned = says(sample_type, "UNSIGNED");
    const bool is_signed = says(sample_type, "INTEGER") && !is_unsigned;
    if (bits == 8 && !is_signed) return "Byte";
    if (bits == 16) return is_unsigned ? "UInt16" : "Int16";
    if (bits == 32) return is_unsigned ? "UInt32" : "Int32";
  }
  throw source_error(path, "holds samples that cannot be read", advice, kConvert);
}

// Parses 12, -1.5E3, 16#FF7FFFFB# (the bits of a sample).
std::optional<double> constant(const PdsLabel& label, const std::string& key) {
  if (const auto value = label.number(key)) return value;
  const std::string text = label.text(key);
  if (text.size() < 5 || text.compare(0, 3, "16#") != 0 || text.back() != '#') return std::nullopt;
  std::uint64_t bits = 0;
  const char* end = text.data() + text.size() - 1;
  const auto [rest, error] = std::from_chars(text.data() + 3, end, bits, 16);
  if (error != std::errc() || rest != end) return std::nullopt;
  const auto sample_bits = label.number("IMAGE.SAMPLE_BITS");
  const std::string type = upper(label.text("IMAGE.SAMPLE_TYPE"));
  // Bit patterns of floating point stand for magnitudes beyond any height, which readers reject anyway.
  if (says(type, "REAL") || says(type, "FLOAT") || bits > std::numeric_limits<std::uint32_t>::max())
    return std::nullopt;
  if (sample_bits == 16.0 && !says(type, "UNSIGNED")) return static_cast<std::int16_t>(bits);
  if (sample_bits == 32.0 && !says(type, "UNSIGNED")) return static_cast<std::int32_t>(bits);
  return static_cast<double>(bits);
}

}  // namespace

bool has_pds_image(const PdsLabel& label) {
  return !label.text("^IMAGE").empty() && label.number("IMAGE.LINES") && label.number("IMAGE.LINE_SAMPLES") &&
         label.number("IMAGE.SAMPLE_BITS");
}

bool gdal_misreads(const PdsLabel& label) {
  if (!has_pds_image(label)) return false;
  const auto number = [&](const char* key) { return label.number(std::string("IMAGE.") + key).value_or(0.0); };
  const std::string type = upper(label.text("IMAGE.SAMPLE_TYPE"));
  const bool real = says(type, "REAL") || says(type, "FLOAT");
  return upper(label.text("PDS_VERSION_ID")) != "PDS3" || number("LINE_PREFIX_BYTES") != 0 ||
         number("LINE_SUFFIX_BYTES") != 0 || (!real && number("SAMPLE_BITS") == 32) ||
         (type == "UNSIGNED_INTEGER" && number("SAMPLE_BITS") == 16) || (real && says(type, "VAX"));
}

PdsImage pds_image(const std::string& path, const PdsLabel& label) {
  const GdalScope scope;
  constexpr std::int64_t kMost = std::numeric_limits<int>::max();
  const std::string encoding = upper(label.text("IMAGE.ENCODING_TYPE"));
  if (!encoding.empty() && encoding != "N/A" && encoding != "NONE") {
    throw source_error(path, "is compressed", encoding, kConvert);
  }
  const auto pointer = parse_pointer(label.text("^IMAGE"));
  if (!pointer)
    throw source_error(path, "its label has no usable ^IMAGE", label.text("^IMAGE"), "check the label");

  PdsImage image;
  image.data_path = pointer->file.empty() ? path : find_beside(path, pointer->file);
  image.columns = static_cast<int>(whole(path, label, "IMAGE.LINE_SAMPLES", 1, kMost));
  image.rows = static_cast<int>(whole(path, label, "IMAGE.LINES", 1, kMost));
  image.bands = static_cast<int>(whole(path, label, "IMAGE.BANDS", 1, 1000, 1));
  const std::int64_t bits = whole(path, label, "IMAGE.SAMPLE_BITS", 1, 64);
  const std::string sample_type = upper(label.text("IMAGE.SAMPLE_TYPE"));
  image.type = data_type(path, sample_type, bits);
  image.big_endian = !says(sample_type, "LSB") && !says(sample_type, "PC_") && !says(sample_type, "VAX");

  const std::int64_t size = bits / 8;
  const std::int64_t prefix = whole(path, label, "IMAGE.LINE_PREFIX_BYTES", 0, kMost, 0);
  const std::int64_t suffix = whole(path, label, "IMAGE.LINE_SUFFIX_BYTES", 0, kMost, 0);
  const std::int64_t record = whole(path, label, "RECORD_BYTES", 0, kMost, 0);
  if (!pointer->in_bytes && pointer->place > 1 && record == 0) {
    throw source_error(path, "its label has no usable RECORD_BYTES", label.text("RECORD_BYTES"),
                       "check the label");
  }
  if (pointer->place > std::numeric_limits<std::int64_t>::max() / 2 / std::max<std::int64_t>(record, 1)) {
    throw source_error(path, "its label has no usable ^IMAGE", label.text("^IMAGE"), "check the label");
  }
  const std::int64_t start = (pointer->place - 1) * (pointer->in_bytes ? 1 : std::max<std::int64_t>(record, 1));
  const std::string storage = upper(label.text("IMAGE.BAND_STORAGE_TYPE"));
  const bool by_line = image.bands > 1 && says(storage, "LINE");
  const bool by_sample = image.bands > 1 && says(storage, "SAMPLE");
  const std::int64_t samples = std::int64_t{image.columns} * (by_line || by_sample ? image.bands : 1);
  image.sample_step = size * (by_sample ? image.bands : 1);
  image.line_step = prefix + samples * size + suffix;
  const std::int64_t length = file_size(image.data_path);
  // Lines may be padded to whole records.
  if (record > image.line_step &&
      length == start + record * image.rows * (by_line || by_sample ? 1 : image.bands)) {
    image.line_step = record;
  }
  image.band_step = by_sample ? size : by_line ? size * image.columns : image.line_step * image.rows;
  image.offset = start + prefix;
  const double needed = static_cast<double>(image.offset) +
                        static_cast<double>(image.line_step) * (image.rows - 1) +
                        static_cast<double>(image.sample_step) * (image.columns - 1) +
                        static_cast<double>(image.band_step) * (image.bands - 1) + static_cast<double>(size);
  if (static_cast<double>(length) < needed) {
    std::ostringstream words;
    words << length << " of " << std::setprecision(20) << needed << " bytes";
    throw source_error(image.data_path, "is cut short", words.str(), "fetch it again");
  }
  image.scale = label.number("IMAGE.SCALING_FACTOR").value_or(1.0);
  image.shift = label.number("IMAGE.OFFSET").value_or(0.0);
  image.unit = label.text("IMAGE.UNIT");
  const std::vector<double> nodata = pds_nodata(label);
  if (!nodata.empty()) {
    image.nodata = nodata.front();
  } else if (image.type == "Byte") {
    image.nodata = 0;
  } else if (image.type == "Int16") {
    image.nodata = -32768;
  }
  return image;
}

std::vector<double> pds_nodata(const PdsLabel& label) {
  std::vector<double> values;
  for (const char* key :
       {"IMAGE.MISSING_CONSTANT", "IMAGE.MISSING", "IMAGE.INVALID_CONSTANT", "MEX:DTM.MEX:DTM_MISSING_DN"}) {
    if (const auto value = constant(label, key)) values.push_back(*value);
  }
  return values;
}

std::string pds_vrt(const PdsImage& image) {
  std::ostringstream xml;
  xml << std::setprecision(17) << "<VRTDataset rasterXSize=\"" << image.columns << "\" rasterYSize=\""
      << image.rows << "\">";
  const auto escape = [](const std::string& text) {
    char* escaped = CPLEscapeString(text.c_str(), static_cast<int>(text.size()), CPLES_XML);
    std::string result = escaped;
    CPLFree(escaped);
    return result;
  };
  for (int band = 0; band < image.bands; ++band) {
    xml << "<VRTRasterBand dataType=\"" << image.type << "\" band=\"" << band + 1
        << "\" subClass=\"VRTRawRasterBand\">";
    if (image.nodata) xml << "<NoDataValue>" << *image.nodata << "</NoDataValue>";
    if (!image.unit.empty()) xml << "<UnitType>" << escape(image.unit) << "</UnitType>";
    xml << "<Offset>" << image.shift << "</Offset><Scale>" << image.scale
        << "</Scale><SourceFilename relativeToVRT=\"0\">" << escape(image.data_path)
        << "</SourceFilename><ImageOffset>" << image.offset + band * image.band_step
        << "</ImageOffset><PixelOffset>" << image.sample_step << "</PixelOffset><LineOffset>" << image.line_step
        << "</LineOffset><ByteOrder>" << (image.big_endian ? "MSB" : "LSB") << "</ByteOrder></VRTRasterBand>";
  }
  xml << "</VRTDataset>";
  return xml.str();
}

}  // namespace mars
