// Parallel loops over oneTBB, with results that do not depend on the number of threads.
//
// Threads: from inside a loop, other loops may be started.
#pragma once

#include <cstddef>
#include <functional>

namespace silvasim::base {

// Limits all loops while it lives. 0 means one thread a core.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;
  ~ThreadLimit();

 private:
  void* control_;
};

int thread_count();

// Calls body(i) once for each i in [0, count), in any order, on any thread. The first exception is rethrown.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace silvasim::base
