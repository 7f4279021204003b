// What every use of GDAL needs: silence on stderr, the library's own words, handles that go round.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "mars/sources/source.h"

namespace mars {

// While it lives, GDAL and PROJ say nothing on this thread's stderr; message() is the last thing they said.
class GdalScope {
 public:
  GdalScope();
  ~GdalScope();
  GdalScope(const GdalScope&) = delete;
  GdalScope& operator=(const GdalScope&) = delete;

  std::string message() const;
};

// "PATH: OPERATION: WORDS; ADVICE". Empty words are left out.
SourceError source_error(const std::string& path, const std::string& operation, const std::string& words,
                         const std::string& advice);

// Objects that only one thread may use at a time (datasets, transformations), lent to whoever asks and made
// when none is free. Nothing is tied to a thread, so threads may come and go. Any thread may call lend().
template <class T>
class LeasePool {
 public:
  using Pointer = std::unique_ptr<T, std::function<void(T*)>>;

  explicit LeasePool(std::function<Pointer()> make) : make_(std::move(make)) {}

  class Lease {
   public:
    Lease(LeasePool& pool, Pointer object) : pool_(&pool), object_(std::move(object)) {}
    Lease(Lease&&) noexcept = default;
    ~Lease() {
      if (!object_) return;
      const std::lock_guard lock(pool_->mutex_);
      pool_->free_.push_back(std::move(object_));
    }
    T* operator->() const { return object_.get(); }
    T& operator*() const { return *object_; }

   private:
    LeasePool* pool_;
    Pointer object_;
  };

  Lease lend() {
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        Pointer object = std::move(free_.back());
        free_.pop_back();
        return Lease(*this, std::move(object));
      }
    }
    return Lease(*this, make_());
  }

 private:
  std::function<Pointer()> make_;
  std::mutex mutex_;
  std::vector<Pointer> free_;
};

}  // namespace mars
