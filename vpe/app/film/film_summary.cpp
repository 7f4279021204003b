#include "vpe/app/film/film_summary.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace vpe::app {

namespace {

constexpr std::int64_t kNamedFailures = 5;

std::string frames_text(std::int64_t n) { return std::to_string(n) + (n == 1 ? " frame" : " frames"); }

}  // namespace

std::string what_is_there(const FilmKind& kind, std::span<const FilmFrame> frames) {
  const FilmCount n = count(frames);
  return std::to_string(n.there()) + " of " + frames_text(n.all) + (n.all == 1 ? " is there" : " are there") +
         (kind.is_video ? ", in segments of " + std::to_string(kind.group_size) : "") +
         "; the same command continues";
}

std::string what_failed(const FilmKind& kind, const std::string& output, std::span<const FilmFrame> frames) {
  const FilmCount n = count(frames);
  std::string text = output + ": " + std::to_string(n.failed) + " of " + frames_text(n.all) + " failed:";
  std::int64_t named = 0;
  for (const FilmFrame& f : frames) {
    if (f.state != FilmFrame::State::kFailed) continue;
    if (++named > kNamedFailures) break;
    text += "\n     frame " + std::to_string(f.index) + ": " + f.trouble;
  }
  if (n.failed > kNamedFailures) text += "\n     and " + std::to_string(n.failed - kNamedFailures) + " more";
  text += "\n     " + std::to_string(n.there()) + " are there";
  if (kind.is_video) {
    text += ", in segments of " + std::to_string(kind.group_size) + "; the film is not joined";
  }
  return text + "; once the cause is mended, the same command makes only what is missing";
}

FilmFigures figures_of(std::span<const FilmFrame> frames) {
  FilmFigures out;
  std::int64_t there = 0;
  for (const FilmFrame& f : frames) {
    if (!f.is_there()) continue;
    ++there;
    out.shift_bound_px = std::max(out.shift_bound_px, f.figures.certificate.shift_bound_px);
    out.mean_triangles += f.figures.stats.triangles;
  }
  out.mean_triangles /= std::max<std::int64_t>(there, 1);
  return out;
}

nlohmann::json film_json(std::span<const FilmFrame> frames, double seconds) {
  const FilmCount n = count(frames);
  const FilmFigures figures = figures_of(frames);
  return {{"frames", n.there()},
          {"made", n.made},
          {"kept", n.kept},
          {"failed", n.failed},
          {"seconds", seconds},
          {"shift_bound_px", figures.shift_bound_px},
          {"mean_triangles", figures.mean_triangles}};
}

std::string film_line(std::span<const FilmFrame> frames, double seconds) {
  const FilmCount n = count(frames);
  std::string text = frames_text(n.there());
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
  std::snprintf(end.data(), end.size(), ", geometry within %.2f px", figures_of(frames).shift_bound_px);
  return text + end.data();
}

}  // namespace vpe::app
