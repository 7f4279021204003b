#include "vpe/app/get/resume.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>

#include "vpe/base/number.h"

namespace vpe::app {

namespace {

using Action = AnswerDecision::Action;

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

bool is_header_value(const std::string& text) {
  return text.size() < 1000 &&
         std::ranges::all_of(text, [](unsigned char c) { return c >= 0x20 && c != 0x7f; });
}

// Returns what identifies a version byte for byte: RFC 9110, 13.1.5, does not allow weak entity tags.
std::string validator_of(const PartState& state) {
  if (!state.etag.empty() && !state.etag.starts_with("W/")) return state.etag;
  return state.last_modified;
}

// "bytes 100-199/500", "bytes 100-199/*"
void read_content_range(std::string_view value, ResponseHead& head) {
  const std::string text = lower_case(value);
  const std::size_t dash = text.find('-');
  const std::size_t slash = text.find('/');
  if (!text.starts_with("bytes ") || dash == std::string::npos || slash == std::string::npos || slash < dash)
    return;
  const auto first = base::parse_integer(trimmed(std::string_view(text).substr(6, dash - 6)));
  const auto total = base::parse_integer(trimmed(std::string_view(text).substr(slash + 1)));
  if (first && *first >= 0) head.range_first = *first;
  if (total && *total >= 0) head.range_total = *total;
}

std::string status_text(int status) {
  constexpr std::array<std::pair<int, const char*>, 9> kReasons{{{401, "unauthorized"},
                                                                 {403, "forbidden"},
                                                                 {404, "not found"},
                                                                 {410, "gone"},
                                                                 {429, "too many requests"},
                                                                 {500, "internal error"},
                                                                 {502, "bad gateway"},
                                                                 {503, "unavailable"},
                                                                 {504, "gateway timeout"}}};
  const auto at = std::ranges::find(kReasons, status, &std::pair<int, const char*>::first);
  return "the server answered HTTP " + std::to_string(status) +
         (at == kReasons.end() ? "" : std::string(" (") + at->second + ")");
}

bool is_passing(int status) {
  constexpr std::array kPassing{408, 425, 429, 500, 502, 503, 504};
  return std::ranges::find(kPassing, status) != kPassing.end();
}

bool is_same_version(const ResponseHead& head, const PartState& state) {
  const auto agree = [](const std::string& a, const std::string& b) {
    return a.empty() || b.empty() || a == b;
  };
  return agree(head.etag, state.etag) && agree(head.last_modified, state.last_modified) &&
         (head.range_total < 0 || state.total_bytes == 0 || head.range_total == state.total_bytes);
}

}  // namespace

std::string part_state_text(const PartState& state) {
  return nlohmann::json{{"address", state.address},
                        {"etag", state.etag},
                        {"last_modified", state.last_modified},
                        {"total_bytes", state.total_bytes},
                        {"refused", state.is_refused}}
             .dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
         "\n";
}

std::optional<PartState> parse_part_state(std::string_view text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  try {
    PartState state{json.at("address"), json.at("etag"), json.at("last_modified"), json.at("total_bytes"),
                    json.at("refused")};
    // They become lines of a request.
    if (!is_header_value(state.etag) || !is_header_value(state.last_modified) || state.total_bytes < 0)
      return std::nullopt;
    return state;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

ResumePlan plan_resume(const std::optional<PartState>& state, std::int64_t part_bytes,
                       const std::string& address) {
  if (!state || state->address != address || state->is_refused || part_bytes <= 0) return {};
  const std::string validator = validator_of(*state);
  if (validator.empty()) return {};
  if (state->total_bytes == 0) return {part_bytes, validator};
  if (part_bytes > state->total_bytes) return {};
  const std::int64_t offset = std::min(part_bytes, state->total_bytes - 1);
  return offset == 0 ? ResumePlan{} : ResumePlan{offset, validator};
}

void read_head_line(std::string_view line, ResponseHead& head) {
  if (line.starts_with("HTTP/")) {
    head = {};
    const std::size_t space = line.find(' ');
    if (space == std::string_view::npos) return;
    head.status = static_cast<int>(base::parse_integer(trimmed(line.substr(space + 1, 3))).value_or(0));
    return;
  }
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return;
  const std::string name = lower_case(line.substr(0, colon));
  const std::string value(trimmed(line.substr(colon + 1)));
  if (name == "content-type") head.content_type = value;
  if (name == "content-length") head.content_length = base::parse_integer(value).value_or(-1);
  if (name == "content-range") read_content_range(value, head);
  if (name == "etag" && is_header_value(value)) head.etag = value;
  if (name == "last-modified" && is_header_value(value)) head.last_modified = value;
}

AnswerDecision decide(const ResponseHead& head, const ResumePlan& plan, const std::optional<PartState>& state,
                      const Expected& expected) {
  const auto anew = [](const char* why) { return AnswerDecision{Action::kBeginAnew, 0, 0, why}; };
  const auto give_up = [](const std::string& why) { return AnswerDecision{Action::kGiveUp, 0, 0, why}; };
  const bool is_partial = head.status == 206 && plan.offset > 0;
  if (head.status == 416 && plan.offset > 0) return anew("the server's file is shorter now");
  if (is_passing(head.status)) return {Action::kTryAgain, 0, 0, status_text(head.status)};
  if (head.status != 200 && !is_partial) return give_up(status_text(head.status));
  if (is_partial && (head.range_first != plan.offset || (state && !is_same_version(head, *state))))
    return anew("the server's answer does not continue what is here");
  const std::string type = lower_case(head.content_type.substr(0, head.content_type.find(';')));
  if (trimmed(type) == "text/html" && !lower_case(expected.name).ends_with(".html"))
    return give_up("the server sent text/html, a page for people, in place of the file");
  if (head.status == 200 && head.content_length == 0) return give_up("the server sent an empty file");
  std::int64_t total = is_partial ? head.range_total : head.content_length;
  if (is_partial && total < 0 && head.content_length >= 0) total = plan.offset + head.content_length;
  if (total > 0 && expected.bytes > 0 && total != expected.bytes)
    return give_up("the server's file has " + std::to_string(total) + " bytes, but the catalogue says " +
                   std::to_string(expected.bytes));
  return {Action::kTake, is_partial ? plan.offset : 0, std::max<std::int64_t>(total, 0), ""};
}

bool begins_as_html(std::string_view beginning) {
  if (beginning.starts_with("\xef\xbb\xbf")) beginning.remove_prefix(3);  // byte order mark
  const std::string text = lower_case(trimmed(beginning).substr(0, 20));
  return text.starts_with("<!doctype html") || text.starts_with("<html");
}

}  // namespace vpe::app
