// Reads the keywords of labels that GDAL hands over as a whole.
#pragma once

#include <vector>

#include "mars/sources/own_light.h"

class GDALDataset;

namespace mars {

// Returns the keywords of the ISIS3 or PDS4 label of a dataset, in their order in the label; empty if it has neither. Groups
// and areas are left out: each keyword stands with its own name alone. An Observing_System_Component of type Instrument in a
// PDS4 label is INSTRUMENT_NAME besides.
std::vector<LabelKeyword> label_keywords(GDALDataset& dataset);

}  // namespace mars
