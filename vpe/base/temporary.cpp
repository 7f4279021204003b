#include "vpe/base/temporary.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <optional>
#include <string_view>

#include "vpe/base/number.h"

namespace vpe::base {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kEnd = ".tmp";
constexpr int kMostAttempts = 1000;

std::string host() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "localhost";
  std::string text = name.data();
  for (char& c : text) {
    if (c == '/') c = '_';
  }
  return text.empty() ? "localhost" : text;
}

bool is_old(const fs::path& file) {
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  return !error && fs::file_time_type::clock::now() - written > std::chrono::hours(24);
}

std::optional<std::int64_t> number_in(std::string_view text) {
  const bool is_plain = !text.empty() && text.front() != '0' &&
                        std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  return is_plain ? parse_integer(text) : std::nullopt;
}

// Returns PID of "PID" or "PID-N".
std::optional<std::int64_t> process_in(std::string_view text) {
  const std::size_t dash = text.find('-');
  if (dash != std::string_view::npos && !number_in(text.substr(dash + 1))) return std::nullopt;
  return number_in(text.substr(0, dash));
}

// Returns true if `mark` is ".HOST-PID" or ".HOST-PID-N" of any machine.
bool is_mark(std::string_view mark) {
  if (!mark.starts_with('.')) return false;
  for (std::size_t dash = mark.find('-'); dash != std::string_view::npos; dash = mark.find('-', dash + 1)) {
    if (dash > 1 && process_in(mark.substr(dash + 1))) return true;
  }
  return false;
}

// Returns the name of the file that NAME.MARK.tmp was meant to become: the longest NAME that is ours.
std::optional<std::string> name_in(const std::string& text,
                                   const std::function<bool(const std::string&)>& is_ours) {
  for (std::size_t end = text.rfind('.'); end != std::string::npos && end > 0; end = text.rfind('.', end - 1)) {
    if (is_ours(text.substr(0, end))) return text.substr(0, end);
  }
  return std::nullopt;
}

}  // namespace

std::string process_mark() { return "." + host() + "-" + std::to_string(::getpid()); }

bool is_abandoned(const fs::path& file, std::string_view mark) {
  if (!is_mark(mark)) return false;
  const std::string here = "." + host() + "-";
  const auto pid = mark.starts_with(here) ? process_in(mark.substr(here.size())) : std::nullopt;
  if (!pid) return is_old(file);
  return ::kill(static_cast<pid_t>(*pid), 0) != 0 && errno == ESRCH;
}

std::FILE* make_temporary(const fs::path& file, fs::path& temporary) {
  const std::string begin = file.string() + process_mark();
  for (int attempt = 1; attempt <= kMostAttempts; ++attempt) {
    temporary = begin + (attempt > 1 ? "-" + std::to_string(attempt) : "") + std::string(kEnd);
    const int fd = ::open(temporary.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (fd >= 0) return ::fdopen(fd, "w+b");
    if (errno != EEXIST) return nullptr;
  }
  return nullptr;
}

fs::path temporary_name(const fs::path& file) { return file.string() + process_mark() + std::string(kEnd); }

void remove_stale_temporaries(const fs::path& folder,
                              const std::function<bool(const std::string& name)>& is_ours) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string text = entry->path().filename().string();
    std::error_code ignored;
    if (!text.ends_with(kEnd) || !fs::is_regular_file(entry->symlink_status(ignored))) continue;
    const std::string stem = text.substr(0, text.size() - kEnd.size());
    const auto name = name_in(stem, is_ours);
    if (name && is_abandoned(entry->path(), std::string_view(stem).substr(name->size()))) {
      fs::remove(entry->path(), ignored);
    }
  }
}

}  // namespace vpe::base
