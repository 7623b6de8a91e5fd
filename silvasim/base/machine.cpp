#include "silvasim/base/machine.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include "silvasim/base/huge_vector.h"
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace silvasim::base {

std::uint64_t memory_bytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && size > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size) : 0;
}

std::uint64_t peak_rss_bytes() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

void give_back_large_blocks() {
#ifdef __GLIBC__
  // Without this the limit grows with the blocks that are freed, up to 32 MB.
  mallopt(M_MMAP_THRESHOLD, 256 << 10);
#endif
}

void give_back_free_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void give_back_pages(void* buffer, std::size_t bytes) {
  static const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGE_SIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(buffer);
  const std::uintptr_t first = (begin + page - 1) / page * page, end = (begin + bytes) / page * page;
  if (first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_DONTNEED);
}

void ask_for_huge_pages(void* buffer, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  // Whole pages only: a last one that is hardly used would take 2 MB all the same.
  constexpr std::size_t huge_page = std::size_t{2} << 20;
  madvise(buffer, bytes / huge_page * huge_page, MADV_HUGEPAGE);
#else
  (void)buffer;
  (void)bytes;
#endif
}

}  // namespace silvasim::base
