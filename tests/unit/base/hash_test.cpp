// Digests against published values.
#include "silvasim/base/hash.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "silvasim/base/error.h"

namespace silvasim::base {
namespace {

namespace fs = std::filesystem;

// FIPS 180-2, appendix B.
TEST(Sha256, EqualsTheStandardsExamples) {
  EXPECT_EQ(sha256_hex(std::string()), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex(std::string("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, OfAFileEqualsThatOfItsText) {
  const fs::path path = fs::temp_directory_path() / ("silva-hash-" + std::to_string(getpid()));
  for (const std::size_t size : {0u, 1u, 65535u, 65536u, 65537u, 200000u}) {
    std::string text(size, '\0');
    for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>(i * 7 + i / 256);
    std::ofstream(path, std::ios::binary) << text;
    EXPECT_EQ(sha256_of_file(path), sha256_hex(text)) << size;
  }
  fs::remove(path);
  EXPECT_THROW(sha256_of_file(path), Error);
  EXPECT_THROW(sha256_of_file(fs::temp_directory_path()), Error);
}

// The value for no bytes is well known; beside it, every bit and the length must matter.
TEST(Xxh3, EqualsTheKnownValueAndSeesEveryBit) {
  EXPECT_EQ(xxh3_64({}), 0x2D06800538D394C2u);
  std::string text(300, 'x');
  const std::uint64_t whole = xxh3_64(std::as_bytes(std::span(text)));
  EXPECT_NE(xxh3_64(std::as_bytes(std::span(text)).first(299)), whole);
  for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
    std::string flipped = text;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    ASSERT_NE(xxh3_64(std::as_bytes(std::span(flipped))), whole) << "bit " << bit;
  }
}

}  // namespace
}  // namespace silvasim::base
