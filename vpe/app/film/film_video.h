// A film as an .mp4, made of segments that are kept in FILE.mp4.parts/ until all are there.
//
//   FILE.mp4.parts/segment_NNNNNN.mp4    kSegment_s of the film, encoded on its own
//   FILE.mp4.parts/segment_NNNNNN.json   its fingerprint, checksum, encoder and the figures of its frames
//   FILE.mp4.json                        the film's manifest: the film is known by it when it is complete
#pragma once

#include <memory>
#include <optional>

#include "vpe/app/film/film_target.h"
#include "vpe/app/film/video.h"

namespace vpe::app {

// A stopped film loses at most a segment; each costs a key frame and a start of ffmpeg, which is some percent
// in size and time at this length.
inline constexpr double kSegment_s = 4;
// At any frame rate: enough frames for an encoder, and not minutes of work.
inline constexpr std::int64_t kFewestSegmentFrames = 8;
inline constexpr std::int64_t kMostSegmentFrames = 240;
std::int64_t segment_frames(const scripts::FrameRate& rate);

std::filesystem::path parts_folder(const std::filesystem::path& film);

class FilmVideo : public FilmTarget {
 public:
  // `manifest` is where the complete film's manifest lies; `remake`: nothing that is there counts. Throws when
  // there is no ffmpeg, unless the film may be complete already.
  FilmVideo(std::filesystem::path film, std::filesystem::path manifest, const VideoFormat& format, bool remake);

  std::int64_t group_size() const override { return group_; }
  void keep(std::span<FilmFrame> frames, const FilmPlace& place, base::ThreadPool& pool) override;
  void prepare() override;
  void add(std::int64_t group, FilmFrame& frame, const core::Frame& image) override;
  void end_group(std::int64_t group, std::span<FilmFrame> frames) override;
  void abandon() override { writer_.reset(); }
  // Joins the segments, unless the film is complete. The segments stay.
  void finish(std::span<FilmFrame> frames) override;
  nlohmann::json describe() const override;

  // The film itself is there and as its manifest says.
  bool is_complete() const { return complete_; }
  // Removes the segments, and the folder when nothing else is in it.
  void remove_parts() const;

 private:
  void remove_stale() const;
  std::filesystem::path segment(std::int64_t group, const char* extension) const;
  std::string fingerprint(std::span<const FilmFrame> frames) const;
  const std::string& encoder();
  bool keep_film(std::span<FilmFrame> frames, const FilmPlace& place);
  void keep_segment(std::int64_t group, std::span<FilmFrame> frames) const;

  std::filesystem::path film_;
  std::filesystem::path manifest_;
  std::filesystem::path folder_;
  VideoFormat format_;
  std::int64_t group_;
  bool remake_;
  bool complete_ = false;
  std::string encoder_;
  std::string checksum_;  // of the complete film
  std::unique_ptr<VideoWriter> writer_;
};

}  // namespace vpe::app
