// Reading and writing of whole files. A file that is written appears under its name only when it is complete.
//
// Typical usage:
//   write_file("settings.toml", text);
//
//   OutputFile file("image.png");  // for output in pieces
//   while (has_more()) file.write(next_bytes());
//   file.commit();  // without this the destructor removes what was written
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace vpe::base {

// Reports a file that cannot be read or written. what() names the file, the operation, the message of the
// system or the library, and what to do.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Returns the error "cannot OPERATION 'PATH': REASON; ADVICE".
FileError file_error(std::string_view operation, const std::filesystem::path& path, std::string_view reason,
                     std::string_view advice);

// Returns the file that `path` names through symbolic links, which need not exist. Links that lead to a device or
// a pipe are not followed. Throws FileError for links that go in circles.
std::filesystem::path resolve_links(const std::filesystem::path& path);

// Writes a file under a temporary name beside it, as make_temporary() does. commit() renames it to its final
// name and replaces the former file. Without commit() the destructor removes the temporary file and leaves the
// former one unchanged. A symbolic link stays: the file that it leads to is replaced. Several writers may write
// the same file; the last one to commit wins. A pipe or character device (/dev/stdout) gets the whole content
// at commit(), which waits for the reader of a pipe.
class OutputFile {
 public:
  // Throws FileError if the file cannot be made.
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // The file that is written until commit(). Another program may fill it.
  const std::filesystem::path& temporary() const { return temporary_; }
  std::FILE* stream() const { return stream_; }  // open for reading and writing

  // Throw FileError, for example if the disk is full. After flush() the temporary file holds what was written.
  void write(std::span<const std::uint8_t> bytes);
  void flush();
  void commit();

 private:
  int copy_to_stream() const;

  std::filesystem::path path_;
  std::filesystem::path target_;  // path_ without links
  std::filesystem::path temporary_;
  bool is_stream_ = false;  // a pipe or character device
  std::FILE* stream_ = nullptr;
};

// Writes a whole file by means of OutputFile. Throws FileError.
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

// Describes a state of a file. Two stamps of one name differ if another file has taken the name, or if the file
// was written to in between.
struct FileStamp {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::int64_t size_bytes = 0;
  std::int64_t modified_ns = 0;  // since 1970

  bool operator==(const FileStamp&) const = default;
  // Returns true if both are of one file, whatever was written to it.
  bool is_same_file(const FileStamp& other) const { return device == other.device && inode == other.inode; }
};

// Return the stamp of the file that has this name now, or of an open file; nullopt if there is none.
std::optional<FileStamp> file_stamp(const std::filesystem::path& path);
std::optional<FileStamp> file_stamp(int descriptor);

// Returns the bytes of a whole file. Throws FileError, also for a folder and for more than max_bytes.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::uintmax_t max_bytes);

}  // namespace vpe::base
