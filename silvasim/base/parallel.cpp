#include "silvasim/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>

namespace silvasim::base {

ThreadLimit::ThreadLimit(int threads)
    : control_(new tbb::global_control(
          tbb::global_control::max_allowed_parallelism,
          static_cast<std::size_t>(threads > 0 ? threads : tbb::info::default_concurrency()))) {}

ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  // The library orders its threads before and after the loop, but ThreadSanitizer can't see that through a library that was
  // built without it. These two atomics say it again, where it can; they cost nothing beside a body.
  std::atomic<bool> begun{true};
  std::atomic<std::size_t> ended{0};
  begun.store(true, std::memory_order_release);
  // An arena of our own, because the library's has no more places than the machine has cores.
  tbb::task_arena arena(thread_count());
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      if (begun.load(std::memory_order_acquire)) body(i);
      ended.fetch_add(1, std::memory_order_release);
    });
  });
  (void)ended.load(std::memory_order_acquire);
}

}  // namespace silvasim::base
