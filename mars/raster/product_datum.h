// Vertical datum and body of a product, as far as it states them.
#pragma once

#include <optional>
#include <string>

#include "mars/geodesy/datum.h"
#include "mars/raster/pds_label.h"

class GDALDataset;

namespace mars {

// Returns the datum that the first of these states, else unknown (a plain GeoTIFF states none):
// - the text of a PDS3 label, see pds_datum();
// - a vertical or three-dimensional coordinate system (WKT);
// - the file name, where an archive distinguishes its products by it: a HiRISE DTM named DTE.. is above the
//   areoid, DTR.. a radius; USGS's MOLA and HRSC-MOLA mosaics are above the areoid; an HRSC DTM named ..da4..
//   is above the areoid, ..dt4.. above the sphere of 3396 km (HRSC archive SIS, HiRISE DTM README); a DTM of
//   CTX (USGS ARD) named ..-DEM is above the sphere of 3396.19 km, ..-DEM-geoid-adj above the areoid.
// GdalElevation takes values above 1e6 m for radii, whatever this returns.
struct ProductDatum {
  VerticalDatum datum;
  bool by_name = false;  // the file name alone states it
};
ProductDatum product_datum(const std::string& path, GDALDataset& dataset, const std::optional<PdsLabel>& label);

// Returns the equatorial radius of the body of the dataset's coordinate system, 0 if it has none.
double body_radius_m(GDALDataset& dataset);

// Returns the name of the body that a label (PDS3, PDS4, ISIS) or the names of the coordinate system and its datum
// state, "" if they state none: as bodies() has it if it is known there.
std::string body_name(GDALDataset& dataset, const std::optional<PdsLabel>& label);

}  // namespace mars
