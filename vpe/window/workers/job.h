// Work that runs beside the window: images, films and panoramas that are being made.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vpe::window {

// Describes how far a job is.
struct JobState {
  bool is_running = false;
  double fraction = -1;  // of the work that is done, 0..1; negative: not known
  std::string text;      // the last message; after a failure what went wrong
  bool failed = false;   // it has ended without its result
};

// Interface of work in progress. For the window's thread; no call waits but the destructor, which stops the work.
class Job {
 public:
  virtual ~Job() = default;
  virtual JobState state() = 0;
  // Asks the work to end as soon as it can.
  virtual void stop() = 0;
};

// Starts a command of the program, given by its words without the program's name. Throws if it cannot be started.
using StartJob = std::function<std::unique_ptr<Job>(const std::vector<std::string>& words)>;

// Says what a job does: makes a file; shows one in a window of its own until that is closed; builds the planet file of
// a raster, which is opened then.
enum class JobKind { kMakes, kShows, kBuilds };

// Holds the jobs that run or have ended, oldest first. For the window's thread.
class JobList {
 public:
  struct Order {
    JobKind kind = JobKind::kMakes;
    std::string title;
    std::vector<std::string> words;  // of its command
    std::filesystem::path file;      // that is made, shown or built from
    std::filesystem::path project;   // that is opened with the planet; empty: none
  };
  struct Entry {
    Order order;
    std::unique_ptr<Job> job;  // null once it has ended
    JobState state;
    bool is_stopped = false;  // by the user
  };

  explicit JobList(StartJob start) : start_(std::move(start)) {}

  // Starts a command. Returns what is wrong, or "".
  std::string start(Order order);
  // Asks the jobs how far they are. Returns the entries that have ended since the last call.
  std::vector<std::size_t> update();
  const std::vector<Entry>& entries() const { return entries_; }
  void stop(std::size_t index);
  // Removes an entry; a job that runs is stopped first.
  void remove(std::size_t index);
  bool is_running() const;
  bool can_start() const { return static_cast<bool>(start_); }

 private:
  StartJob start_;
  std::vector<Entry> entries_;
};

}  // namespace vpe::window
