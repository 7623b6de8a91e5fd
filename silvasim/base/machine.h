// What the machine has.
#pragma once

#include <cstddef>
#include <cstdint>

namespace silvasim::base {

std::uint64_t memory_bytes();    // in all; 0 where the system does not tell
std::uint64_t peak_rss_bytes();  // the most that this process has held so far

// The system's allocator keeps freed memory for what may come. A program that makes large things once calls the first at its
// start: then blocks above a quarter of a megabyte go back to the system when they are freed. The second gives back what is
// free among smaller ones; it takes some milliseconds. Where the allocator is not glibc's they do nothing.
void give_back_large_blocks();
void give_back_free_memory();

// Gives the whole pages within a buffer back while it lives; what stood there is lost, and what is read there again is
// anything.
void give_back_pages(void* buffer, std::size_t bytes);

}  // namespace silvasim::base
