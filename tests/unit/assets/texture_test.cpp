#include "assets/texture.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <thread>

#include "files.h"
#include "made_glb.h"
#include "pictures.h"

namespace assets {
namespace {

using namespace test;
using testing::HasSubstr;

Texture read_file(const fs::path& file, const TextureOptions& options) {
  return load_texture({file.filename().string(), file, {}}, nullptr, options);
}

std::string texture_error(const fs::path& file) {
  try {
    read_file(file, {});
    return "";
  } catch (const silvasim::base::Error& error) {
    return error.what();
  }
}

// The truth of a reduction, found by counting in the file's own pixels.
double share_at_least(int width, int height, float cutoff, const std::function<Pixel(int, int)>& pixel) {
  std::size_t count = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) count += pixel(x, y)[3] >= cutoff * 255 ? 1 : 0;
  }
  return static_cast<double>(count) / (static_cast<double>(width) * height);
}

TEST(Texture, SmallPicturesAreKeptToTheByte) {
  const Folder folder;
  const auto pixel = [](int x, int y) {
    return Pixel{static_cast<std::uint8_t>(40 * x), static_cast<std::uint8_t>(60 * y), 7,
                 static_cast<std::uint8_t>(255 - 30 * x)};
  };
  for (const char* name : {"a.png", "a.tga", "a.tif"}) {
    write_picture(folder.path() / name, 6, 4, 4, pixel);
    const Texture t = read_file(folder.path() / name, {.alpha_cutoff = 0.5f});
    ASSERT_EQ(t.width, 6) << name;
    ASSERT_EQ(t.height, 4) << name;
    EXPECT_TRUE(t.has_alpha);
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 6; ++x) {
        const Pixel p = pixel(x, y);
        for (std::size_t c = 0; c < 4; ++c)
          EXPECT_EQ(t.rgba[4 * static_cast<std::size_t>(6 * y + x) + c], p[c]) << name;
      }
    }
    const Texture opaque = read_file(folder.path() / name, {});
    EXPECT_FALSE(opaque.has_alpha);
    for (std::size_t i = 3; i < opaque.rgba.size(); i += 4) EXPECT_EQ(opaque.rgba[i], 255);
  }
}

TEST(Texture, OneToFourChannels) {
  const Folder folder;
  for (int channels = 1; channels <= 4; ++channels) {
    write_picture(folder.path() / "a.png", 3, 2, channels, [](int, int) { return Pixel{200, 100, 50, 128}; });
    const Texture t = read_file(folder.path() / "a.png", {.alpha_cutoff = 0.1f});
    EXPECT_EQ(t.rgba[0], 200);
    EXPECT_EQ(t.rgba[1], channels < 3 ? 200 : 100);
    EXPECT_EQ(t.rgba[2], channels < 3 ? 200 : 50);
    EXPECT_EQ(t.rgba[3], channels % 2 == 0 ? 128 : 255) << channels;
  }
}

TEST(Texture, CoverageStaysWithinOnePercentWhenReduced) {
  const Folder folder;
  struct Case {
    const char* name;
    std::function<Pixel(int, int)> pixel;
  };
  const std::vector<Case> cases{
      {"needles",
       [](int x, int y) {
         return Pixel{20, 90, 10, static_cast<std::uint8_t>((x + y / 3) % 9 == 0 ? 255 : 0)};
       }},
      {"noise",
       [](int x, int y) {
         return Pixel{20, 90, 10,
                      static_cast<std::uint8_t>(scatter(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)))};
       }},
      {"chess",
       [](int x, int y) {
         return Pixel{20, 90, 10, static_cast<std::uint8_t>((x + y) % 2 == 0 ? 255 : 0)};
       }},
      {"disc",
       [](int x, int y) {
         return Pixel{20, 90, 10, static_cast<std::uint8_t>(std::hypot(x - 300, y - 200) < 150 ? 255 : 0)};
       }},
      {"grains",
       [](int x, int y) {
         return Pixel{20, 90, 10,
                      static_cast<std::uint8_t>(
                          scatter(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)) % 50 == 0 ? 255 : 0)};
       }},
  };
  for (const Case& c : cases) {
    const fs::path file = folder.path() / (std::string(c.name) + ".png");
    write_picture(file, 601, 407, 4, c.pixel);
    for (const float cutoff : {0.2f, 0.5f, 0.9f}) {
      const Texture t = read_file(file, {.most_px = 64, .alpha_cutoff = cutoff});
      EXPECT_EQ(t.width, 64);
      EXPECT_EQ(t.height, 43);
      EXPECT_NEAR(coverage(t, cutoff), share_at_least(601, 407, cutoff, c.pixel), 0.001) << c.name << " " << cutoff;
    }
  }
}

