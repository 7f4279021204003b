// Decisions about unfinished files, without network and disk: what to ask a server for, and what to do with its
// answer. Bytes of two versions of a file are never joined.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vpe::app {

// Describes what an unfinished file NAME.part holds the beginning of. Stored beside it as NAME.part.json.
struct PartState {
  std::string address;
  std::string etag;              // as the server sent it; empty: none
  std::string last_modified;     // the same
  std::int64_t total_bytes = 0;  // of the whole file, 0 if the server did not state it
  bool is_refused = false;       // the whole was fetched, and its checksum was wrong

  bool operator==(const PartState&) const = default;
};

std::string part_state_text(const PartState& state);
// Returns nullopt for a text that part_state_text() cannot have written.
std::optional<PartState> parse_part_state(std::string_view text);

// Describes a request for a file or its end.
struct ResumePlan {
  std::int64_t offset = 0;  // first byte to ask for
  std::string validator;    // for If-Range; empty exactly if offset is 0
};

// Returns from where to continue. It is the beginning, if nothing says of which version the unfinished file is:
// no state, another address, or a server that sends neither a strong ETag nor Last-Modified. At least the last
// byte is asked for again, so that the server confirms its version.
ResumePlan plan_resume(const std::optional<PartState>& state, std::int64_t part_bytes,
                       const std::string& address);

// Holds the head of a server's answer.
struct ResponseHead {
  int status = 0;
  std::string content_type;
  std::int64_t content_length = -1;  // -1: not stated
  std::int64_t range_first = -1;     // Content-Range; -1: none, or not understood
  std::int64_t range_total = -1;     // -1: not stated
  std::string etag;
  std::string last_modified;
};

// Sets what a line of a head says ("ETag: \"a\""). A status line ("HTTP/1.1 200 OK") begins a new head.
void read_head_line(std::string_view line, ResponseHead& head);

// Describes a file that is expected.
struct Expected {
  std::string name;
  std::int64_t bytes = 0;  // 0 if it is not known
};

// Says what to do with an answer.
struct AnswerDecision {
  enum class Action : std::uint8_t {
    kTake,       // write the body from `offset`
    kBeginAnew,  // ask again, for the whole file
    kTryAgain,   // ask again after a pause
    kGiveUp,
  };
  Action action = Action::kGiveUp;
  std::int64_t offset = 0;
  std::int64_t total_bytes = 0;  // 0 if the server does not state it
  std::string problem;           // unless the body is taken
};

AnswerDecision decide(const ResponseHead& head, const ResumePlan& plan, const std::optional<PartState>& state,
                      const Expected& expected);

// Returns true if a file begins as HTML pages do: servers send such pages in place of files that are missing.
bool begins_as_html(std::string_view beginning);

}  // namespace vpe::app
