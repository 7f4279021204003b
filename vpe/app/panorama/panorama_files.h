// The files of a panorama: image, auxiliary layers and sidecar, joined from strips.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "panorama/image/strip_file.h"
#include "panorama/planes.h"
#include "vpe/app/panorama/panorama_plan.h"
#include "vpe/app/panorama/panorama_request.h"
#include "vpe/base/parallel.h"

namespace vpe::app {

// Returns the format that the extension names. Throws std::runtime_error for others.
PanoramaFormat panorama_format(const std::filesystem::path& path);

// Return the names of the files beside an image.
std::filesystem::path layer_file(const std::filesystem::path& image, panorama::Plane layer);
std::filesystem::path sidecar_file(const std::filesystem::path& image);
// Returns the folder that holds strips until all are complete, and the name of a strip in it.
std::filesystem::path strips_folder(const std::filesystem::path& image);
std::filesystem::path strip_file(const std::filesystem::path& image, std::size_t number);
// Removes unfinished strips that a killed run left.
void remove_stale_strips(const std::filesystem::path& image);
// Removes all strips, and their folder when it holds nothing else.
void remove_strips(const std::filesystem::path& image);

// Checks that every file can be written, before any work. Throws what check_outputs() throws, and
// std::runtime_error where the format cannot hold the size, or a file of the sidecar's name was not written by
// this program or describes another image.
void check_files(const PanoramaRequest& request, const PanoramaPlan& plan, int memory_mb);

// Removes unfinished files of the image, its layers and its sidecar that a killed run left.
void remove_stale_files(const std::filesystem::path& image);

// Writes layers, image and sidecar, each under a temporary name until all are complete. Calls `done` with the
// share that is ready; it may throw to stop. `sidecar` is its text. Throws base::FileError.
void join_strips(const PanoramaRequest& request, const PanoramaPlan& plan, const std::string& sidecar,
                 const std::vector<panorama::StripFile>& strips, base::ThreadPool& pool,
                 const std::function<void(double)>& done);

}  // namespace vpe::app
