// Results of a run over a film: the manifest beside the film, and the summary for the user.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scripts/frame_rate.h"
#include "vpe/app/film/film_frame.h"
#include "vpe/app/film/film_plan.h"
#include "vpe/app/planet/shard_option.h"

namespace vpe::app {

// The manifest's description of the run.
struct ManifestHead {
  std::string program;  // version
  std::string planet;   // identity
  bool illustration = false;
  std::string synthetic;  // mars::synthetic_statement() of the planet
  std::string flight;     // name of its file
  scripts::FrameRate rate;
  int width = 0;
  int height = 0;
  std::string frames;  // --frames as given
  Shard shard;
  std::vector<FilmPalette> palettes;  // ends that were taken from the views
  std::vector<std::string> ground;    // what changes the ground, scripts::GroundTracks::names()
};

// Return the manifest's path: FOLDER/manifest.json for a folder, FILE.mp4.json for a video. A run over a part
// of the film, or over some of a folder's frames, has a name that says so and does not replace the whole film's
// manifest: manifest[.frames-A-BxN][.part-K-of-N].json. For parts of a video, it lies in the folder `parts`.
std::filesystem::path manifest_of_folder(const std::filesystem::path& folder, const std::string& frames,
                                         const Shard& shard);
std::filesystem::path manifest_of_video(const std::filesystem::path& film, const std::filesystem::path& parts,
                                        const Shard& shard);

// Writes a manifest as JSON, one line per frame. `target` holds the keys of FilmTarget::describe(). A frame has
// the keys index, time_s and fingerprint; then checksum (of its file, or of the segment it was joined from) and
// figures, or failed with the reason, or missing. Throws base::FileError.
void write_manifest(const std::filesystem::path& path, const ManifestHead& head, const nlohmann::json& target,
                    std::span<const FilmFrame> frames);

// Returns the content of a JSON file, or null when it does not exist, cannot be read or is not JSON.
nlohmann::json read_json(const std::filesystem::path& path);

// How a film's frames are grouped, for messages about frames that are missing.
struct FilmKind {
  bool is_video = false;
  std::int64_t group_size = 1;
};

// Returns text such as "12 of 20 frames are there; the same command continues".
std::string progress_text(const FilmKind& kind, std::span<const FilmFrame> frames);

// Returns a message with the first few failed frames, why they failed, and what to do.
std::string failure_text(const FilmKind& kind, const std::string& output, std::span<const FilmFrame> frames);

// Returns the largest n of manifests of parts k of n of these frames in `folder`, where runs over parts leave
// theirs; nullopt if there are none.
std::optional<std::int64_t> parts_begun(const std::filesystem::path& folder, const std::string& frames);

// Returns text such as "48 of 240 frames are missing: 24-47, 216-239 (parts 2 and 10 of 10)", for all frames of a
// film. The parts are named if the film was divided into `parts`.
std::string missing_text(const FilmKind& kind, std::span<const FilmFrame> frames,
                         std::optional<std::int64_t> parts);

// Returns the keys frames, made, kept, failed, seconds, shift_bound_px (the largest), carried_share (the mean) and
// mean_triangles.
nlohmann::json summary_json(std::span<const FilmFrame> frames, double seconds);

// Returns text such as "20 frames (12 made, 8 kept), 31.2 frames/s, geometry within 0.98 px". Where pixels are
// carried it ends in their share.
std::string summary_text(std::span<const FilmFrame> frames, double seconds);

}  // namespace vpe::app
