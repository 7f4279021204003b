// A film as an .mp4, made of segments that are kept in FILE.mp4.parts/ until all of them exist.
//
//   FILE.mp4.parts/segment_NNNNNN.mp4    kSegment_s of the film, encoded independently
//   FILE.mp4.parts/segment_NNNNNN.json   its fingerprint, checksum, encoder, and the figures of its frames
//   FILE.mp4.json                        the manifest, which identifies the complete film
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "vpe/app/cli/folder_lock.h"
#include "vpe/app/film/film_target.h"
#include "vpe/app/film/video.h"

namespace vpe::app {

// Length of a segment. Shorter: a stopped film loses less work; longer: fewer key frames and starts of ffmpeg,
// which cost a few percent of size and time at this length.
inline constexpr double kSegment_s = 4;
// Bounds of a segment's length at any frame rate: enough frames for an encoder, but not minutes of work.
inline constexpr std::int64_t kFewestSegmentFrames = 8;
inline constexpr std::int64_t kMostSegmentFrames = 240;

// Returns the number of frames of a segment.
std::int64_t segment_frames(const scripts::FrameRate& rate);

// Returns FILE.mp4.parts.
std::filesystem::path parts_folder(const std::filesystem::path& film);

// Stores a film as a video. A group is one segment.
class FilmVideo : public FilmTarget {
 public:
  // `manifest` is the path of the complete film's manifest. `use` says whether other processes may make other
  // groups at the same time; then none may join them. With `remake`, what is stored is ignored and made again.
  // Throws std::runtime_error when there is no ffmpeg, unless the film may be complete already. Other members
  // throw it if another process makes the film.
  FilmVideo(std::filesystem::path film, std::filesystem::path manifest, const VideoFormat& format,
            FolderLock::Use use, bool remake);

  std::int64_t group_size() const override { return group_; }
  void keep(std::span<FilmFrame> frames, const FilmSlice& slice, base::ThreadPool& pool) override;
  void prepare() override;
  void add(std::int64_t group, FilmFrame& frame, const core::Frame& image) override;
  void end_group(std::int64_t group, std::span<FilmFrame> frames) override;
  void abandon() override { writer_.reset(); }
  // Sets the comment in the metadata of a film that finish() joins.
  void set_comment(const std::string& comment) { format_.comment = comment; }
  // Joins the segments, unless the film is complete. The segments stay.
  void finish(std::span<FilmFrame> frames) override;
  nlohmann::json describe() const override;

  // Returns true if the film exists and agrees with its manifest.
  bool is_complete() const { return complete_; }
  // Removes the segments, and their folder when it holds nothing else.
  void remove_parts() const;

 private:
  void lock();
  void remove_stale() const;
  std::filesystem::path segment(std::int64_t group, const char* extension) const;
  std::string fingerprint(std::span<const FilmFrame> frames) const;
  const std::string& encoder();
  bool keep_film(std::span<FilmFrame> frames, const FilmSlice& slice);
  void keep_segment(std::int64_t group, std::span<FilmFrame> frames) const;

  std::filesystem::path film_;
  std::filesystem::path manifest_;
  std::filesystem::path folder_;
  VideoFormat format_;
  std::int64_t group_;
  FolderLock::Use use_;
  std::unique_ptr<FolderLock> lock_;  // from the moment at which stored segments are read
  bool remake_;
  bool complete_ = false;
  std::string encoder_;
  std::string checksum_;  // of the complete film
  std::unique_ptr<VideoWriter> writer_;
};

}  // namespace vpe::app
