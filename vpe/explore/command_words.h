// Words of the commands that make what a session shows: an image, a film, a panorama. Pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vpe/core/backend.h"
#include "vpe/core/stereo.h"
#include "vpe/explore/session.h"

namespace vpe::explore {

// Describes an image or a film that is to be made.
struct MakeOptions {
  std::string planet;  // as the program takes it; empty: the embedded Mars
  std::string output;  // file to write
  int width_px = 0;    // 0: that of the view
  int height_px = 0;
  bool has_overlays = true;              // draws the overlays of the session
  std::optional<core::Backend> backend;  // nullopt: the program chooses
  std::optional<core::StereoLayout> stereo;
  double eye_base_m = 0;     // 0: the program chooses
  double convergence_m = 0;  // 0: infinitely far
};

// Returns the words of `vpe render` for the present view, looking where the image looks. Words do not contain the
// program's name and are not quoted.
std::vector<std::string> image_words(const Session& session, const MakeOptions& options);

// Returns the words of `vpe fly` for a flight, with the settings of the session wherever the flight has none. The
// sizes may be 0: then the flight decides.
std::vector<std::string> film_words(const Session& session, const std::string& flight,
                                    const MakeOptions& options);

// Returns the words of `vpe panorama` around the camera. Of overlays it keeps those that panoramas have: names with
// distances and compass. The width is that of the full circle; 0: the program chooses.
std::vector<std::string> panorama_words(const Session& session, const MakeOptions& options);

// Returns likewise the words for a camera at another place, this high above the ground there, metres.
std::vector<std::string> panorama_words_at(const Session& session, mars::LonLat place, double height_m,
                                           const MakeOptions& options);

// Returns how far `vpe viewshed` looks where nothing else is said, metres: a thousand posts of this spacing, but not less
// than 1 km, and not more than 150 km or a quarter of the planet's circumference.
double usual_reach_m(double post_spacing_m, double planet_radius_m);

// Returns the words of `vpe viewshed` around a place, for an eye this high above the ground. Of the options only planet
// and output count; the posts are those of the planet there.
std::vector<std::string> viewshed_words(mars::LonLat place, double height_m, double reach_m,
                                        const MakeOptions& options);

}  // namespace vpe::explore
