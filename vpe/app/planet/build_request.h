// Request of a build: the sources and options of `vpe build` that its content depends on. A planet file keeps
// them as arguments, so that `vpe patch` can open the same sources.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "paging/build/builder.h"
#include "relief/relief.h"
#include "vpe/app/planet/build_sources.h"
#include "vpe/app/planet/placement_option.h"

namespace vpe::app {

struct BuildRequest {
  std::vector<std::string> dems;  // rasters and files of reliefs
  std::vector<std::string> images;
  std::string
      images_apart;  // empty: composed alone; "stem", or names of layers with ';' between them, by `images`
  bool match_colour = false;
  std::vector<std::string> regions;  // WEST,SOUTH,EAST,NORTH
  SourceArguments sources;
  PlacementArguments placement;
  std::string detail;  // empty, "synthetic" or "none"
  double base_spacing_m = paging::BuildOptions().base_spacing_m;
  double finest_spacing_m = 0;  // 0: that of the rasters
  double finest_image_m = 0;
  double quantum_m = 0;  // 0: chosen from the sources
};

// Declares them as options of a command. DEM is the name of its positional argument.
void add_build_request(CLI::App& command, BuildRequest& request);

// Convert a request to arguments of `vpe build` and back: build_request(to_arguments(r)) equals r. What has its default
// is left out. Throws UsageError for arguments that vpe build does not have.
std::vector<std::string> to_arguments(const BuildRequest& request);
BuildRequest build_request(const std::vector<std::string>& arguments);

// Returns the region of WEST,SOUTH,EAST,NORTH in degrees. Throws UsageError.
paging::Region parse_region(const std::string& text);

// Returns all files of a request; the word `embedded` is none.
std::vector<std::string> files_of(const BuildRequest& request);

// Returns its elevation and image rasters, which options may name.
std::vector<std::string> rasters_of(const BuildRequest& request);

// Holds the opened sources of a request.
struct RequestedSources {
  std::vector<std::shared_ptr<const mars::ElevationSource>>
      dems;                             // the rasters of BuildRequest::dems, as opened
  std::vector<relief::Relief> reliefs;  // the files of reliefs among them
  std::vector<std::shared_ptr<const mars::ImageSource>>
      images;                                      // by BuildRequest::images, with matched colours
  mars::Combined combined;                         // of `dems`, changed by `reliefs`
  std::shared_ptr<const mars::ImageSource> image;  // of `images`; null if there are none
  std::vector<std::string> image_notes;            // sentences for the user about their colours
};

// Opens the sources and sets the options of the build that the request decides. Throws UsageError, mars::SourceError.
RequestedSources open_sources(const BuildRequest& request, paging::BuildOptions& options);

// Prints on stderr, unless quiet, what was found about the colours of images.
void print_image_notes(const RequestedSources& sources, const Common& common);

}  // namespace vpe::app
