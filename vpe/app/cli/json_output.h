// Figures as JSON, shared by the commands.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "paging/planet/planet_meta.h"
#include "vpe/core/frame.h"

namespace vpe::app {

nlohmann::json planet_json(const paging::PlanetMeta& meta);
nlohmann::json stats_json(const core::FrameStats& stats);

// Quoted where it has to be.
std::string csv_field(const std::string& text);

// To stdout. Paths that are not UTF-8 get replacement characters.
void print_json(const nlohmann::json& json);

// Tiles that could not be read (core::DrawResult::failures), as warnings.
void warn_of(std::span<const std::string> failures);

// Warns on stderr that numbers come from a made-up planet.
void note_illustration(const paging::PlanetMeta& meta, bool quiet);

}  // namespace vpe::app
