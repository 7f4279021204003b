// Raw images with a PDS label, and those that GDAL cannot read or reads wrongly.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mars/raster/pds_label.h"

namespace mars {

// Where the samples of a label's IMAGE object are and what they mean. Steps and offset in bytes.
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

// True for a label (its own or a detached one) of a plain, uncompressed IMAGE.
bool has_pds_image(const PdsLabel& label);

// Whether GDAL 3.6.2 cannot read the image: labels without PDS_VERSION_ID = PDS3 (all of 1991: SFDU_LABEL); or
// reads it wrongly: LINE_PREFIX_BYTES and LINE_SUFFIX_BYTES (the suffix is left out), integers of 32 bits
// (taken for floating point), UNSIGNED_INTEGER of 16 bits (PDS: most significant byte first; taken for the
// other way round), VAX_REAL (taken for IEEE).
bool gdal_misreads(const PdsLabel& label);

// `path` is the label's file. Names in ^IMAGE are looked for beside it, in any case of letters. SAMPLE_TYPE
// means what the PDS Standards Reference says: without a word for it, the most significant byte comes first.
// Missing samples: MISSING_CONSTANT or MISSING, else 0 in 8 bits and -32768 in signed 16 bits, as GDAL has it.
// Throws SourceError: compressed, of a type without a reader (VAX_REAL, signed 8 bits), cut short, not there.
PdsImage pds_image(const std::string& path, const PdsLabel& label);

// A virtual dataset of the image for GDALOpenEx, without georeference.
std::string pds_vrt(const PdsImage& image);

// Stored values that stand for missing samples, by the label: MISSING_CONSTANT, MISSING, the DTM group of HRSC.
std::vector<double> pds_nodata(const PdsLabel& label);

}  // namespace mars
