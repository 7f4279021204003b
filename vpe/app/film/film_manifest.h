// What a run made, as a JSON file beside the film: one line a frame.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "scripts/frame_rate.h"
#include "vpe/app/film/film_frame.h"
#include "vpe/app/film/frame_range.h"

namespace vpe::app {

struct FilmHead {
  std::string program;  // version
  std::string planet;   // identity
  bool illustration = false;
  std::string flight;  // name of its file
  scripts::FrameRate rate;
  int width = 0;
  int height = 0;
  std::string frames;  // --frames as given
  Shard part;
};

// FOLDER/manifest.json of a folder, FILE.mp4.json of a video. A run over some of a folder's frames only, and a
// part, have a name that says so, and so do not take the whole film's place:
// manifest[.frames-A-BxN][.part-K-of-N].json; parts of a video have theirs in `parts`.
std::filesystem::path manifest_of_folder(const std::filesystem::path& folder, const std::string& frames,
                                         const Shard& part);
std::filesystem::path manifest_of_video(const std::filesystem::path& film, const std::filesystem::path& parts,
                                        const Shard& part);

// `target` is what the film's target says of itself. Keys of a frame: index, time_s, fingerprint; checksum (of
// its file, or of the segment it was joined from) and figures; or failed, with the reason; or missing. Throws
// base::FileError.
void write_manifest(const std::filesystem::path& path, const FilmHead& head, const nlohmann::json& target,
                    std::span<const FilmFrame> frames);

// Null when the file is not there, cannot be read or is no JSON.
nlohmann::json read_json(const std::filesystem::path& path);

}  // namespace vpe::app
