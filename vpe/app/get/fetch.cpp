#include "vpe/app/get/fetch.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <thread>

#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/get/checksum.h"
#include "vpe/app/get/part_file.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

namespace fs = std::filesystem;
using Action = AnswerDecision::Action;

constexpr std::size_t kMaxChecksumFile_bytes = 1 << 20;

void check_stopped(const fs::path& path) {
  if (const int signal = InterruptGuard::pending(); signal != 0)
    throw Interrupted(signal, "stopped while fetching '" + path.string() + "'; the same command continues");
}

// Counts failures in a row, and waits between them.
class Patience {
 public:
  Patience(const FetchOptions& options, std::string what, fs::path path)
      : options_(options), what_(std::move(what)), path_(std::move(path)), wait_s_(options.retry_wait_s) {}

  void progressed() {
    failures_ = 0;
    wait_s_ = options_.retry_wait_s;
  }

  // Waits before the next request. Throws if there were too many, or if the server asks for too long a pause.
  void wait_after(const std::string& problem, double retry_after_s) {
    const std::string again = "; try again later, the same command continues";
    if (retry_after_s > options_.longest_retry_after_s)
      throw std::runtime_error(what_ + ": " + problem + ", and asks to wait " +
                               base::format_rounded(retry_after_s, 0) + " s" + again);
    if (failures_ >= options_.retries)
      throw std::runtime_error(what_ + ": " + problem + ", " + std::to_string(failures_ + 1) + " times" +
                               again);
    ++failures_;
    const double pause_s = std::max(retry_after_s, wait_s_);
    wait_s_ = std::min(2 * wait_s_, options_.longest_wait_s);
    if (!options_.quiet)
      std::fprintf(stderr, "vpe: %s: %s; again in %s s (%d of %d)\n", what_.c_str(), problem.c_str(),
                   base::format_rounded(pause_s, 1).c_str(), failures_, options_.retries);
    sleep(pause_s);
  }

 private:
  void sleep(double seconds) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    for (;;) {
      check_stopped(path_);
      const auto left = end - std::chrono::steady_clock::now();
      if (left <= left.zero()) return;
      std::this_thread::sleep_for(std::min<std::chrono::duration<double>>(left, std::chrono::milliseconds(50)));
    }
  }

  const FetchOptions& options_;
  std::string what_;
  fs::path path_;
  int failures_ = 0;
  double wait_s_;
};

// Fetches one file into its PartFile.
class Download {
 public:
  Download(const RemoteFile& file, PartFile& part, const FetchOptions& options, const FetchProgress& progress)
      : file_(file),
        part_(part),
        options_(options),
        progress_(progress),
        state_(options.is_forced ? std::nullopt : part.state()),
        most_(part.size()) {}

  void run() {
    Patience patience(options_, file_.address, part_.path());
    for (;;) {
      check_stopped(part_.path());
      plan_ = is_anew_ ? ResumePlan{} : plan_resume(state_, part_.size(), file_.address);
      decision_ = {};
      const HttpOutcome outcome = http_get({file_.address, plan_}, options_.http, handlers());
      const Action action = outcome.has_answer ? decision_.action : Action::kGiveUp;
      const bool is_cut_short = decision_.total_bytes > 0 && part_.size() < decision_.total_bytes;
      if (action == Action::kTake && outcome.is_complete && !is_cut_short) return;
      if (outcome.has_answer && action == Action::kGiveUp) give_up(decision_.problem);
      if (action == Action::kBeginAnew) {
        begin_anew();
        continue;
      }
      if (!outcome.is_complete && !outcome.may_pass) give_up(outcome.problem);
      // Only bytes that were never here before are progress: a server that always begins anew must not go on
      // for ever.
      if (part_.size() > most_) patience.progressed();
      most_ = std::max(most_, part_.size());
      const std::string problem = !outcome.is_complete      ? outcome.problem
                                  : action == Action::kTake ? "the server sent only a part"
                                                            : decision_.problem;
      patience.wait_after(problem, outcome.retry_after_s);
    }
  }

