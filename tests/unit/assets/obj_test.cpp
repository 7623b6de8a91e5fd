#include <gmock/gmock.h>

#include "files.h"

namespace assets {
namespace {

using namespace test;
using testing::HasSubstr;

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

struct Loaded {
  Model model;
  LoadReport report;
};

Loaded read_text(const std::string& text, const LoadOptions& options = {}) {
  const Folder folder;
  Loaded loaded;
  loaded.model = load(folder.write("a.obj", text), options, &loaded.report);
  EXPECT_EQ(broken_promise(loaded.model), "");
  return loaded;
}

std::string error_in(const std::string& text, const LoadOptions& options = {}) {
  const Folder folder;
  return error_of(folder.write("a.obj", text), options);
}

TEST(Obj, YIsUpUnlessToldOtherwise) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";
  const Model y = read_text(text).model;
  EXPECT_EQ(y.positions[2], V3(0.0f, 0.0f, 2.0f));
  EXPECT_LT(y.normals[0].y, -0.99f);  // the side that looks to +z in the file looks to the south
  const Model z = read_text(text, {.up = Up::z}).model;
  EXPECT_EQ(z.positions[2], V3(0.0f, 2.0f, 0.0f));
}

TEST(Obj, IndicesCountFromTheEndToo) {
  const Model model = read_text(corners + "f -4 -3 -2 -1\n").model;
  EXPECT_EQ(model.triangles.size(), 2u);
  EXPECT_NEAR(surface(model), 1, 1e-6);
}

TEST(Obj, ConcavePolygonsKeepTheirArea) {
  // An arrow head, clockwise and anticlockwise, in three planes; a fan from its first corner would cover too much.
  for (const bool backwards : {false, true}) {
    for (int plane = 0; plane < 3; ++plane) {
      const double points[5][2] = {{0, 0}, {4, 3}, {0, 6}, {1, 3}, {0.5, 1.5}};
      std::string text;
      double shoelace = 0;
      for (int i = 0; i < 5; ++i) {
        const double* p = points[i];
        const double* q = points[(i + 1) % 5];
        shoelace += 0.5 * (p[0] * q[1] - q[0] * p[1]);
        const std::string a = std::to_string(p[0]), b = std::to_string(p[1]);
        text += "v " + (plane == 0 ? "2 " + a + " " + b : plane == 1 ? a + " 2 " + b : a + " " + b + " 2") + "\n";
      }
      for (const char* face : {"f 1 2 3 4 5\n", "f 2 3 4 5 1\n", "f 4 5 1 2 3\n"}) {
        std::string f = face;
        if (backwards) f = std::string("f ") + f[10] + " " + f[8] + " " + f[6] + " " + f[4] + " " + f[2] + "\n";
        const Model model = read_text(text + f).model;
        EXPECT_EQ(model.triangles.size(), 3u);
        EXPECT_NEAR(surface(model), std::abs(shoelace), 1e-5) << plane << f;
      }
    }
  }
}

TEST(Obj, RandomStarsKeepTheirArea) {
  std::uint32_t state = 1;
  const auto random = [&] {
    state = state * 1664525u + 1013904223u;
    return static_cast<double>(state >> 8) / (1 << 24);
  };
  for (int round = 0; round < 100; ++round) {
    const int n = 4 + static_cast<int>(random() * 60);
    std::string text, face = "f";
    double shoelace = 0;
    std::vector<std::pair<double, double>> points;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979 * i / n, radius = 0.2 + random();
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
      text += "v " + std::to_string(points.back().first) + " " + std::to_string(points.back().second) + " 0\n";
      face += " " + std::to_string(i + 1);
    }
    for (int i = 0; i < n; ++i) {
      const auto [x, y] = points[static_cast<std::size_t>(i)];
      const auto [u, v] = points[static_cast<std::size_t>((i + 1) % n)];
      shoelace += 0.5 * (x * v - u * y);
    }
    EXPECT_NEAR(surface(read_text(text + face + "\n").model), shoelace, 1e-4) << "round " << round;
  }
}

