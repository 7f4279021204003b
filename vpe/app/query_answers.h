// The answers of vpe query: a table in CSV, JSON, or features.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "mars/vector/feature.h"
#include "paging/surface/query.h"
#include "vpe/app/places/places.h"
#include "vpe/app/scene/place_surfaces.h"

namespace vpe::app {

// Holds the answers at places, all lists in the order of the request.
struct QueryAnswers {
  std::vector<paging::PlaceAnswer> ground;
  std::optional<std::vector<std::optional<ObjectTop>>> tops;       // with objects
  std::optional<std::vector<std::vector<PlaceSurface>>> surfaces;  // where all are asked for
};

// Returns an array with an object for each place.
nlohmann::json answers_json(const QueryAnswers& answers, const PlaceTable& table,
                            const paging::PlanetMeta& meta);

// Returns a point for each place of answers_json(), or for each surface of each place where all are asked for.
mars::FeatureLayer answers_layer(const nlohmann::json& answers);

// Prints a table in CSV with a line for each place, or for each surface of each place where all are asked for.
// Further columns of the places' table come last; those with names that the answer has itself get the prefix
// input_.
void print_csv_answers(const QueryAnswers& answers, const PlaceTable& table, const paging::PlanetMeta& meta);

}  // namespace vpe::app
