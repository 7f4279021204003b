// Reads vector files on a thread of its own, so that neither frames nor images wait for them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "vpe/base/latest_worker.h"
#include "vpe/overlay/layer_files.h"

namespace vpe::window {

// Holds what is known of a vector file.
struct LoadedFile {
  enum class State { kWaits, kRead, kFailed };
  State state = State::kWaits;
  overlay::LayerFeatures layers;  // of kRead
  std::size_t features = 0;       // in all layers
  std::string error;              // of kFailed
};

// Keeps vector files that are wanted, each read once, one after the other. For one calling thread at a time.
//
// Typical usage, in each iteration:
//   loader.want(paths);
//   if (loader.update()) draw_again();
//   request.layers = loader.files();
class LayerLoader {
 public:
  // Calls `notify` on the reading thread when a file was read. It must not throw.
  LayerLoader(double radius_m, std::function<void()> notify);

  // Begins to read files that are not there yet, and forgets those that are not among them.
  void want(std::span<const std::string> paths);
  // Reads a file anew, as it may have changed.
  void reload(const std::string& path);
  // Takes what was read, and begins with the next file. Returns true if something was.
  bool update();

  // Returns what is known of a file that is wanted, or null.
  const LoadedFile* find(const std::string& path) const;
  // Returns the files that were read without an error. The same pointer until they change.
  std::shared_ptr<const overlay::LayersByFile> files() const { return files_; }
  // Counts changes of files().
  std::uint64_t revision() const { return revision_; }
  // Returns true if nothing is read, and no result waits for update().
  bool is_idle() const { return reading_.empty() && worker_.is_idle(); }

 private:
  struct Request {
    std::string path;
    std::size_t number = 0;  // of its first colour
  };
  using Read = std::pair<std::string, LoadedFile>;

  void begin_next();
  void publish();

  std::map<std::string, LoadedFile> known_;
  std::shared_ptr<const overlay::LayersByFile> files_ = std::make_shared<const overlay::LayersByFile>();
  std::uint64_t revision_ = 0;
  std::string reading_;                         // the file that is read now; empty: none
  std::map<std::string, std::size_t> numbers_;  // of files that were wanted; they keep their colours
  base::LatestWorker<Request, Read> worker_;    // last: it uses the rest
};

}  // namespace vpe::window
