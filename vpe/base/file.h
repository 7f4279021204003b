// Whole files: read at once, and written so that they appear under their name only when complete.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace vpe::base {

// A file that cannot be read or written. what() names the file, the operation, the system's or library's own
// words, and what to do.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// "cannot OPERATION 'PATH': WORDS; ADVICE"
FileError file_error(std::string_view operation, const std::filesystem::path& path, std::string_view words,
                     std::string_view advice);

// Writes to PATH.tmp, or to the name given for that; commit() renames it to PATH, replacing what was there.
// Without commit() the destructor removes it and leaves PATH as it was. One writer a temporary name at a time.
class OutputFile {
 public:
  // Throws FileError when the file cannot be made.
  explicit OutputFile(std::filesystem::path path);
  OutputFile(std::filesystem::path path, std::filesystem::path temporary);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& temporary() const { return temporary_; }
  std::FILE* stream() const { return stream_; }  // may be read and written

  // Throws FileError, as for a full disk.
  void write(std::span<const std::uint8_t> bytes);
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::FILE* stream_ = nullptr;
};

// A whole file at once, by way of OutputFile.
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

// Throws FileError, also for a folder and for more than max_bytes.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::uintmax_t max_bytes);

}  // namespace vpe::base
