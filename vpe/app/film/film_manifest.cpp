#include "vpe/app/film/film_manifest.h"

#include <algorithm>

#include "vpe/app/cli/temporary.h"
#include "vpe/base/file.h"

namespace vpe::app {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 32;

std::string part_name(const Shard& part) {
  return part.of == 1 ? "" : ".part-" + std::to_string(part.number) + "-of-" + std::to_string(part.of);
}

std::string line(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

json to_json(const FilmFrame& frame) {
  json out{{"index", frame.index}, {"time_s", frame.time_s}, {"fingerprint", frame.fingerprint}};
  if (frame.is_there()) {
    out["figures"] = to_json(frame.figures);
    if (!frame.checksum.empty()) out["checksum"] = frame.checksum;
  } else if (frame.state == FilmFrame::State::kFailed) {
    out["failed"] = frame.trouble;
  } else {
    out["missing"] = true;
  }
  return out;
}

}  // namespace

fs::path manifest_of_folder(const fs::path& folder, const std::string& frames, const Shard& part) {
  return folder / ("manifest" + (frames.empty() ? "" : ".frames-" + frames) + part_name(part) + ".json");
}

fs::path manifest_of_video(const fs::path& film, const fs::path& parts, const Shard& part) {
  return part.of == 1 ? fs::path(film.string() + ".json") : parts / ("manifest" + part_name(part) + ".json");
}

void write_manifest(const fs::path& path, const FilmHead& head, const json& target,
                    std::span<const FilmFrame> frames) {
  json top{
      {"program", "vpe " + head.program},
      {"planet", {{"identity", head.planet}, {"illustration", head.illustration}}},
      {"flight", head.flight},
      {"fps", scripts::to_text(head.rate)},
      {"size", std::to_string(head.width) + "x" + std::to_string(head.height)},
      {"complete", std::all_of(frames.begin(), frames.end(), [](const FilmFrame& f) { return f.is_there(); })}};
  if (!head.frames.empty()) top["selected"] = head.frames;
  if (head.part.of > 1) top["part"] = std::to_string(head.part.number) + "/" + std::to_string(head.part.of);
  top.update(target);
  std::string text = "{\n";
  for (const auto& [key, value] : top.items()) text += line(key) + ": " + line(value) + ",\n";
  text += "\"frames\": [";
  for (std::size_t n = 0; n < frames.size(); ++n) text += (n == 0 ? "\n" : ",\n") + line(to_json(frames[n]));
  write_whole(path, text + "\n]\n}\n");
}

json read_json(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  try {
    const std::vector<std::uint8_t> bytes = base::read_file(path, kMostBytes);
    json value = json::parse(bytes, nullptr, false);
    return value.is_discarded() ? json() : value;
  } catch (const base::FileError&) {
    return {};
  }
}

}  // namespace vpe::app
