// A vector whose resize() leaves numbers as the memory has them, so that the threads that fill it are the first to touch it.
// Zeroing hundreds of megabytes on one thread before would cost as much as a stage's work.
#pragma once

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace silvasim::base {

template <typename T>
struct LazyAllocator : std::allocator<T> {
  template <typename U>
  struct rebind {
    using other = LazyAllocator<U>;
  };
  template <typename U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

template <typename T>
using LazyVector = std::vector<T, LazyAllocator<T>>;

}  // namespace silvasim::base
