#include "vpe/app/film/film_summary.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/core/json_text.h"

namespace vpe::app {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uintmax_t kMostManifestBytes = std::uintmax_t{1} << 32;

std::string part_name(const Shard& shard) {
  return shard.of == 1 ? "" : ".part-" + std::to_string(shard.number) + "-of-" + std::to_string(shard.of);
}

std::string line(const json& value) { return core::json_text(value); }

json frame_json(const FilmFrame& frame) {
  json out{{"index", frame.index}, {"time_s", frame.time_s}, {"fingerprint", frame.fingerprint}};
  if (!frame.ground.empty()) out["ground"] = frame.ground;
  if (frame.is_done()) {
    out["figures"] = to_json(frame.figures);
    if (!frame.checksum.empty()) out["checksum"] = frame.checksum;
  } else if (frame.state == FilmFrame::State::kFailed) {
    out["failed"] = frame.error;
  } else {
    out["missing"] = true;
  }
  return out;
}

constexpr std::int64_t kNamedFailures = 5;

std::string frames_text(std::int64_t n) { return std::to_string(n) + (n == 1 ? " frame" : " frames"); }

// Returns the first words, separated by commas, and how many more there are.
std::string list_text(std::span<const std::string> words) {
  constexpr std::size_t kNamedWords = 20;
  std::string text;
  for (const std::string& word : words.first(std::min(kNamedWords, words.size())))
    text += (text.empty() ? "" : ", ") + word;
  if (words.size() > kNamedWords) text += " and " + std::to_string(words.size() - kNamedWords) + " more";
  return text;
}

// Largest bound, mean number of triangles and mean share of carried pixels over the frames that are done.
struct FilmFigures {
  double shift_bound_px = 0;
  std::int64_t mean_triangles = 0;
  double carried_share = 0;
};

FilmFigures figures_of(std::span<const FilmFrame> frames) {
  FilmFigures out;
  std::int64_t done = 0;
  for (const FilmFrame& f : frames) {
    if (!f.is_done()) continue;
    ++done;
    out.shift_bound_px = std::max(out.shift_bound_px, f.figures.certificate.shift_bound_px);
    out.mean_triangles += f.figures.stats.triangles;
    if (const auto& carried = f.figures.certificate.carried) out.carried_share += 1 - carried->drawn_share;
  }
  done = std::max<std::int64_t>(done, 1);
  out.mean_triangles /= done;
  out.carried_share /= static_cast<double>(done);
  return out;
}

}  // namespace

fs::path manifest_of_folder(const fs::path& folder, const std::string& frames, const Shard& shard) {
  return folder / ("manifest" + (frames.empty() ? "" : ".frames-" + frames) + part_name(shard) + ".json");
}

fs::path manifest_of_video(const fs::path& film, const fs::path& parts, const Shard& shard) {
  return shard.of == 1 ? fs::path(film.string() + ".json") : parts / ("manifest" + part_name(shard) + ".json");
}

void write_manifest(const fs::path& path, const ManifestHead& head, const json& target,
                    std::span<const FilmFrame> frames) {
  json top{
      {"program", "vpe " + head.program},
      {"planet",
       {{"identity", head.planet}, {"illustration", head.illustration}, {"synthetic", head.synthetic}}},
      {"flight", head.flight},
      {"fps", scripts::to_text(head.rate)},
      {"size", std::to_string(head.width) + "x" + std::to_string(head.height)},
      {"complete", std::all_of(frames.begin(), frames.end(), [](const FilmFrame& f) { return f.is_done(); })}};
  for (const FilmPalette& palette : head.palettes) {
    const char* value = palette.colour == core::Colour::kSlope        ? "slope"
                        : palette.colour == core::Colour::kAspect     ? "aspect"
                        : palette.colour == core::Colour::kDifference ? "difference"
                                                                      : "elevation";
    top["palette"][value] = {{"low", palette.ends.low}, {"high", palette.ends.high}};
  }
  if (!head.ground.empty()) top["ground"] = head.ground;
  if (!head.frames.empty()) top["selected"] = head.frames;
  if (head.shard.of > 1) top["part"] = std::to_string(head.shard.number) + "/" + std::to_string(head.shard.of);
  top.update(target);
  std::string text = "{\n";
  for (const auto& [key, value] : top.items()) text += line(key) + ": " + line(value) + ",\n";
  text += "\"frames\": [";
  for (std::size_t n = 0; n < frames.size(); ++n) text += (n == 0 ? "\n" : ",\n") + line(frame_json(frames[n]));
  base::write_file(path, text + "\n]\n}\n");
}

json read_json(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  try {
    const std::vector<std::uint8_t> bytes = base::read_file(path, kMostManifestBytes);
    json value = json::parse(bytes, nullptr, false);
    return value.is_discarded() ? json() : value;
  } catch (const base::FileError&) {
    return {};
  }
}

