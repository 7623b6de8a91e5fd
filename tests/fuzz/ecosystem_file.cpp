// Fuzzes ecosystem::from_bytes(). Plain changes to a compressed file seldom get past zstd, so most changes are made to
// what is inside: a chunk's content or its table entry, packed again with all checksums right.
#include "fuzz/ecosystem_file.h"

#include <random>

#include "silvasim/base/parallel.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using namespace silvasim::ecosystem;

const silvasim::base::ThreadLimit one_thread(1);  // so that a finding repeats

std::size_t below(std::mt19937& random, std::size_t bound) { return random() % bound; }

void change_content(Part& part, std::size_t most) {
  const std::size_t size = part.content.size();
  part.content.resize(std::max(size + 64, std::min(most, 2 * size)));
  part.content.resize(
      LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(part.content.data()), size, part.content.size()));
}

std::uint64_t odd_number(std::mt19937& random, std::uint64_t now) {
  static constexpr std::uint64_t odd[] = {
      0, 1, 2, 0xFF, 0xFFFF, 0x7FFFFFFF, 0xFFFFFFFF, std::uint64_t{1} << 62, ~std::uint64_t{0}};
  if (below(random, 2) == 0) return now + below(random, 5) - 2;
  return odd[below(random, std::size(odd))];
}

void change_entry(Part& part, std::mt19937& random) {
  switch (below(random, 9)) {
    case 0:
      part.flags = static_cast<std::uint16_t>(odd_number(random, part.flags));
      break;
    case 1:
      part.codec = static_cast<std::uint8_t>(below(random, 3));
      break;
    case 2:
      part.layer = static_cast<std::uint32_t>(odd_number(random, part.layer));
      break;
    case 3:
      part.first_row = static_cast<std::uint32_t>(odd_number(random, part.first_row));
      break;
    case 4:
      part.rows = static_cast<std::uint32_t>(odd_number(random, part.rows));
      break;
    case 5:
      part.content_size = odd_number(random, part.content.size());
      break;
    case 6:
      part.offset = odd_number(random, 24);
      break;
    case 7:
      part.stored_size = odd_number(random, part.content.size());
      break;
    default:
      part.type[below(random, 4)] = static_cast<char>(random());
      break;
  }
}

void change(Anatomy& anatomy, std::mt19937& random, std::size_t most) {
  auto& parts = anatomy.parts;
  if (parts.empty()) return;
  const std::size_t p = below(random, parts.size());
  switch (below(random, 12)) {
    case 0:
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(p));
      break;
    case 1:
      parts.push_back(parts[p]);
      break;
    case 2:
      std::swap(parts[p], parts[below(random, parts.size())]);
      break;
    case 3:
    case 4:
      change_entry(parts[p], random);
      break;
    case 5:
      parts[p].content = parts[below(random, parts.size())].content;
      break;
    default:
      change_content(parts[p], most);
      break;
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  std::mt19937 random(seed);
  if (below(random, 8) == 0) return LLVMFuzzerMutate(data, size, most);
  try {
    Anatomy anatomy = take_apart({reinterpret_cast<const std::byte*>(data), size});
    for (std::size_t i = 1 + below(random, 3); i > 0; --i) change(anatomy, random, most);
    const FileBytes file = put_together(anatomy);
    if (file.size() > most) return LLVMFuzzerMutate(data, size, most);
    std::memcpy(data, file.data(), file.size());
    return file.size();
  } catch (const std::runtime_error&) {
    return LLVMFuzzerMutate(data, size, most);
  }
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try_file({reinterpret_cast<const std::byte*>(data), size});
  return 0;
}
