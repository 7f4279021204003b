#include "vpe/report/run_facts.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "vpe/base/parallel.h"

namespace vpe::report {
namespace {

// Quotes a word for a shell.
std::string quoted(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                          "-_./=,:+@%") == std::string::npos;
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string system_name() {
  utsname name{};
  if (::uname(&name) != 0) return "unknown";
  return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace

double load_now() {
  double load = 0;
  return ::getloadavg(&load, 1) == 1 ? load : 0;
}

RunFacts read_run_facts(const std::string& program, std::span<const std::string> words) {
  RunFacts facts;
  facts.program = program;
  facts.command = "vpe";
  for (const std::string& word : words) facts.command += " " + quoted(word);
  facts.begun = utc_now();
  facts.processor = processor_name();
  facts.threads = base::default_threads();
  facts.memory_gb =
      1e-9 * static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  facts.system = system_name();
  facts.load = load_now();
  return facts;
}

nlohmann::json to_json(const RunFacts& facts) {
  return {{"program", facts.program},
          {"command", facts.command},
          {"begun", facts.begun},
          {"processor", facts.processor},
          {"threads", facts.threads},
          {"memory_gb", facts.memory_gb},
          {"system", facts.system},
          {"opengl", facts.opengl.empty() ? nlohmann::json() : nlohmann::json(facts.opengl)},
          {"load_before", facts.load}};
}

std::vector<std::string> to_paragraphs(const RunFacts& facts) {
  char machine[160];
  std::snprintf(machine, sizeof machine, ", %d threads, %.1f GB; %.2f programs ran on it in the minute before.",
                facts.threads, facts.memory_gb, facts.load);
  return {facts.program + ", " + facts.begun + ": " + facts.command, facts.processor + machine,
          facts.system + (facts.opengl.empty() ? "" : "; OpenGL: " + facts.opengl)};
}

}  // namespace vpe::report
