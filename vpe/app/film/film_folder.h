// A film as a folder of PNG files, frame_NNNNNN.png, each with its fingerprint and figures inside.
#pragma once

#include "vpe/app/film/film_target.h"

namespace vpe::app {

// Text chunks of a frame's file.
inline constexpr const char* kFingerprintKey = "vpe:fingerprint";
inline constexpr const char* kFiguresKey = "vpe:figures";  // FrameFigures as JSON

std::string frame_file_name(std::int64_t index);

class FilmFolder : public FilmTarget {
 public:
  // `remake`: nothing that is there counts.
  FilmFolder(std::filesystem::path folder, bool remake);

  std::int64_t group_size() const override { return 1; }
  void keep(std::span<FilmFrame> frames, const FilmPlace& place, base::ThreadPool& pool) override;
  void prepare() override;
  void add(std::int64_t group, FilmFrame& frame, const core::Frame& image) override;
  void end_group(std::int64_t, std::span<FilmFrame>) override {}
  void abandon() override {}
  void finish(std::span<FilmFrame>) override {}
  nlohmann::json describe() const override { return nlohmann::json::object(); }

 private:
  void keep(FilmFrame& frame) const;

  std::filesystem::path folder_;
  bool remake_;
};

}  // namespace vpe::app