TEST(Obj, NormalsAreMadeSmoothOrFlat) {
  // A pyramid: smooth, its apex looks up.
  const std::string base = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 0 1\n";
  const auto expect_apex_up = [](const Model& model, int copies) {
    for (std::size_t i = 0; i < model.positions.size(); ++i) {
      if (model.positions[i].z < 1) continue;
      EXPECT_NEAR(model.normals[i].z, 1, 1e-6);
      --copies;
    }
    EXPECT_EQ(copies, 0);
  };
  const LoadOptions as_it_is{.up = Up::z};
  const Model smooth = read_text(base + "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n", as_it_is).model;
  EXPECT_EQ(smooth.positions.size(), 5u);
  expect_apex_up(smooth, 1);
  const Model flat = read_text(base + "s off\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n", as_it_is).model;
  EXPECT_EQ(flat.positions.size(), 12u);
  for (const V3& n : flat.normals) EXPECT_NEAR(n.z, std::sqrt(0.5), 1e-6);
  // A seam in the texture does not break what is smooth.
  const Model seam =
      read_text(base + "vt 0 0\nvt 1 1\nf 1/1 2/1 5/1\nf 2/1 3/1 5/1\nf 3/2 4/2 5/2\nf 4/2 1/2 5/2\n", as_it_is).model;
  EXPECT_EQ(seam.positions.size(), 8u);
  expect_apex_up(seam, 2);
}

TEST(Obj, LeafCardsWithTheCrownsNormalsAreTurnedToThem) {
  // The card runs clockwise seen from +z, where its normals look.
  const Model model = read_text(corners + "vn 0 0.6 0.8\nf 4//1 3//1 2//1 1//1\n", {.up = Up::z}).model;
  for (const auto& [a, b, c] : model.triangles) {
    EXPECT_GT((model.positions[b] - model.positions[a]).cross(model.positions[c] - model.positions[a]).z, 0);
  }
  EXPECT_NEAR(model.normals[0].y, 0.6, 1e-6);
}

TEST(Obj, TrianglesWithoutAreaAreDropped) {
  const Model model = read_text(corners + "v 2 0 0\nf 1 2 3\nf 1 2 5\nf 1 1 2\nf 1 2 2\n").model;
  EXPECT_EQ(model.triangles.size(), 1u);
  EXPECT_EQ(model.positions.size(), 3u);
}

TEST(Obj, MaterialsComeFromTheLibrary) {
  const Folder folder;
  folder.write("my colours.mtl",
               "newmtl bark\nKd 0.3 0.2 0.1\nnewmtl leaf\nKd 0.1 0.4 0.1\nnewmtl thin\nKd 0.4 0.4 0.4\nd 0.25\n");
  LoadReport report;
  const Model m =
      load(folder.write("a.obj",
                        "mtllib my colours.mtl\n" + corners +
                            "usemtl leaf\nf 1 2 3\nusemtl bark\nf 1 3 4\nusemtl thin\nf 1 2 4\nusemtl none\nf 2 3 4\n"),
           {}, &report);
  ASSERT_EQ(m.materials.size(), 4u);
  EXPECT_EQ(m.materials[0].name, "leaf");
  EXPECT_GT(m.materials[0].transmittance.y, 0.2f);
  EXPECT_LT(m.materials[0].transmittance.y, 0.4f);
  EXPECT_EQ(m.materials[1].reflectance, Rgb(0.3f, 0.2f, 0.1f));
  EXPECT_EQ(m.materials[1].transmittance, Rgb(0.0f, 0.0f, 0.0f));
  EXPECT_NEAR(m.materials[2].transmittance.x, 0.3, 1e-6);  // three quarters pass
  EXPECT_NEAR(m.materials[2].reflectance.x, 0.1, 1e-6);
  EXPECT_THAT(report.warnings, testing::ElementsAre(HasSubstr("no material \"none\"")));
}

