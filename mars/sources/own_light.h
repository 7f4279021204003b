// Tells from a product's label whether its image is a photograph that holds the light of its own sun.
#pragma once

#include <span>
#include <string>
#include <utility>

namespace mars {

// The name of a keyword of a label and its value as text. Of the name only letters and digits behind the last point count, in
// either case: INSTRUMENT_ID, InstrumentId and IMAGE.INSTRUMENT_ID are one name.
using LabelKeyword = std::pair<std::string, std::string>;

// Returns true if the keywords of a PDS3, PDS4 or ISIS label say that the product is an image of a camera in sunlight. They
// do if one of these holds:
// - INSTRUMENT_NAME, INSTRUMENT_ID or DETECTOR_ID has the word camera, imager or imaging, or the name of a known camera
//   (CTX, HIRISE, HRSC, ...);
// - INCIDENCE_ANGLE, SOLAR_INCIDENCE_ANGLE or SUB_SOLAR_AZIMUTH is a number from -360 to 360;
// - SOLAR_LONGITUDE is such a number, and START_TIME or START_DATE_TIME is a time.
// They do not, whatever else they say, if one of these holds:
// - the instrument sends its own waves or sees heat: its words have radar, laser, altimeter and the like, or thermal or
//   THEMIS without VIS;
// - a keyword that begins with PHOTOMETRIC_CORRECTION or PHOTOMETRIC_NORMALI says anything but none, no or unknown;
// - NAME, TITLE, PRODUCT_NAME, PRODUCT_TYPE, DATA_SET_NAME, DESCRIPTION or NOTE says albedo, normalized or photometrically;
// - the product has heights: NAME, TITLE, PRODUCT_NAME or PRODUCT_TYPE has a word such as DTM, topography or elevation, UNIT is
//   a length, or there is DTM_MISSING_DN.
// Ignores what a label says about the place, as RATIONALE_DESC does. Where words may mean either, the result is false.
bool says_own_light(std::span<const LabelKeyword> keywords);

}  // namespace mars
