#include "vpe/app/film/film_target.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "vpe/app/cli/digest.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/output.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/base/temporary.h"
#include "vpe/core/image/image.h"
#include "vpe/core/image/png_text.h"
#include "vpe/core/json_text.h"

namespace vpe::app {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uintmax_t kMostFrameBytes = std::uintmax_t{1} << 32;

const std::string* find(const std::vector<core::PngText>& texts, const char* keyword) {
  const auto found =
      std::find_if(texts.begin(), texts.end(), [&](const core::PngText& t) { return t.keyword == keyword; });
  return found == texts.end() ? nullptr : &found->text;
}

// Returns true for names that frame_file_name() makes.
bool is_frame_name(const std::string& name) {
  constexpr std::string_view kBegin = "frame_";
  constexpr std::string_view kEnd = ".png";
  if (!name.starts_with(kBegin) || !name.ends_with(kEnd) || name.size() < kBegin.size() + 6 + kEnd.size())
    return false;
  return std::all_of(name.begin() + kBegin.size(), name.end() - kEnd.size(),
                     [](char c) { return c >= '0' && c <= '9'; });
}

bool is_manifest_name(const std::string& name) {
  return name.starts_with("manifest.") && name.ends_with(".json");
}

}  // namespace

std::string frame_file_name(std::int64_t index) {
  std::array<char, 40> name{};
  std::snprintf(name.data(), name.size(), "frame_%06lld.png", static_cast<long long>(index));
  return name.data();
}

void check_frame_files(const fs::path& folder, const FrameRange& range) {
  constexpr std::size_t kNumberAt = 6;  // in frame_000000.png
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!is_frame_name(name)) continue;
    const auto index = base::parse_integer(name.substr(kNumberAt, name.size() - kNumberAt - 4));
    if (!index || *index < range.first || *index > range.last || (*index - range.first) % range.step != 0)
      continue;
    if (name == frame_file_name(*index)) check_kind(entry->path(), FileKind::kFrame);
  }
}

FilmFolder::FilmFolder(fs::path folder, bool remake) : folder_(std::move(folder)), remake_(remake) {}

void FilmFolder::keep(std::span<FilmFrame> frames, const FilmSlice& /*slice*/, base::ThreadPool& pool) {
  if (remake_) return;
  pool.run(frames.size(), [&](std::size_t n) {
    InterruptGuard::check();
    keep(frames[n]);
  });
}

void FilmFolder::keep(FilmFrame& frame) const {
  const fs::path file = folder_ / frame_file_name(frame.index);
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return;
  try {
    const std::vector<std::uint8_t> bytes = base::read_file(file, kMostFrameBytes);
    const auto texts = core::read_png_text(bytes);
    if (!texts) return;
    const std::string* fingerprint = find(*texts, kFingerprintKey);
    const std::string* figures = find(*texts, kFiguresKey);
    if (fingerprint == nullptr || figures == nullptr || *fingerprint != frame.fingerprint) return;
    const auto read = figures_from(json::parse(*figures, nullptr, false));
    if (!read) return;
    core::decode_png(bytes);  // throws where the pixels do not unpack
    frame.figures = *read;
    frame.checksum = checksum_of(bytes);
    frame.state = FilmFrame::State::kKept;
  } catch (const core::ImageError&) {
  } catch (const base::FileError&) {  // the frame is made again; writing it reports what is wrong
  }
}

void FilmFolder::prepare() {
  make_folder(folder_);
  base::remove_stale_temporaries(
      folder_, [](const std::string& name) { return is_frame_name(name) || is_manifest_name(name); });
}

void FilmFolder::add(std::int64_t /*group*/, FilmFrame& frame, const core::Frame& image) {
  const std::vector<core::PngText> texts{{kFingerprintKey, frame.fingerprint},
                                         {kFiguresKey, core::json_text(to_json(frame.figures))}};
  const auto bytes = core::with_png_text(core::encode_png(image.colour, image.width, image.height), texts);
  base::write_file(folder_ / frame_file_name(frame.index), bytes);
  frame.checksum = checksum_of(bytes);
  frame.state = FilmFrame::State::kMade;
}

json FilmFolder::describe() const { return json::object(); }

}  // namespace vpe::app
