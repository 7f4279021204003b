// A pool of objects that are costly to make and that only one thread may use at a time: file handles, database
// connections, coordinate transformations, scratch memory.
//
// Typical usage:
//   ObjectPool<Reader> readers([path] { return std::make_unique<Reader>(path); });
//   ...
//   const auto reader = readers.acquire();  // in any thread
//   reader->read(...);
//   // The destructor of `reader` returns the object to the pool.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace vpe::base {

// Describes how a pool treats objects that are returned.
template <class T>
struct ObjectPoolOptions {
  // Destroys an object instead of keeping it when its lease ends because an exception propagates. Set it for
  // objects that an interrupted operation may leave in an undefined state.
  bool discard_on_exception = false;
  // Limits the number of idle objects. An object that is returned beyond the limit is destroyed. More than this
  // number may be in use at once.
  std::size_t max_idle = std::numeric_limits<std::size_t>::max();
  // Prepares an object for its next user when it is returned; may be empty. Runs on the returning thread,
  // outside the lock. An object whose reset() throws is destroyed, and the exception is dropped.
  std::function<void(T&)> reset = {};
};

// Lends objects, and makes a new one when none is idle. The object returned last is lent first, because its
// memory is most likely still in the processor's caches. Objects are not tied to threads. Any thread may call
// any member. The pool must outlive its leases.
//
// T may be incomplete where the pool is declared as a member, as long as the owner's constructors and
// destructor are defined where T is complete.
template <class T, class Deleter = std::default_delete<T>>
class ObjectPool {
 public:
  using Pointer = std::unique_ptr<T, Deleter>;
  using Options = ObjectPoolOptions<T>;

  // Grants use of one object until the lease is destroyed. Only one thread at a time may use a lease. With
  // discard_on_exception it must be destroyed by the thread that acquired it.
  class Lease {
   public:
    Lease(Lease&& other) noexcept = default;
    Lease& operator=(Lease&&) = delete;
    ~Lease() {
      if (object_ == nullptr) return;
      if (pool_->options_.discard_on_exception && std::uncaught_exceptions() > exceptions_) return;
      pool_->give_back(std::move(object_));
    }

    T* get() const { return object_.get(); }
    T* operator->() const { return object_.get(); }
    T& operator*() const { return *object_; }

    // Destroys the object now instead of returning it, for objects found damaged. Leaves the lease empty.
    void discard() { object_.reset(); }

   private:
    friend class ObjectPool;
    Lease(ObjectPool& pool, Pointer object) : pool_(&pool), object_(std::move(object)) {}

    ObjectPool* pool_;
    Pointer object_;
    int exceptions_ = std::uncaught_exceptions();
  };

  // Calls T's default constructor for each new object.
  ObjectPool() : ObjectPool([] { return Pointer(new T()); }) {}
  // Calls `make` for each new object, on the thread that acquires it and outside the lock. Several threads may
  // call it at once. It must not return null.
  explicit ObjectPool(std::function<Pointer()> make, Options options = {})
      : make_(std::move(make)), options_(std::move(options)) {}
  ObjectPool(const ObjectPool&) = delete;
  ObjectPool& operator=(const ObjectPool&) = delete;

  // Lends an idle object or a new one. Throws what the factory throws.
  Lease acquire() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        Pointer object = std::move(idle_.back());
        idle_.pop_back();
        return Lease(*this, std::move(object));
      }
    }
    return Lease(*this, make_());
  }

  // Returns the number of objects that are kept and not in use.
  std::size_t idle_count() const {
    const std::lock_guard lock(mutex_);
    return idle_.size();
  }

 private:
  // Destroys `object` outside the lock when it is not kept.
  void give_back(Pointer object) noexcept {
    try {
      if (options_.reset) options_.reset(*object);
      const std::lock_guard lock(mutex_);
      if (idle_.size() < options_.max_idle) idle_.push_back(std::move(object));
    } catch (...) {
      // reset() failed or memory ran out: the pool works without this object.
    }
  }

  std::function<Pointer()> make_;
  Options options_;
  mutable std::mutex mutex_;
  std::vector<Pointer> idle_;
};

}  // namespace vpe::base
