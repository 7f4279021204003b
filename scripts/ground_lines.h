// Checks the lines of a flight that change its ground. Used by the parser alone.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "relief/spec.h"
#include "scripts/flight.h"
#include "scripts/flight_words.h"

namespace scripts {

// Holds what the lines so far say, so that a line can be checked by those before it.
class GroundLines {
 public:
  // Add a line, given by the words after `relief` or `patch`. Return what was expected and what was found, and add nothing
  // then; else "". Times must not descend.
  std::string add_relief(double time_s, const Words& words, std::vector<ReliefCommand>& lines);
  std::string add_patch(double time_s, const Words& words, std::vector<PatchCommand>& lines);

 private:
  std::map<std::string, relief::ReliefSpec> reliefs_;  // as the last line of each name leaves it
  std::map<std::string, double> relief_times_s_;       // of that line
  std::map<std::string, double> patch_times_s_;
};

}  // namespace scripts
