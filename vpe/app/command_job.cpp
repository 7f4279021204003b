#include "vpe/app/command_job.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "vpe/app/cli/progress.h"

namespace vpe::app {

namespace {

std::vector<std::string> with_program(const std::string& program, const std::vector<std::string>& words) {
  std::vector<std::string> all{program};
  all.insert(all.end(), words.begin(), words.end());
  return all;
}

// Returns the share in "drawing: 41 %, 0:12 left", or -1.
double fraction_in(std::string_view line) {
  const std::size_t sign = line.rfind(" %");
  if (sign == std::string_view::npos) return -1;
  const std::size_t begin = line.find_last_not_of("0123456789", sign == 0 ? 0 : sign - 1);
  const std::string_view digits = line.substr(begin == std::string_view::npos ? 0 : begin + 1);
  int percent = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), percent);
  if (error != std::errc() || percent > 100) return -1;
  return percent / 100.0;
}

}  // namespace

window::JobState progress_of(const std::string& messages) {
  window::JobState state;
  std::string_view rest = messages;
  while (!rest.empty() && (rest.back() == '\n' || rest.back() == ' ')) rest.remove_suffix(1);
  const std::size_t line = rest.find_last_of("\r\n");
  rest = rest.substr(line == std::string_view::npos ? 0 : line + 1);
  state.text = rest;
  state.fraction = fraction_in(rest);
  return state;
}

CommandJob::CommandJob(const std::string& program, const std::vector<std::string>& words)
    : process_(with_program(program, words), {}, {std::string(kProgressVariable) + "=0.5"}) {}

CommandJob::~CommandJob() { process_.interrupt(); }

window::JobState CommandJob::state() {
  const bool is_running = process_.is_running();
  window::JobState state = progress_of(process_.stderr_text());
  state.is_running = is_running;
  if (is_running) return state;
  state.failed = !process_.finish();
  if (!state.failed) state.fraction = 1;
  return state;
}

}  // namespace vpe::app
