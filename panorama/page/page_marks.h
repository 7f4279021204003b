// Names and other panoramas on the web page of a panorama.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "panorama/metadata/sidecar.h"
#include "panorama/projection.h"

namespace panorama {

// A name that stands at a direction.
struct PageName {
  std::string text;
  Direction direction;
  std::optional<double> range_m;
};

// Another panorama's page, which can be entered.
struct PageHotspot {
  PageName name;
  std::string page;  // a relative address, encoded as RFC 3986 says
};

struct PageMarks {
  std::vector<PageName> names;  // the most important first
  std::vector<PageHotspot> hotspots;
};

// Reads these keys of a panorama's JSON; others are ignored, and so is a JSON without them:
//   names     [{"name": "Mount Sharp", "azimuth_deg": 171.2, "elevation_deg": 3.1, "range_m": 14000}, ...]
//   hotspots  the same with "page": the relative address of another page, as "../rim/index.html"
// range_m may be left out. Throws MetadataError: no JSON, a key with another kind of value, a number that is no
// direction, or a page that is not a relative address.
PageMarks read_page_marks(std::string_view json);

// Returns the relative address of `file` for a page in `folder`. Both are paths of this machine; neither needs
// to exist.
std::string address_of(const std::filesystem::path& file, const std::filesystem::path& folder);

// Returns where the camera of another panorama is seen from this one's, on a straight line. Nullopt when one of
// them does not state its altitude, or when they are at the same place.
std::optional<PageName> seen_from(const RecordedViewpoint& here, const RecordedViewpoint& there,
                                  double radius_m);

}  // namespace panorama