 private:
  HttpHandlers handlers() {
    return {[this](const ResponseHead& head) { return take_head(head); },
            [this](std::string_view bytes) { take_body(bytes); },
            [this] {
              check_stopped(part_.path());
              progress_("fetching", part_.size());
            }};
  }

  bool take_head(const ResponseHead& head) {
    decision_ = decide(head, plan_, state_, {file_.name, file_.bytes});
    if (decision_.action != Action::kTake) return false;
    check_space();
    // Before the bytes, so that no bytes are ever taken for those of another version.
    if (decision_.offset == 0) part_.cut(0);
    PartState state{file_.address, head.etag, head.last_modified, decision_.total_bytes, false};
    if (decision_.offset > 0) {
      // The same version; not every answer says all about it.
      if (state.etag.empty()) state.etag = state_->etag;
      if (state.last_modified.empty()) state.last_modified = state_->last_modified;
      if (state.total_bytes == 0) state.total_bytes = state_->total_bytes;
    }
    state_ = state;
    part_.set_state(state);
    part_.cut(decision_.offset);
    is_anew_ = false;
    return true;
  }

  void take_body(std::string_view bytes) {
    if (part_.size() == 0 && begins_as_html(bytes) && !file_.name.ends_with(".html"))
      give_up("the server sent an HTML page in place of the file");
    part_.write(bytes);
  }

  void check_space() const {
    std::error_code none;
    const fs::space_info space = fs::space(part_.path().parent_path(), none);
    const std::int64_t needed = decision_.total_bytes - part_.size();
    if (none || decision_.total_bytes == 0 || needed <= static_cast<std::int64_t>(space.available)) return;
    throw std::runtime_error("'" + part_.path().string() + "': " + bytes_text(static_cast<double>(needed)) +
                             " are still to be fetched, but only " +
                             bytes_text(static_cast<double>(space.available)) +
                             " are free on the disk; free some space, the same command continues");
  }

  void begin_anew() {
    if (!options_.quiet)
      std::fprintf(stderr, "vpe: %s: %s; it is fetched from the beginning\n", file_.address.c_str(),
                   decision_.problem.c_str());
    is_anew_ = true;
  }

  [[noreturn]] void give_up(const std::string& problem) const {
    throw std::runtime_error(file_.address + ": " + problem +
                             "; check the address in the catalogue ('vpe get NAME --about')");
  }

  const RemoteFile& file_;
  PartFile& part_;
  const FetchOptions& options_;
  const FetchProgress& progress_;
  std::optional<PartState> state_;
  ResumePlan plan_;
  AnswerDecision decision_;
  bool is_anew_ = false;
  std::int64_t most_;  // largest size of the file so far
};

// Returns the text of a small file on a server.
std::string fetch_text(const std::string& address, const fs::path& path, const FetchOptions& options) {
  Patience patience(options, address, path);
  for (;;) {
    std::string text;
    AnswerDecision decision;
    const HttpHandlers handlers{[&](const ResponseHead& head) {
                                  decision = decide(head, {}, std::nullopt, {"checksum", 0});
                                  return decision.action == Action::kTake;
                                },
                                [&](std::string_view bytes) {
                                  if (text.size() + bytes.size() <= kMaxChecksumFile_bytes) text += bytes;
                                },
                                [&] { check_stopped(path); }};
    const HttpOutcome outcome = http_get({address, {}}, options.http, handlers);
    if (outcome.is_complete && decision.action == Action::kTake) return text;
    const std::string problem = outcome.is_complete ? decision.problem : outcome.problem;
    if (outcome.is_complete ? decision.action != Action::kTryAgain : !outcome.may_pass)
      throw std::runtime_error(address + ": " + problem + "; --no-checksum does without the checksum");
    patience.wait_after(problem, outcome.retry_after_s);
  }
}

