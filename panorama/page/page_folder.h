// The folder of a web page: made under another name, and put in its place when it is complete.
#pragma once

#include <filesystem>
#include <string_view>

namespace panorama {

// Checks that a page can be written into a folder: it does not exist, is empty, or holds a page and nothing
// else. With `force` it may hold other files, which stay. Throws vpe::base::FileError that says what is in the
// way.
void check_page_folder(const std::filesystem::path& folder, bool force);

// Makes the files of a page. The destructor removes what was written unless finish() has been called.
//
// Typical usage:
//   PageFolder page(folder, force);
//   page.write("index.html", text);  // in any thread
//   page.finish();
class PageFolder {
 public:
  // Checks the folder, removes what killed runs left beside it, and makes a folder NAME.HOST-PID.tmp beside it.
  // Throws vpe::base::FileError.
  PageFolder(const std::filesystem::path& folder, bool force);
  ~PageFolder();
  PageFolder(const PageFolder&) = delete;
  PageFolder& operator=(const PageFolder&) = delete;

  // Makes a folder in the page's folder, and those above it.
  void make(const std::filesystem::path& name) const;
  // Writes a file; its folder must exist. Different files may be written by different threads.
  void write(const std::filesystem::path& name, std::string_view text) const;
  // Copies a file into the page's folder.
  void copy(const std::filesystem::path& from, const std::filesystem::path& name) const;

  // Puts the page in its place. A former page is replaced as a whole; beside other files the page's own are
  // replaced one by one. Throws vpe::base::FileError; the former page is then still there.
  void finish();

 private:
  std::filesystem::path folder_;
  std::filesystem::path draft_;
  bool force_;
};

}  // namespace panorama
