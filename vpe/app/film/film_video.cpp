#include "vpe/app/film/film_video.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "vpe/app/cli/digest.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/film/film_summary.h"
#include "vpe/base/file.h"
#include "vpe/base/temporary.h"
#include "vpe/core/json_text.h"

namespace vpe::app {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::string_view kBegin = "segment_";

std::string segment_name(std::int64_t group, const char* extension) {
  std::array<char, 48> name{};
  std::snprintf(name.data(), name.size(), "segment_%06lld%s", static_cast<long long>(group), extension);
  return name.data();
}

bool is_ours(const std::string& name) {
  if (name.starts_with("manifest.") && name.ends_with(".json")) return true;
  if (name == "join.txt") return true;
  if (!name.starts_with(kBegin)) return false;
  const std::size_t end = name.find_first_not_of("0123456789", kBegin.size());
  if (end == std::string::npos || end < kBegin.size() + 6) return false;
  const std::string rest = name.substr(end);
  return rest == ".mp4" || rest == ".json";
}

bool has_text(const json& object, const char* key, const std::string& text) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() && found->get_ref<const std::string&>() == text;
}

// Returns true if the object holds the checksum of the file as it is now.
bool fits_checksum(const json& object, const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && has_text(object, "checksum", checksum_of(file));
}

// Marks the frames as kept, with their figures, if the list holds equal frames from `first` on.
bool mark_kept(std::span<FilmFrame> frames, const json& list, std::size_t first) {
  if (!list.is_array() || list.size() < first + frames.size()) return false;
  std::vector<FrameFigures> all;
  for (std::size_t n = 0; n < frames.size(); ++n) {
    const json& entry = list[first + n];
    if (!entry.is_object() || !has_text(entry, "fingerprint", frames[n].fingerprint)) return false;
    const auto figures = figures_from(entry.value("figures", json()));
    if (!figures) return false;
    all.push_back(*figures);
  }
  for (std::size_t n = 0; n < frames.size(); ++n) {
    frames[n].figures = all[n];
    frames[n].checksum = list[first + n].value("checksum", std::string());
    frames[n].state = FilmFrame::State::kKept;
  }
  return true;
}

}  // namespace

std::int64_t segment_frames(const scripts::FrameRate& rate) {
  const double wanted =
      kSegment_s * static_cast<double>(rate.numerator) / static_cast<double>(rate.denominator);
  return std::clamp(static_cast<std::int64_t>(std::llround(wanted)), kFewestSegmentFrames, kMostSegmentFrames);
}

fs::path parts_folder(const fs::path& film) { return film.string() + ".parts"; }

FilmVideo::FilmVideo(fs::path film, fs::path manifest, const VideoFormat& format, FolderLock::Use use,
                     bool remake)
    : film_(std::move(film)),
      manifest_(std::move(manifest)),
      folder_(parts_folder(film_)),
      format_(format),
      group_(segment_frames(format.rate)),
      use_(use),
      remake_(remake) {
  check_video_format(film_, format_);
  std::error_code error;
  if (remake_ || !fs::exists(manifest_, error)) encoder();
}

const std::string& FilmVideo::encoder() {
  if (encoder_.empty()) encoder_ = encoder_version(film_);
  return encoder_;
}

fs::path FilmVideo::segment(std::int64_t group, const char* extension) const {
  return folder_ / segment_name(group, extension);
}

std::string FilmVideo::fingerprint(std::span<const FilmFrame> frames) const {
  Digest digest;
  digest.add(encoder_settings(format_));
  for (const FilmFrame& f : frames) digest.add(f.fingerprint);
  return digest.hex();
}

void FilmVideo::lock() {
  if (!lock_) lock_ = std::make_unique<FolderLock>(folder_, use_, film_);
}

void FilmVideo::keep(std::span<FilmFrame> frames, const FilmSlice& slice, base::ThreadPool& pool) {
  if (remake_ || keep_film(frames, slice) || !fs::exists(folder_)) return;
  lock();
  encoder();
  const auto size = static_cast<std::size_t>(group_);
  pool.run((frames.size() + size - 1) / size, [&](std::size_t n) {
    InterruptGuard::check();
    const std::size_t begin = n * size;
    keep_segment(slice.first / group_ + static_cast<std::int64_t>(n),
                 frames.subspan(begin, std::min(size, frames.size() - begin)));
  });
}

