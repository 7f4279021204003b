// Containers that hold values within a budget of bytes and evict the least recently used ones first.
//
// LruList keeps only order and sizes, for one thread; its owner keeps an index of handles.
// LruCache holds shared, immutable values by key, for any number of threads.
//
// Typical usage:
//   LruCache<TileKey, Tile, TileKeyHash> tiles(64 << 20);
//   const auto tile = tiles.get(key, [&] {
//     auto loaded = std::make_shared<const Tile>(load(key));
//     return std::pair(loaded, loaded->bytes());
//   });
#pragma once

#include <condition_variable>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace vpe::base {

// Keeps values of any movable type in order of use. Handles and pointers to values stay valid until the entry
// leaves. Not synchronised.
template <class Value>
class LruList {
 public:
  struct Entry {
    Value value;
    std::size_t bytes = 0;
  };
  using Entries = std::list<Entry>;
  using Handle = typename Entries::iterator;

  // Adds a value as the most recently used one.
  Handle add(Value value, std::size_t bytes) {
    entries_.push_front(Entry{std::move(value), bytes});
    bytes_ += bytes;
    return entries_.begin();
  }

  // Makes an entry the most recently used one.
  void touch(Handle at) { entries_.splice(entries_.begin(), entries_, at); }

  // Removes an entry and returns it, so that the caller can choose when it is destroyed.
  Entries erase(Handle at) {
    Entries gone;
    bytes_ -= at->bytes;
    gone.splice(gone.end(), entries_, at);
    return gone;
  }

  // Removes the least recently used entries whose values may leave, until bytes() is at most `limit` or none is
  // left that may. Returns them, least recently used first, so that the caller can update its index.
  template <class MayLeave>
  Entries trim(std::size_t limit, const MayLeave& may_leave) {
    Entries gone;
    for (Handle at = entries_.end(); bytes_ > limit && at != entries_.begin();) {
      --at;
      if (!may_leave(std::as_const(at->value))) continue;
      const Handle leaving = at++;
      bytes_ -= leaving->bytes;
      gone.splice(gone.end(), entries_, leaving);
    }
    return gone;
  }
  // Keeps the most recently used entry whatever its size.
  Entries trim(std::size_t limit) {
    return trim(limit, [this](const Value& value) { return &value != &entries_.front().value; });
  }

  // Removes all entries and returns them.
  Entries clear() {
    bytes_ = 0;
    return std::exchange(entries_, Entries());
  }

  // Iterates from the most to the least recently used entry.
  Handle begin() { return entries_.begin(); }
  Handle end() { return entries_.end(); }

  std::size_t size() const { return entries_.size(); }
  std::size_t bytes() const { return bytes_; }

 private:
  Entries entries_;
  std::size_t bytes_ = 0;
};

// Shares immutable values by key. Any thread may call any member. A value stays alive as long as a caller holds
// its pointer, also after it has left the cache. bytes() counts what the cache itself holds, including
// `entry_bytes` for each entry, and stays within the limit except that the newest value is always kept. Values
// are destroyed outside the lock.
//
// `Value` may be void for a cache of values of several types.
template <typename Key, typename Value, typename Hash>
class LruCache {
 public:
  using Pointer = std::shared_ptr<const Value>;
  static constexpr std::size_t kEntryBytes = 128;  // memory of list and map nodes

  // A smaller limit saves memory and loads values more often. `entry_bytes` is added to the size of each value.
  explicit LruCache(std::size_t limit_bytes, std::size_t entry_bytes = kEntryBytes)
      : limit_(limit_bytes), entry_bytes_(entry_bytes) {}
  LruCache(const LruCache&) = delete;
  LruCache& operator=(const LruCache&) = delete;

  // Returns the value and marks it as used, or returns null.
  Pointer find(const Key& key) {
    const std::lock_guard lock(mutex_);
    return find_locked(key);
  }

