#include "silvasim/base/random.h"

#include <Random123/philox.h>

namespace silvasim::base {

void Stream::refill() {
  const r123::Philox4x32::ctr_type counter{{counter_[0], counter_[1], counter_[2], counter_[3]}};
  const r123::Philox4x32::key_type key{{key_[0], key_[1]}};
  const auto block = r123::Philox4x32()(counter, key);
  for (int i = 0; i < 4; ++i) block_[static_cast<std::size_t>(i)] = block[static_cast<std::size_t>(3 - i)];
  ++counter_[3];
  left_ = 4;
}

std::uint32_t Stream::next_below(std::uint32_t bound) {
  std::uint64_t product = std::uint64_t{next_u32()} * bound;
  if (static_cast<std::uint32_t>(product) < bound) {
    const std::uint32_t threshold = (0u - bound) % bound;
    while (static_cast<std::uint32_t>(product) < threshold) product = std::uint64_t{next_u32()} * bound;
  }
  return static_cast<std::uint32_t>(product >> 32);
}

}  // namespace silvasim::base
