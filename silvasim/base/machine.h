// What the machine has.
#pragma once

#include <cstdint>

namespace silvasim::base {

std::uint64_t memory_bytes();    // in all; 0 where the system does not tell
std::uint64_t peak_rss_bytes();  // the most that this process has held so far

}  // namespace silvasim::base
