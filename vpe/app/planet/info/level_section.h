// Sections of a planet's page that are made of figures alone.
#pragma once

#include <string>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/app/planet/info/ground_statistics.h"
#include "vpe/app/planet/info/source_coverage.h"
#include "vpe/report/page.h"

namespace vpe::app {

// Returns a text as pages can hold it: on one line, and with U+FFFD for what is not UTF-8.
std::string page_text(const std::string& text);

// Returns the section of levels: a table and plots of errors and sizes.
report::Section levels_section(const paging::PlanetFile& planet);

// Returns the tables of the sources of elevations and of imagery.
std::vector<report::Table> source_tables(const paging::PlanetMeta& meta, const SourceCoverage& coverage);

// Returns the section of accuracy: each error that the file states, with its meaning.
report::Section accuracy_section(const paging::PlanetFile& planet);

// Returns the sections of slopes and of elevations.
report::Section slopes_section(const std::vector<GroundStatistics>& levels);
report::Section elevations_section(const std::vector<GroundStatistics>& levels);

}  // namespace vpe::app
