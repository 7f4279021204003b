#include "vpe/window/layers/layer_loader.h"

#include <algorithm>
#include <exception>

namespace vpe::window {
namespace {

LoadedFile read_for_window(const std::string& path, double radius_m, std::size_t number) {
  LoadedFile file;
  try {
    file.layers = overlay::read_layer_file(path, radius_m, number);
    for (const auto& layer : file.layers) file.features += layer->layer().features.size();
    file.state = LoadedFile::State::kRead;
  } catch (const std::exception& e) {
    file.error = e.what();
    file.state = LoadedFile::State::kFailed;
  }
  return file;
}

}  // namespace

LayerLoader::LayerLoader(double radius_m, std::function<void()> notify)
    : worker_(
          [radius_m](const Request& request) {
            return Read(request.path, read_for_window(request.path, radius_m, request.number));
          },
          std::move(notify)) {}

void LayerLoader::want(std::span<const std::string> paths) {
  const std::size_t gone = std::erase_if(
      known_, [&](const auto& entry) { return std::ranges::find(paths, entry.first) == paths.end(); });
  for (const std::string& path : paths) known_.try_emplace(path);
  if (gone > 0) publish();
  begin_next();
}

void LayerLoader::reload(const std::string& path) {
  const auto found = known_.find(path);
  if (found == known_.end() || reading_ == path) return;
  found->second = {};
  publish();
  begin_next();
}

bool LayerLoader::update() {
  std::optional<Read> read = worker_.take();
  if (!read) return false;
  reading_.clear();
  if (const auto found = known_.find(read->first); found != known_.end()) {
    found->second = std::move(read->second);
    publish();
  }
  begin_next();
  return true;
}

const LoadedFile* LayerLoader::find(const std::string& path) const {
  const auto found = known_.find(path);
  return found == known_.end() ? nullptr : &found->second;
}

void LayerLoader::begin_next() {
  if (!reading_.empty()) return;
  const auto next = std::ranges::find_if(
      known_, [](const auto& entry) { return entry.second.state == LoadedFile::State::kWaits; });
  if (next == known_.end()) return;
  reading_ = next->first;
  const std::size_t number = numbers_.try_emplace(reading_, numbers_.size()).first->second;
  worker_.request({reading_, number});
}

void LayerLoader::publish() {
  overlay::LayersByFile files;
  for (const auto& [path, file] : known_)
    if (file.state == LoadedFile::State::kRead) files.emplace(path, file.layers);
  files_ = std::make_shared<const overlay::LayersByFile>(std::move(files));
  ++revision_;
}

}  // namespace vpe::window
