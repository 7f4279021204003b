// What a product's heights are counted from, where it says so.
#pragma once

#include <optional>
#include <string>

#include "mars/geodesy/datum.h"
#include "mars/raster/pds_label.h"

class GDALDataset;

namespace mars {

// In this order: a PDS3 label's own words; a vertical or three-dimensional coordinate system (WKT); names by
// which archives tell their products apart (a HiRISE DTM named DTE.. is above the areoid, DTR.. a radius,
// USGS's MOLA and HRSC-MOLA mosaics are above the areoid, an HRSC DTM named ..da4.. is above the areoid,
// ..dt4.. above the sphere of 3396 km; HRSC archive SIS, HiRISE DTM README). Unknown otherwise: a plain GeoTIFF
// does not say.
VerticalDatum product_datum(const std::string& path, GDALDataset& dataset,
                            const std::optional<PdsLabel>& label);

// Equatorial radius of the body of its coordinate system; 0 when it has none.
double body_radius_m(GDALDataset& dataset);

}  // namespace mars