bool FilmVideo::keep_film(std::span<FilmFrame> frames, const FilmSlice& slice) {
  const json manifest = read_json(manifest_);
  if (!manifest.is_object()) return false;
  const json film = manifest.value("film", json());
  const json list = manifest.value("frames", json());
  if (!film.is_object() || !has_text(film, "encoder_settings", encoder_settings(format_))) return false;
  if (!list.is_array() || list.size() != static_cast<std::size_t>(slice.all)) return false;
  if (!fits_checksum(film, film_)) return false;
  if (!mark_kept(frames, list, static_cast<std::size_t>(slice.first))) return false;
  checksum_ = film["checksum"];
  complete_ = true;
  return true;
}

void FilmVideo::keep_segment(std::int64_t group, std::span<FilmFrame> frames) const {
  const json sidecar = read_json(segment(group, ".json"));
  if (!sidecar.is_object() || !has_text(sidecar, "fingerprint", fingerprint(frames))) return;
  if (!has_text(sidecar, "encoder", encoder_) || !fits_checksum(sidecar, segment(group, ".mp4"))) return;
  mark_kept(frames, sidecar.value("frames", json()), 0);
}

void FilmVideo::prepare() {
  encoder();
  lock();
  remove_stale();
}

void FilmVideo::remove_stale() const {
  base::remove_stale_temporaries(folder_, is_ours);
  const fs::path beside = film_.has_parent_path() ? film_.parent_path() : fs::path(".");
  base::remove_stale_temporaries(beside,
                                 [film = film_.filename().string(), manifest = manifest_.filename().string()](
                                     const std::string& name) { return name == film || name == manifest; });
}

void FilmVideo::add(std::int64_t group, FilmFrame& /*frame*/, const core::Frame& image) {
  if (!writer_) writer_ = std::make_unique<VideoWriter>(segment(group, ".mp4"), format_);
  writer_->add(image);
}

void FilmVideo::end_group(std::int64_t group, std::span<FilmFrame> frames) {
  writer_->close();
  writer_.reset();
  // After a kill before the sidecar is written, no sidecar fits the segment, and it is made again.
  const std::string checksum = checksum_of(segment(group, ".mp4"));
  json sidecar{{"fingerprint", fingerprint(frames)},
               {"encoder", encoder_},
               {"checksum", checksum},
               {"frames", json::array()}};
  for (FilmFrame& f : frames) {
    f.checksum = checksum;
    sidecar["frames"].push_back(
        {{"fingerprint", f.fingerprint}, {"checksum", f.checksum}, {"figures", to_json(f.figures)}});
  }
  base::write_file(segment(group, ".json"), core::json_text(sidecar) + "\n");
  for (FilmFrame& f : frames) f.state = FilmFrame::State::kMade;
}

void FilmVideo::finish(std::span<FilmFrame> frames) {
  if (complete_) return;
  lock();
  encoder();
  const auto all = static_cast<std::int64_t>(frames.size());
  std::vector<VideoSegment> segments;
  for (std::int64_t begin = 0; begin < all; begin += group_) {
    segments.push_back({segment_name(begin / group_, ".mp4"), std::min(group_, all - begin)});
  }
  join_video(folder_, segments, format_, film_);
  checksum_ = checksum_of(film_);
  complete_ = true;
}

json FilmVideo::describe() const {
  if (!complete_) return {{"segment_frames", group_}};
  return {{"segment_frames", group_},
          {"film",
           {{"file", film_.filename().string()},
            {"checksum", checksum_},
            {"encoder_settings", encoder_settings(format_)}}}};
}

void FilmVideo::remove_parts() const {
  std::error_code error;
  remove_stale();
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    if (is_ours(entry->path().filename().string())) files.push_back(entry->path());
  }
  for (const fs::path& file : files) fs::remove(file, error);
  fs::remove(folder_, error);  // fails when it holds other files
}

}  // namespace vpe::app
