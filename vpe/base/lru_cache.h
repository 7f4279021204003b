// A byte-bounded cache of shared, immutable values; least recently used ones leave first.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace vpe::base {

// Any thread may call any member. A value stays alive as long as somebody holds it, also after it has left
// the cache; bytes() counts what the cache itself holds, entries included, and stays within the limit except
// that the newest value is always kept.
template <typename Key, typename Value, typename Hash>
class LruCache {
 public:
  explicit LruCache(std::size_t limit_bytes) : limit_(limit_bytes) {}

  std::shared_ptr<const Value> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto at = index_.find(key);
    if (at == index_.end()) return nullptr;
    order_.splice(order_.begin(), order_, at->second);
    return at->second->value;
  }

  // Returns the value that the cache now holds for the key: an earlier one wins, so that all callers share.
  std::shared_ptr<const Value> insert(const Key& key, std::shared_ptr<const Value> value, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    const auto at = index_.find(key);
    if (at != index_.end()) return at->second->value;
    order_.push_front({key, std::move(value), bytes + kEntryBytes});
    index_.emplace(key, order_.begin());
    bytes_ += order_.front().bytes;
    while (bytes_ > limit_ && order_.size() > 1) {
      bytes_ -= order_.back().bytes;
      index_.erase(order_.back().key);
      order_.pop_back();
    }
    return order_.front().value;
  }

  // find, or else load() (outside the lock: two threads may load the same value, one is kept).
  // load returns {shared_ptr<const Value>, bytes}.
  template <typename Load>
  std::shared_ptr<const Value> get(const Key& key, Load&& load) {
    if (auto found = find(key)) return found;
    auto [value, bytes] = load();
    return insert(key, std::move(value), bytes);
  }

  void clear() {
    const std::lock_guard lock(mutex_);
    index_.clear();
    order_.clear();
    bytes_ = 0;
  }

  std::size_t bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
  }

 private:
  struct Entry {
    Key key;
    std::shared_ptr<const Value> value;
    std::size_t bytes;
  };
  static constexpr std::size_t kEntryBytes = 128;  // list and map nodes

  mutable std::mutex mutex_;
  std::size_t limit_;
  std::size_t bytes_ = 0;
  std::list<Entry> order_;
  std::unordered_map<Key, typename std::list<Entry>::iterator, Hash> index_;
};

}  // namespace vpe::base
