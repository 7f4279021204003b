// Raw images described by a PDS label, including those that GDAL cannot read or misreads.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mars/raster/pds_label.h"

namespace mars {

// Describes location and meaning of the samples of a label's IMAGE object. Steps and offset are in bytes.
struct PdsImage {
  std::string data_path;
  std::int64_t offset = 0;
  std::int64_t sample_step = 0;
  std::int64_t line_step = 0;
  std::int64_t band_step = 0;
  int columns = 0;
  int rows = 0;
  int bands = 1;
  std::string type;  // GDAL's name: Byte, Int16, UInt16, Int32, UInt32, Float32, Float64
  bool big_endian = true;
  double scale = 1;
  double shift = 0;  // value = shift + scale * stored
  std::string unit;
  std::optional<double> nodata;  // stored
};

// Returns true for an attached or detached label of a plain, uncompressed IMAGE.
bool has_pds_image(const PdsLabel& label);

// Returns true if GDAL 3.6.2 cannot read the image: labels without PDS_VERSION_ID = PDS3 (all of 1991:
// SFDU_LABEL); or if it misreads the image: LINE_PREFIX_BYTES and LINE_SUFFIX_BYTES (it ignores the suffix),
// integers of 32 bits (taken for floating point), UNSIGNED_INTEGER of 16 bits (most significant byte first in
// PDS; taken for the opposite), VAX_REAL (taken for IEEE).
bool gdal_misreads(const PdsLabel& label);

// Describes the image of a label. `path` is the label's file; names in ^IMAGE are searched beside it, in upper
// and lower case. SAMPLE_TYPE is read by the PDS Standards Reference: unless it says otherwise, the most
// significant byte comes first. Nodata is MISSING_CONSTANT or MISSING, else 0 for 8 bits and -32768 for signed
// 16 bits, as in GDAL. Throws SourceError if the image is compressed, of an unsupported type (VAX_REAL, signed
// 8 bits), cut short or absent.
PdsImage pds_image(const std::string& path, const PdsLabel& label);

// Returns a virtual dataset of the image for GDALOpenEx, without georeference.
std::string pds_vrt(const PdsImage& image);

// Returns the stored values that the label declares missing: MISSING_CONSTANT, MISSING, INVALID_CONSTANT, and
// the DTM group of HRSC.
std::vector<double> pds_nodata(const PdsLabel& label);

}  // namespace mars
