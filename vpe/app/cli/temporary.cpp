#include "vpe/app/cli/temporary.h"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <optional>

#include "vpe/base/file.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kEnd = ".tmp";

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

// Returns true if the writer of NAME.HOST-PID.tmp, or of NAME.tmp, is known to be gone.
bool is_abandoned(const fs::path& file, std::string_view owner) {
  if (owner.empty()) return true;  // no version of this program names its files so
  const std::string here = "." + host() + "-";
  if (!owner.starts_with(here)) return is_old(file);
  const auto pid = base::parse_integer(owner.substr(here.size()));
  if (!pid || *pid < 1) return false;
  return ::kill(static_cast<pid_t>(*pid), 0) != 0 && errno == ESRCH;
}

// Returns the name of the file that NAME.OWNER.tmp was meant to become: the longest NAME that is ours.
std::optional<std::string> name_in(const std::string& text,
                                   const std::function<bool(const std::string&)>& is_ours) {
  for (std::size_t end = text.size(); end != std::string::npos && end > 0; end = text.rfind('.', end - 1)) {
    if (is_ours(text.substr(0, end))) return text.substr(0, end);
  }
  return std::nullopt;
}

}  // namespace

fs::path temporary_name(const fs::path& file) {
  return file.string() + "." + host() + "-" + std::to_string(::getpid()) + std::string(kEnd);
}

void write_whole(const fs::path& file, std::span<const std::uint8_t> bytes) {
  base::OutputFile out(file, temporary_name(file));
  out.write(bytes);
  out.commit();
}

void write_whole(const fs::path& file, const std::string& text) {
  write_whole(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void remove_stale_temporaries(const fs::path& folder,
                              const std::function<bool(const std::string& name)>& is_ours) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string text = entry->path().filename().string();
    if (!text.ends_with(kEnd)) continue;
    const std::string stem = text.substr(0, text.size() - kEnd.size());
    const auto name = name_in(stem, is_ours);
    std::error_code ignored;
    if (name && is_abandoned(entry->path(), std::string_view(stem).substr(name->size()))) {
      fs::remove(entry->path(), ignored);
    }
  }
}

}  // namespace vpe::app