TEST(Obj, VertexColoursBecomeMaterials) {
  const Model m = read_text(
                      "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\nv 5 0 0 0 0 1\nv 6 0 0 0 0 1\nv 6 1 0 0 0 1\nf 1 2 "
                      "3\nf 4 5 6\n")
                      .model;
  ASSERT_EQ(m.materials.size(), 2u);
  EXPECT_EQ(m.materials[m.triangle_materials[0]].reflectance, Rgb(0.5f, 0.0f, 0.0f));
  EXPECT_EQ(m.materials[m.triangle_materials[1]].reflectance, Rgb(0.0f, 0.0f, 0.5f));
}

TEST(Obj, ErrorsNameTheLine) {
  EXPECT_THAT(error_in(corners + "f 1 2 9\n"),
              testing::AllOf(HasSubstr("a.obj:5: "), HasSubstr("vertex 9"), HasSubstr("4")));
  EXPECT_THAT(error_in(corners + "f 1 2 -5\n"), HasSubstr("vertex -5"));
  EXPECT_THAT(error_in(corners + "f 1/1 2/1 3/1\n"), HasSubstr("texture coordinate 1"));
  EXPECT_THAT(error_in(corners + "f 1//1 2//1 3//1\n"), HasSubstr("normal 1"));
  EXPECT_THAT(error_in(corners + "f 1 2 x\n"), testing::AllOf(HasSubstr(":5: "), HasSubstr("\"x\"")));
  EXPECT_THAT(error_in(corners + "f 0 1 2\n"), HasSubstr("counted from 1"));
  EXPECT_THAT(error_in("# \\\nv 0 0 0\nv 0 nan 0\n"),
              testing::AllOf(HasSubstr(":3: "), HasSubstr("\"nan\" is no number")));
  EXPECT_THAT(error_in("v 1 inf 0\n"), HasSubstr("no number"));
  EXPECT_THAT(error_in("v 1 2\n"), HasSubstr("needs 3 numbers"));
  EXPECT_THAT(error_in("\n\nv 1e300 0 0\n"), testing::AllOf(HasSubstr(":3: "), HasSubstr("too large")));
  EXPECT_THAT(error_in(corners), HasSubstr("no faces"));
  EXPECT_THAT(error_in(corners + "f 1 2 3 4\n", {.most_triangles = 1}), HasSubstr("more than 1 triangles"));
  EXPECT_THAT(error_in(corners + "f 1 2 3 4\n", {.most_file_bytes = 10}), HasSubstr("10"));
  std::string many = "f";
  for (int i = 0; i < 70'000; ++i) many += " 1";
  EXPECT_THAT(error_in(corners + many + "\n"), HasSubstr("corners"));
}

TEST(Obj, WhatTrailsANumberIsWarnedOf) {
  const Loaded loaded = read_text("v 0 0 0\nv 1 0 0\nv 0 3.1+e2 0\nf 1 2 3\n");
  EXPECT_THAT(loaded.report.warnings, testing::ElementsAre(testing::AllOf(HasSubstr("line 3"), HasSubstr("3.1+e2"))));
}

TEST(Obj, LinesMayGoOnAndEndInAnyWay) {
  EXPECT_EQ(read_text("v 0 0 0\r\nv 1 \\\r\n 0 0\rv 1 1 0\nf 1 \\\n2 \\\n3").model.triangles.size(), 1u);
}

TEST(Obj, ManyIntricatePolygonsEnd) {
  // A comb of 20,000 corners asks ear clipping for billions of tests.
  std::string text, face = "f";
  for (int i = 0; i < 20'000; ++i) {
    text += "v " + std::to_string(i / 2) + " " + (i % 4 < 2 ? "0" : "1000") + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  const Folder folder;
  LoadReport report;
  const Model model = load(folder.write("comb.obj", text + face + "\n" + face + "\n" + face + "\n"), {}, &report);
  EXPECT_EQ(broken_promise(model), "");
}

}  // namespace
}  // namespace assets