  // Returns the value that the cache now holds for the key: an earlier one wins, so that all callers share it.
  Pointer insert(const Key& key, Pointer value, std::size_t bytes) {
    Entries gone;  // declared before the lock, so that it is destroyed after it
    const std::lock_guard lock(mutex_);
    return insert_locked(key, std::move(value), bytes, gone);
  }

  // Returns the value, or else inserts and returns what load() makes: a pair of Pointer and bytes. load() runs
  // outside the lock: two threads may load the same value at once, and one result is kept. Throws what load()
  // throws.
  template <typename Load>
  Pointer get(const Key& key, Load&& load) {
    if (auto found = find(key)) return found;
    auto [value, bytes] = load();
    return insert(key, std::move(value), bytes);
  }

  // Does the same, but several threads that ask for one key wait for one load(). If it throws, the thread that
  // called it gets the exception and the next one calls its own load(). Use it where loading costs more than
  // waiting. A load() must not ask the same cache for the same key.
  template <typename Load>
  Pointer get_once(const Key& key, Load&& load) {
    Entries gone;
    std::unique_lock lock(mutex_);
    for (;;) {
      if (auto found = find_locked(key)) return found;
      if (loading_.insert(key).second) break;
      loaded_.wait(lock);
    }
    lock.unlock();
    try {
      auto [value, bytes] = load();
      lock.lock();
      Pointer kept = insert_locked(key, std::move(value), bytes, gone);
      end_loading(key, lock);
      return kept;
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      end_loading(key, lock);
      throw;
    }
  }

  // Removes the value of a key, if there is one.
  void erase(const Key& key) {
    Entries gone;
    const std::lock_guard lock(mutex_);
    const auto at = index_.find(key);
    if (at == index_.end()) return;
    gone = list_.erase(at->second);
    index_.erase(at);
  }

  // Removes the values of all keys for which is_gone(key) is true.
  template <typename Predicate>
  void erase_if(const Predicate& is_gone) {
    Entries gone;
    const std::lock_guard lock(mutex_);
    for (auto at = list_.begin(); at != list_.end();) {
      const auto next = std::next(at);
      if (is_gone(std::as_const(at->value.key))) {
        index_.erase(at->value.key);
        gone.splice(gone.end(), list_.erase(at));
      }
      at = next;
    }
  }

  // Removes all values.
  void clear() {
    Entries gone;
    const std::lock_guard lock(mutex_);
    index_.clear();
    gone = list_.clear();
  }

  // Changes the budget and removes what exceeds it.
  void set_limit(std::size_t bytes) {
    Entries gone;
    const std::lock_guard lock(mutex_);
    limit_ = bytes;
    trim_locked(gone);
  }

  std::size_t bytes() const {
    const std::lock_guard lock(mutex_);
    return list_.bytes();
  }

 private:
  struct Item {
    Key key;
    Pointer value;
  };
  using List = LruList<Item>;
  using Entries = typename List::Entries;

  Pointer find_locked(const Key& key) {
    const auto at = index_.find(key);
    if (at == index_.end()) return nullptr;
    list_.touch(at->second);
    return at->second->value.value;
  }

  Pointer insert_locked(const Key& key, Pointer value, std::size_t bytes, Entries& gone) {
    const auto at = index_.find(key);
    if (at != index_.end()) return at->second->value.value;
    const auto added = list_.add({key, std::move(value)}, bytes + entry_bytes_);
    index_.emplace(key, added);
    trim_locked(gone);
    return added->value.value;
  }

  void trim_locked(Entries& gone) {
    gone = list_.trim(limit_);
    for (const auto& entry : gone) index_.erase(entry.value.key);
  }

  void end_loading(const Key& key, std::unique_lock<std::mutex>& lock) {
    loading_.erase(key);
    lock.unlock();
    loaded_.notify_all();
  }

  mutable std::mutex mutex_;
  std::condition_variable loaded_;
  std::size_t limit_;
  std::size_t entry_bytes_;
  List list_;
  std::unordered_map<Key, typename List::Handle, Hash> index_;
  std::unordered_set<Key, Hash> loading_;
};

}  // namespace vpe::base