TEST(Texture, ReductionKeepsMeanLightAndForgetsTheInvisible) {
  const Folder folder;
  // Stripes of black and white: the mean in linear light is 1/2, which is 188 in sRGB, not 128.
  write_picture(folder.path() / "stripes.png", 512, 512, 3, [](int x, int) {
    const std::uint8_t v = x % 2 == 0 ? 0 : 255;
    return Pixel{v, v, v, 255};
  });
  const Texture grey = read_file(folder.path() / "stripes.png", {.most_px = 32});
  for (std::size_t i = 0; i < grey.rgba.size(); i += 4) EXPECT_NEAR(grey.rgba[i], 188, 3);

  // Green leaves on invisible red: no red may show.
  write_picture(folder.path() / "leaf.png", 512, 512, 4, [](int x, int y) {
    return (x / 5 + y / 5) % 2 == 0 ? Pixel{10, 120, 10, 255} : Pixel{255, 0, 0, 0};
  });
  const Texture leaf = read_file(folder.path() / "leaf.png", {.most_px = 100, .alpha_cutoff = 0.5f});
  for (std::size_t i = 0; i < leaf.rgba.size(); i += 4) {
    EXPECT_LT(leaf.rgba[i], 40);
    EXPECT_GT(leaf.rgba[i + 1], 100);
  }
}

TEST(Texture, InvisibleTexelsTakeTheColourAroundThem) {
  const Folder folder;
  write_picture(folder.path() / "a.png", 16, 16, 4, [](int x, int) {
    return x < 8 ? Pixel{10, 120, 10, 255} : Pixel{0, 0, 0, 0};
  });
  const Texture t = read_file(folder.path() / "a.png", {.alpha_cutoff = 0.5f});
  for (std::size_t i = 0; i < t.rgba.size(); i += 4) EXPECT_EQ(t.rgba[i + 1], 120);
  EXPECT_NEAR(coverage(t, 0.5f), 0.5, 1e-9);
}

TEST(Texture, ASecondPictureMayHoldTheAlpha) {
  const Folder folder;
  write_picture(folder.path() / "colour.png", 40, 40, 3, [](int, int) { return Pixel{10, 120, 10, 255}; });
  write_picture(folder.path() / "mask.png", 80, 60, 1, [](int x, int) {
    const std::uint8_t v = x < 20 ? 255 : 0;
    return Pixel{v, v, v, 255};
  });
  const Picture colour{"colour.png", folder.path() / "colour.png", {}},
      mask{"mask.png", folder.path() / "mask.png", {}};
  const Texture t = load_texture(colour, &mask, {.alpha_cutoff = 0.5f});
  EXPECT_EQ(t.width, 80);
  EXPECT_EQ(t.height, 60);
  EXPECT_NEAR(coverage(t, 0.5f), 0.25, 1e-9);
  EXPECT_NEAR(coverage(load_texture(colour, &mask, {.most_px = 30, .alpha_cutoff = 0.5f}), 0.5f), 0.25, 0.002);
}

std::uint32_t crc(const std::string& bytes) {
  std::uint32_t c = 0xFFFFFFFFu;
  for (const char byte : bytes) {
    c ^= static_cast<unsigned char>(byte);
    for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xEDB88320u ^ (c >> 1) : c >> 1;
  }
  return ~c;
}

std::string big(std::uint32_t n) {
  return {static_cast<char>(n >> 24), static_cast<char>(n >> 16), static_cast<char>(n >> 8), static_cast<char>(n)};
}

std::string png_that_claims(std::uint32_t width, std::uint32_t height) {
  const std::string head = "IHDR" + big(width) + big(height) + std::string("\x08\x06\0\0\0", 5);
  const std::string data = "IDAT" + std::string("\x78\x9C\x03\0\0\0\0\x01", 8);
  return std::string("\x89PNG\r\n\x1A\n", 8) + big(13) + head + big(crc(head)) + big(8) + data + big(crc(data)) +
         big(0) + "IEND" + big(crc("IEND"));
}