std::string progress_text(const FilmKind& kind, std::span<const FilmFrame> frames) {
  const FilmCount n = count(frames);
  return std::to_string(n.done()) + " of " + frames_text(n.all) + (n.all == 1 ? " is there" : " are there") +
         (kind.is_video ? ", in segments of " + std::to_string(kind.group_size) : "") +
         "; the same command continues";
}

std::string failure_text(const FilmKind& kind, const std::string& output, std::span<const FilmFrame> frames) {
  const FilmCount n = count(frames);
  std::string text = output + ": " + std::to_string(n.failed) + " of " + frames_text(n.all) + " failed:";
  std::int64_t named = 0;
  for (const FilmFrame& f : frames) {
    if (f.state != FilmFrame::State::kFailed) continue;
    if (++named > kNamedFailures) break;
    text += "\n     frame " + std::to_string(f.index) + ": " + f.error;
  }
  if (n.failed > kNamedFailures) text += "\n     and " + std::to_string(n.failed - kNamedFailures) + " more";
  text += "\n     " + std::to_string(n.done()) + " are there";
  if (kind.is_video) {
    text += ", in segments of " + std::to_string(kind.group_size) + "; the film is not joined";
  }
  return text + "; remove the cause, and the same command makes only the missing frames";
}

std::optional<std::int64_t> parts_begun(const fs::path& folder, const std::string& frames) {
  const std::string begin = "manifest" + (frames.empty() ? "" : ".frames-" + frames) + ".part-";
  std::optional<std::int64_t> most;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const std::size_t of = name.find("-of-");
    if (!name.starts_with(begin) || !name.ends_with(".json") || of == std::string::npos) continue;
    const auto count = base::parse_integer(name.substr(of + 4, name.size() - of - 9));
    if (count && *count > most.value_or(0)) most = count;
  }
  return most;
}

std::string missing_text(const FilmKind& kind, std::span<const FilmFrame> frames,
                         std::optional<std::int64_t> parts) {
  const auto all = static_cast<std::int64_t>(frames.size());
  const std::int64_t groups = (all + kind.group_size - 1) / kind.group_size;
  std::vector<std::string> ranges;
  std::vector<std::string> numbers;
  std::int64_t missing = 0;
  std::int64_t part = 1;
  std::int64_t last_part = 0;
  for (std::int64_t n = 0; n < all; ++n) {
    if (frames[static_cast<std::size_t>(n)].is_done()) continue;
    ++missing;
    const std::int64_t first = frames[static_cast<std::size_t>(n)].index;
    if (n == 0 || frames[static_cast<std::size_t>(n - 1)].is_done()) {
      std::int64_t end = n;
      while (end < all && !frames[static_cast<std::size_t>(end)].is_done()) ++end;
      const std::int64_t last = frames[static_cast<std::size_t>(end - 1)].index;
      ranges.push_back(std::to_string(first) + (last == first ? "" : "-" + std::to_string(last)));
    }
    if (!parts) continue;
    while (part < *parts && Shard{part, *parts}.end(groups) <= n / kind.group_size) ++part;
    if (part != last_part) numbers.push_back(std::to_string(part));
    last_part = part;
  }
  std::string text = std::to_string(missing) + " of " + frames_text(all) +
                     (missing == 1 ? " is missing: " : " are missing: ") + list_text(ranges);
  if (parts) {
    text += (numbers.size() == 1 ? " (part " : " (parts ") + list_text(numbers) + " of " +
            std::to_string(*parts) + ")";
  }
  return text;
}

json summary_json(std::span<const FilmFrame> frames, double seconds) {
  const FilmCount n = count(frames);
  const FilmFigures figures = figures_of(frames);
  return {{"frames", n.done()},
          {"made", n.made},
          {"kept", n.kept},
          {"failed", n.failed},
          {"seconds", seconds},
          {"shift_bound_px", figures.shift_bound_px},
          {"carried_share", figures.carried_share},
          {"mean_triangles", figures.mean_triangles}};
}

std::string summary_text(std::span<const FilmFrame> frames, double seconds) {
  const FilmCount n = count(frames);
  std::string text = frames_text(n.done());
  if (n.kept > 0 && n.made > 0) {
    text += " (" + std::to_string(n.made) + " made, " + std::to_string(n.kept) + " kept)";
  } else if (n.kept > 0) {
    text += ", all there already";
  }
  std::array<char, 96> end{};
  if (n.made > 0) {
    std::snprintf(end.data(), end.size(), ", %.1f frames/s", static_cast<double>(n.made) / seconds);
    text += end.data();
  }
  const FilmFigures figures = figures_of(frames);
  std::snprintf(end.data(), end.size(), ", geometry within %.2f px", figures.shift_bound_px);
  text += end.data();
  if (figures.carried_share == 0) return text;
  std::snprintf(end.data(), end.size(), ", %.0f %% of pixels carried", 100 * figures.carried_share);
  return text + end.data();
}

}  // namespace vpe::app
