#include <gmock/gmock.h>

#include <bit>
#include <cstring>

#include "files.h"

namespace assets {
namespace {

using namespace test;
using testing::HasSubstr;

// A unit square in two faces with colours, in each of the three ways to write it.
std::string square(const std::string& format) {
  std::string text =
      "ply\nformat " + format +
      " 1.0\ncomment made here\nelement other 1\nproperty list uchar short stuff\nproperty double d\nelement vertex 4\n"
      "property float x\nproperty double y\nproperty short z\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nproperty ushort mark\nend_header\n";
  const bool big = format == "binary_big_endian";
  const auto put = [&](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (big) std::reverse(raw, raw + sizeof value);
    text.append(raw, sizeof value);
  };
  const float x[4] = {0, 1, 1, 0};
  const double y[4] = {0, 0, 1, 1};
  const int faces[2][3] = {{0, 1, 2}, {0, 2, 3}};
  if (format == "ascii") {
    text += "2 7 8 0.5\n";
    for (int i = 0; i < 4; ++i) text += std::to_string(x[i]) + " " + std::to_string(y[i]) + " 3 255 188 0\n";
    for (const auto& f : faces)
      text += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) + " 9\n";
    return text;
  }
  put(std::uint8_t{2}), put(std::int16_t{7}), put(std::int16_t{8}), put(0.5);
  for (int i = 0; i < 4; ++i) {
    put(x[i]), put(y[i]), put(std::int16_t{3}), put(std::uint8_t{255}), put(std::uint8_t{188}), put(std::uint8_t{0});
  }
  for (const auto& f : faces) {
    put(std::uint8_t{3});
    for (const int i : f) put(std::int32_t{i});
    put(std::uint16_t{9});
  }
  return text;
}

TEST(Ply, AllThreeFormatsSayTheSame) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const Folder folder;
    const Model m = load(folder.write("a.ply", square(format)));
    ASSERT_EQ(broken_promise(m), "") << format;
    ASSERT_EQ(m.triangles.size(), 2u);
    EXPECT_NEAR(surface(m), 1, 1e-6);
    EXPECT_EQ(m.positions[0], V3(0.0f, 0.0f, 3.0f));  // z is up as it is
    EXPECT_NEAR(m.normals[0].z, 1, 1e-6);
    // sRGB 255, 188, 0 is 1, 0.503, 0 in linear light.
    EXPECT_NEAR(m.materials[0].reflectance.x, 1, 1e-5);
    EXPECT_NEAR(m.materials[0].reflectance.y, 0.5029, 1e-3);
    EXPECT_NEAR(m.materials[0].reflectance.z, 0, 1e-5);
  }
}

TEST(Ply, StripsPolygonsAndCornerTextures) {
  const Folder folder;
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string square = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  const Model strip =
      load(folder.write("s.ply", head + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                                     square + "8 0 1 2 3 -1 0 1 2\n"));
  EXPECT_EQ(strip.triangles.size(), 3u);
  for (std::size_t t = 0; t < 3; ++t) {
    const auto& [a, b, c] = strip.triangles[t];
    EXPECT_GT((strip.positions[b] - strip.positions[a]).cross(strip.positions[c] - strip.positions[a]).z, 0) << t;
  }
  const Model polygon = load(folder.write(
      "p.ply",
      head + "element face 1\nproperty list uchar uint vertex_index\nproperty list uchar float texcoord\nend_header\n" +
          square + "4 0 1 3 2 8 0 0 1 0 1 1 0 1\n"));
  EXPECT_EQ(polygon.triangles.size(), 2u);
  EXPECT_NEAR(surface(polygon), 1, 1e-6);
}

TEST(Ply, YIsUpWhereTold) {
  const Folder folder;
  const Model m = load(folder.write("a.ply", square("ascii")), {.up = Up::y});
  EXPECT_EQ(m.positions[0], V3(0.0f, -3.0f, 0.0f));
}

TEST(Ply, ErrorsNameThePlace) {
  const Folder folder;
  const auto error_in = [&](const std::string& text) { return error_of(folder.write("a.ply", text)); };
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  EXPECT_EQ(error_in(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "");
  EXPECT_THAT(error_in(header + "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n"), HasSubstr("a.ply:12: \"nan\""));
  EXPECT_THAT(error_in(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), HasSubstr("vertex 3"));
  EXPECT_THAT(error_in(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"), HasSubstr("vertex -1"));
  EXPECT_THAT(error_in(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n"), HasSubstr("no such number"));
  EXPECT_THAT(error_in(header + "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"), HasSubstr("impossible length"));
  EXPECT_THAT(error_in(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), HasSubstr("ends too early"));
  EXPECT_THAT(error_in("ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n"),
              HasSubstr("too short"));
  EXPECT_THAT(error_in("ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n"), HasSubstr("a number"));
  EXPECT_THAT(error_in("ply\nformat ascii 1.0\nelement vertex 3\n"), HasSubstr("does not end"));
  EXPECT_THAT(error_in("ply\nformat pdp_endian 1.0\n"), HasSubstr("a.ply:2: "));
  EXPECT_THAT(error_in("plie\n"), HasSubstr("no PLY"));
  // A list that says it is long ends with the file, not with the memory.
  EXPECT_THAT(error_in("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty list uint uchar "
                       "x\nend_header\n\xFF\xFF\xFF\x7F"),
              testing::AnyOf(HasSubstr("lack x"), HasSubstr("impossible length")));
}

TEST(Ply, ElementsWithoutPropertiesCostNothing) {
  const Folder folder;
  EXPECT_THAT(
      error_of(folder.write(
          "a.ply", "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nelement vertex 0\nend_header\n")),
      HasSubstr("a.ply"));
}

}  // namespace
}  // namespace assets
