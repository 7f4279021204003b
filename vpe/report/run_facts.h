// The program, machine and time of a report's run.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace vpe::report {

struct RunFacts {
  std::string program;  // with its version, such as "vpe 0.1.0"
  std::string command;  // quoted so that a shell runs it again
  std::string begun;    // UTC, such as "2026-11-22T18:30:00Z"
  std::string processor;
  int threads = 0;       // that the machine runs at once
  double memory_gb = 0;  // of the machine
  std::string system;
  std::string opengl;  // empty: not used
  double load = 0;     // mean number of running programs over the minute before
};

// Returns the facts at the start of a run of `program` with these words after the command's name.
RunFacts read_run_facts(const std::string& program, std::span<const std::string> words);

nlohmann::json to_json(const RunFacts& facts);

// Returns paragraphs for a page.
std::vector<std::string> to_paragraphs(const RunFacts& facts);

// Returns the mean number of running programs over the last minute; 0 where the system does not say.
double load_now();

}  // namespace vpe::report
