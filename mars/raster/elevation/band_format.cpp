#include "mars/raster/elevation/band_format.h"

#include <gdal_priv.h>

#include <cmath>
#include <string>

namespace mars {
namespace {

double metres_per_unit(const std::string& unit) {
  CPLString lower(unit);
  lower.tolower();
  if (lower == "km" || lower == "kilometer" || lower == "kilometre" || lower == "kilometers") return 1000;
  if (lower == "cm" || lower == "centimeter" || lower == "centimetre") return 0.01;
  if (lower == "ft" || lower == "foot" || lower == "feet") return 0.3048;
  return 1;
}

}  // namespace

BandFormat band_format(GDALRasterBand& band, const std::string& path, const NodataValues& special_values,
                       bool is_signed_byte) {
  const GDALColorInterp colour = band.GetColorInterpretation();
  if (band.GetColorTable() != nullptr || colour == GCI_RedBand)
    throw source_error(path, "is a colour image, not elevation", "", "give it as an image (--image)");
  BandFormat format;
  format.type = band.GetRasterDataType();
  format.fits_float = format.type == GDT_Byte || format.type == GDT_Int16 || format.type == GDT_UInt16 ||
                      format.type == GDT_Float32;
  int has_nodata = 0;
  if (format.type == GDT_Int64) {
    const auto value = static_cast<double>(band.GetNoDataValueAsInt64(&has_nodata));
    if (has_nodata != 0) format.nodata_value = value;
  } else if (format.type == GDT_UInt64) {
    const auto value = static_cast<double>(band.GetNoDataValueAsUInt64(&has_nodata));
    if (has_nodata != 0) format.nodata_value = value;
  } else {
    const double value = band.GetNoDataValue(&has_nodata);
    if (has_nodata != 0) format.nodata_value = value;
  }
  // The nodata value of signed bytes may be stated as signed or as stored.
  if (is_signed_byte && format.nodata_value && *format.nodata_value > 127) *format.nodata_value -= 256;
  format.special_values = special_values;
  // A mask derived from the nodata value adds nothing.
  const int mask = band.GetMaskFlags();
  format.masked = (mask & (GMF_ALL_VALID | GMF_NODATA)) == 0;
  const double unit_m = metres_per_unit(band.GetUnitType());
  format.scale = band.GetScale() * unit_m;
  format.offset = band.GetOffset() * unit_m;
  if (!std::isfinite(format.scale) || format.scale == 0 || !std::isfinite(format.offset)) {
    throw source_error(path, "has a scale or offset that is not a usable number", "",
                       "set it with gdal_edit.py -scale -offset");
  }
  return format;
}

BandFormat band_format(const GdalRaster& raster) {
  const GdalScope scope;
  const auto dataset = raster.acquire();
  return band_format(*dataset->GetRasterBand(1), raster.path(), raster.nodata(), raster.is_signed_byte(1));
}

}  // namespace mars
