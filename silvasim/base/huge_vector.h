// A vector whose larger buffers ask for pages of 2 MB: random reads of many megabytes otherwise spend much of their time on
// finding pages. Where the system has none, it is a plain vector.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace silvasim::base {

// Advises the system about a buffer that is aligned to 2 MB.
void ask_for_huge_pages(void* buffer, std::size_t bytes);

template <typename T>
struct HugeAllocator {
  using value_type = T;
  static constexpr std::size_t huge_page = std::size_t{2} << 20;

  HugeAllocator() = default;
  template <typename U>
  HugeAllocator(const HugeAllocator<U>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < huge_page) return static_cast<T*>(::operator new(bytes, std::align_val_t{64}));
    void* const buffer = ::operator new(bytes, std::align_val_t{huge_page});
    ask_for_huge_pages(buffer, bytes);
    return static_cast<T*>(buffer);
  }
  void deallocate(T* buffer, std::size_t count) {
    ::operator delete(buffer, std::align_val_t{count * sizeof(T) < huge_page ? 64 : huge_page});
  }

  friend bool operator==(const HugeAllocator&, const HugeAllocator&) { return true; }
};

template <typename T>
using HugeVector = std::vector<T, HugeAllocator<T>>;

}  // namespace silvasim::base