// Returns the checksum that a file should have. An archive's checksum file is fetched.
std::optional<Checksum> expected_checksum(const RemoteFile& file, const fs::path& path,
                                          const FetchOptions& options) {
  if (!options.uses_checksums) return std::nullopt;
  if (!file.sha256.empty()) return Checksum{ChecksumKind::kSha256, file.sha256};
  if (!file.md5.empty()) return Checksum{ChecksumKind::kMd5, file.md5};
  if (file.md5_address.empty()) return std::nullopt;
  const auto md5 = parse_md5_file(fetch_text(file.md5_address, path, options), file.name);
  if (!md5)
    throw std::runtime_error(file.md5_address + ": holds no MD5 checksum of '" + file.name +
                             "'; --no-checksum does without");
  return Checksum{ChecksumKind::kMd5, *md5};
}

// Returns the checksum that a file has, as text, "" if none is expected; nullopt if it has another one.
std::optional<std::string> verified(const fs::path& path, const std::optional<Checksum>& expected,
                                    const FetchProgress& progress) {
  if (!expected) return "";
  const std::string hex = file_checksum(path, expected->kind, [&](std::int64_t bytes) {
    check_stopped(path);
    progress("verifying", bytes);
  });
  if (hex != expected->hex) return std::nullopt;
  return std::string(name_of(expected->kind)) + " " + hex;
}

FetchedFile kept_file(const RemoteFile& file, const fs::path& path, const FetchOptions& options,
                      const FetchProgress& progress) {
  const std::string force = "; --force fetches it anew";
  if (!fs::is_regular_file(path)) throw std::runtime_error("'" + path.string() + "' is no file; move it away");
  const auto bytes = static_cast<std::int64_t>(fs::file_size(path));
  if (file.bytes > 0 && bytes != file.bytes)
    throw std::runtime_error("'" + path.string() + "' is there with " + std::to_string(bytes) +
                             " bytes, but the catalogue says " + std::to_string(file.bytes) + force);
  if (!options.checks_kept) return {path, bytes, true, ""};
  const auto checksum = verified(path, expected_checksum(file, path, options), progress);
  if (!checksum)
    throw std::runtime_error("'" + path.string() + "' does not have the archive's checksum" + force);
  return {path, bytes, true, *checksum};
}

}  // namespace

FetchedFile fetch_file(const RemoteFile& file, const fs::path& folder, const FetchOptions& options,
                       const FetchProgress& progress) {
  const fs::path path = folder / file.name;
  std::error_code none;
  if (fs::exists(path, none) && !options.is_forced) return kept_file(file, path, options, progress);
  if (fs::is_directory(path, none))
    throw std::runtime_error("'" + path.string() + "' is a folder; move it away");
  PartFile part(path);
  const std::optional<Checksum> expected = expected_checksum(file, path, options);
  Download(file, part, options, progress).run();
  if (file.bytes > 0 && part.size() != file.bytes) {
    throw std::runtime_error(file.address + ": the server sent " + std::to_string(part.size()) +
                             " bytes, but the catalogue says " + std::to_string(file.bytes) +
                             "; they are in '" + part.path().string() + "'");
  }
  const auto checksum = verified(part.path(), expected, progress);
  if (!checksum) {
    if (auto state = part.state()) {
      state->is_refused = true;
      part.set_state(*state);
    }
    throw std::runtime_error(file.address + ": the file does not have the " + name_of(expected->kind) +
                             " checksum " + expected->hex + "; it stays in '" + part.path().string() +
                             "', and the same command fetches it from the beginning");
  }
  part.publish();
  return {path, part.size(), false, *checksum};
}

std::int64_t bytes_to_fetch(const RemoteFile& file, const fs::path& folder, const FetchOptions& options) {
  const fs::path path = folder / file.name;
  std::error_code none;
  if (!options.is_forced && fs::exists(path, none)) return 0;
  const auto part = fs::file_size(fs::path(path) += ".part", none);
  return std::max<std::int64_t>(0, file.about_bytes - (none ? 0 : static_cast<std::int64_t>(part)));
}

}  // namespace vpe::app
