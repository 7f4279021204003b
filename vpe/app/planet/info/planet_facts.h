// Facts of a planet file as lines for people: `vpe info` prints them, and its page shows them.
#pragma once

#include <string>
#include <vector>

#include "paging/planet/planet_meta.h"

namespace vpe::app {

// Holds one line. A line without a name continues the one above.
struct Fact {
  std::string name;
  std::string value;
};

// Returns the lines of a planet or of a part of one, without its levels. Their texts are on one line each.
std::vector<Fact> planet_facts(const paging::PlanetMeta& meta);

}  // namespace vpe::app