long peak_kb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(Texture, ClaimsAreRefusedBeforeMemoryIsTaken) {
  const Folder folder;
  read_file(
      [&] {
        write_picture(folder.path() / "small.png", 4, 4, 4, [](int, int) { return Pixel{}; });
        return folder.path() / "small.png";
      }(),
      {});
  const long before = peak_kb();
  EXPECT_THAT(texture_error(folder.write("a.png", png_that_claims(60'000, 60'000))), HasSubstr("claims 60000 x 60000"));
  EXPECT_THAT(texture_error(folder.write("b.png", png_that_claims(16'384, 16'384))), HasSubstr("claims"));
  EXPECT_THAT(texture_error(folder.write("c.png", png_that_claims(16'385, 1))), HasSubstr("claims"));
  EXPECT_THAT(texture_error(folder.write("g.png", png_that_claims(4'000, 4'000))), HasSubstr("bytes cannot hold"));
  EXPECT_NE(texture_error(folder.write("d.png", png_that_claims(0, 5))), "");
  EXPECT_NE(texture_error(folder.write("e.png", png_that_claims(0x7FFFFFFF, 0x7FFFFFFF))), "");
  EXPECT_NE(texture_error(folder.write("f.png", png_that_claims(100, 100))), "");  // its pixels are missing
  EXPECT_LT(peak_kb() - before, 100'000);
}

TEST(Texture, WhatIsNoPictureIsAnError) {
  const Folder folder;
  EXPECT_THAT(texture_error(folder.write("a.png", "hello")), HasSubstr("no picture"));
  EXPECT_THAT(texture_error(folder.write("empty.png", "")), HasSubstr("no picture"));
  EXPECT_THAT(texture_error(folder.write("a.exr", "\x76\x2f\x31\x01")), HasSubstr("no picture"));
}

// A square with a texture "t", in three formats.
struct Textured {
  const char* file;
  std::string text;
};

std::vector<Textured> textured(const std::string& uri) {
  MadeGlb made = one_triangle();
  const int uv = made.accessor(made.view(std::vector<float>{0, 0, 1, 0, 0, 1}), 5126, "VEC2", 3);
  made.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uv;
  made.json["meshes"][0]["primitives"][0]["material"] = 0;
  made.json["materials"] = nlohmann::json::array({{{"alphaMode", "MASK"},
                                                   {"doubleSided", true},
                                                   {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  made.json["textures"] = nlohmann::json::array({{{"source", 0}}});
  made.json["images"] = nlohmann::json::array({{{"uri", uri}}});
  return {{"m.glb", made.glb()},
          {"m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 1\nvt 1 1\nvt 0 0\nusemtl a\nf 1/1 2/2 3/3\n"},
          {"m.ply", "ply\nformat ascii 1.0\ncomment TextureFile " + uri +
                        "\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
                        "s\nproperty float t\n"
                        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 1\n1 0 0 1 1\n0 1 "
                        "0 0 0\n3 0 1 2\n"}};
}

TEST(Texture, EachFormatFindsItsPictureAndPutsItUpright) {
  const Folder folder;
  write_picture(folder.path() / "t.png", 8, 8, 4, [](int x, int y) {
    return Pixel{static_cast<std::uint8_t>(x * 10), static_cast<std::uint8_t>(100 + y * 10), 0,
                 static_cast<std::uint8_t>(y < 4 ? 255 : 0)};
  });
  folder.write("m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd t.png\n");
  for (const Textured& t : textured("t.png")) {
    LoadReport report;
    const Model m = load(folder.write(t.file, t.text), {}, &report);
    EXPECT_THAT(report.warnings, testing::IsEmpty()) << t.file;
    ASSERT_EQ(broken_promise(m), "") << t.file;
    ASSERT_EQ(m.textures.size(), 1u) << t.file;
    EXPECT_EQ(m.materials[0].texture, 0);
    EXPECT_EQ(m.materials[0].alpha_cutoff, 0.5f) << t.file;
    EXPECT_GT(m.materials[0].transmittance.y, 0) << t.file << ": cut-out leaves let light through";
    // The vertex at (0, 0, 0) has the picture's upper left corner.
    for (std::size_t i = 0; i < 3; ++i) {
      if (m.positions[i] == V3(0.0f, 0.0f, 0.0f)) {
        EXPECT_EQ(m.uvs[i], V2(0.0f, 0.0f)) << t.file;
      }
    }
    EXPECT_EQ(m.textures[0].rgba[1], 100);
  }
}

TEST(Texture, MissingAndForbiddenPicturesAreWarningsWithAPlainColour) {
  const Folder folder;
  write_picture(folder.path() / "outside.png", 8, 8, 4, [](int, int) { return Pixel{1, 2, 3, 0}; });
  fs::create_directories(folder.path() / "model");
  fs::create_symlink("../outside.png", folder.path() / "model" / "link.png");
  fs::create_symlink("..", folder.path() / "model" / "up");
  fs::create_directories(folder.path() / "model" / "folder.png");
  folder.write("model/broken.png", png_that_claims(60'000, 60'000));
  struct Case {
    std::string uri, why;
  };
  const std::vector<Case> cases{{"none.png", "is missing"},
                                {"../outside.png", "leaves the model's folder"},
                                {"sub/../../outside.png", "leaves the model's folder"},
                                {"..\\outside.png", "leaves the model's folder"},
                                {(folder.path() / "outside.png").string(), "absolute path"},
                                {"C:\\textures\\a.png", "URL or a drive"},
                                {"https://example.org/a.png", "URL or a drive"},
                                {"file:///etc/passwd", "URL or a drive"},
                                {"link.png", "leads out"},
                                {"up/outside.png", "leads out"},
                                {"folder.png", "no regular file"},
                                {"<UDIM>.png", "pattern"},
                                {"broken.png", "claims 60000"}};
  for (const Case& c : cases) {
    folder.write("model/m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd " + c.uri + "\n");
    for (const Textured& t : textured(c.uri)) {
      LoadReport report;
      const Model m = load(folder.write(std::string("model/") + t.file, t.text), {}, &report);
      ASSERT_EQ(broken_promise(m), "");
      EXPECT_THAT(report.warnings, testing::ElementsAre(HasSubstr(c.why))) << t.file << " " << c.uri;
      EXPECT_EQ(m.textures.size(), 0u);
      EXPECT_EQ(m.materials[0].alpha_cutoff, 0) << "without its picture a leaf is a plain card";
      EXPECT_LT(m.materials[0].reflectance.x, 0.7f) << "white is no plant's colour";
    }
  }
}

TEST(Texture, EmbeddedPicturesAreReadFromMemory) {
  const Folder folder;
  write_picture(folder.path() / "t.png", 5, 3, 4, [](int x, int) {
    return Pixel{9, 99, 9, static_cast<std::uint8_t>(x == 0 ? 0 : 255)};
  });
  const std::string png = read(folder.path() / "t.png");
  MadeGlb made = one_triangle();
  made.json["meshes"][0]["primitives"][0]["material"] = 0;
  made.json["materials"] = nlohmann::json::array(
      {{{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  made.json["textures"] = nlohmann::json::array({{{"source", 0}}});
  const int view = made.view(std::vector<char>(png.begin(), png.end()));
  made.json["images"] = nlohmann::json::array({{{"bufferView", view}, {"mimeType", "image/png"}}});
  const Model in_view = load(folder.write("view.glb", made.glb()));

  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string uri = "data:image/png;base64,";
  for (std::size_t i = 0; i < png.size(); i += 3) {
    std::uint32_t n = 0;
    for (std::size_t k = 0; k < 3; ++k) n = n << 8 | (i + k < png.size() ? static_cast<unsigned char>(png[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) uri += i + k > png.size() ? '=' : digits[n >> (18 - 6 * k) & 63];
  }
  made.json["images"] = nlohmann::json::array({{{"uri", uri}}});
  const Model in_uri = load(folder.write("uri.glb", made.glb()));
  for (const Model* m : {&in_view, &in_uri}) {
    ASSERT_EQ(m->textures.size(), 1u);
    EXPECT_EQ(m->textures[0].width, 5);
    EXPECT_EQ(m->textures[0].rgba[5], 99);
    EXPECT_NEAR(coverage(m->textures[0], 0.5f), 0.8, 1e-9);
  }
  // A view that lies about its picture loses the picture, not the model.
  made.json["images"] = nlohmann::json::array({{{"bufferView", view}, {"mimeType", "image/png"}}});
  made.json["bufferViews"][static_cast<std::size_t>(view)]["byteLength"] = 1 << 30;
  LoadReport report;
  EXPECT_EQ(load(folder.write("lie.glb", made.glb()), {}, &report).textures.size(), 0u);
  EXPECT_THAT(report.warnings, testing::ElementsAre(HasSubstr("beyond its buffer")));
}

TEST(Texture, AChangedFileIsReadAnew) {
  const Folder folder;
  const fs::path file = folder.path() / "a.png";
  write_picture(file, 2, 2, 3, [](int, int) { return Pixel{1, 1, 1, 255}; });
  EXPECT_EQ(read_file(file, {}).rgba[0], 1);
  write_picture(file, 3, 2, 3, [](int, int) { return Pixel{2, 2, 2, 255}; });
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(5));
  EXPECT_EQ(read_file(file, {}).rgba[0], 2);
  EXPECT_EQ(read_file(file, {}).width, 3);
}

TEST(Texture, ThreadsReadTheSame) {
  const Folder folder;
  write_picture(folder.path() / "a.png", 300, 300, 4, [](int x, int y) {
    return Pixel{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 3, static_cast<std::uint8_t>(x ^ y)};
  });
  const TextureOptions options{.most_px = 77, .alpha_cutoff = 0.5f};
  const Texture once = read_file(folder.path() / "a.png", options);
  std::vector<Texture> many(8);
  std::vector<std::thread> threads;
  for (Texture& t : many) threads.emplace_back([&] { t = read_file(folder.path() / "a.png", options); });
  for (std::thread& thread : threads) thread.join();
  for (const Texture& t : many) EXPECT_EQ(t, once);
}

}  // namespace
}  // namespace assets
