// What a run over a film says to people and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "vpe/app/film/film_frame.h"

namespace vpe::app {

// How a film's frames are made, for what is said when some are not.
struct FilmKind {
  bool is_video = false;
  std::int64_t group_size = 1;
};

// "12 of 20 frames are there; the same command continues".
std::string what_is_there(const FilmKind& kind, std::span<const FilmFrame> frames);

// Which frames failed and why, the first few by name, and what to do.
std::string what_failed(const FilmKind& kind, const std::string& output, std::span<const FilmFrame> frames);

// Largest bound and mean number of triangles over the frames that are there.
struct FilmFigures {
  double shift_bound_px = 0;
  std::int64_t mean_triangles = 0;
};
FilmFigures figures_of(std::span<const FilmFrame> frames);

// frames, made, kept, failed, seconds and the figures.
nlohmann::json film_json(std::span<const FilmFrame> frames, double seconds);

// "20 frames (12 made, 8 kept), 31.2 frames/s, geometry within 0.98 px"
std::string film_line(std::span<const FilmFrame> frames, double seconds);

}  // namespace vpe::app
