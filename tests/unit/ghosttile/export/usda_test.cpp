#include <cstdlib>
#include <map>
#include <regex>
#include <set>

#include "assets/texture.h"
#include "tests/unit/ghosttile/export/stand.h"

namespace ghosttile::exports {
namespace {

// The numbers of "<name> = [...]", the first after `from`; tuples flattened. `most_in_tuple` sees how long they are.
std::vector<double> column(const std::string& text, const std::string& name, std::size_t from = 0) {
  const std::size_t at = text.find(name + " = [", from);
  if (at == std::string::npos) return {};
  const std::size_t begin = at + name.size() + 4, end = text.find(']', begin);
  std::vector<double> numbers;
  const char* next = text.c_str() + begin;
  while (next < text.c_str() + end) {
    char* after = nullptr;
    const double number = std::strtod(next, &after);
    if (after == next) {
      ++next;
    } else {
      numbers.push_back(number);
      next = after;
    }
  }
  return numbers;
}

struct Stage {
  explicit Stage(const fill::DetailsFile& file, const WriteOptions& options = {}) {
    write_usda(file, folder / "my stand.usda", options);
    text = text_of(folder / "my stand.usda");
  }
  Folder folder;
  std::string text;
};

std::vector<std::string> prototypes_of(const std::string& text) {
  const std::size_t begin = text.find("rel prototypes = [");
  std::string list = text.substr(begin, text.find(']', begin) - begin);
  std::vector<std::string> names;
  const std::regex path("</details/instances/prototypes/([A-Za-z0-9_]+)>");
  for (std::sregex_iterator it(list.begin(), list.end(), path), end; it != end; ++it) names.push_back((*it)[1]);
  return names;
}

TEST(Usda, PlacesPrototypesByFrames) {
  const fill::DetailsFile file = stand(41);
  const Stage stage(file);
  const std::vector<Place> places = places_of(file);
  const V3d origin = numbers_after(stage.text, "double3 xformOp:translate");
  const auto which = column(stage.text, "int[] protoIndices"), positions = column(stage.text, "point3f[] positions"),
             turns = column(stage.text, "quath[] orientations"), scales = column(stage.text, "float3[] scales");
  ASSERT_EQ(which.size(), places.size());
  ASSERT_EQ(positions.size(), 3 * places.size());
  ASSERT_EQ(turns.size(), 4 * places.size());
  ASSERT_EQ(scales.size(), 3 * places.size());
  const std::vector<std::string> prototypes = prototypes_of(stage.text);
  ASSERT_EQ(prototypes.size(), 4u);
  const std::map<std::size_t, std::string> names{
      {0, "oak_leaf"}, {1, "tents___two_"}, {2, "toadstool"}, {3, "toadstool_2"}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const V3d at(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    EXPECT_LT((at + origin - places[i].at).length(), 1e-5);
    const tile::Rotation& r = places[i].frame->rotation;
    EXPECT_NEAR(turns[4 * i], double{r.w}, 1e-6);
    EXPECT_NEAR(turns[4 * i + 1], double{r.x}, 1e-6);
    EXPECT_NEAR(turns[4 * i + 2], double{r.y}, 1e-6);
    EXPECT_NEAR(turns[4 * i + 3], double{r.z}, 1e-6);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_EQ(static_cast<float>(scales[3 * i + axis]), places[i].frame->scale);
    EXPECT_EQ(prototypes.at(static_cast<std::size_t>(which[i])), names.at(places[i].frame->object));
  }
  // All within the extent.
  const std::vector<double> extent = column(stage.text, "float3[] extent");
  ASSERT_EQ(extent.size(), 6u);
  double slack_m = 1e9;
  for (const Triangle& triangle : triangles_of(file, false)) {
    for (const V3d& corner : triangle.corners) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        slack_m =
            std::min({slack_m, corner[axis] - origin[axis] - extent[a], extent[a + 3] - corner[axis] + origin[axis]});
      }
    }
  }
  EXPECT_GE(slack_m, -1e-5);
  EXPECT_LT(slack_m, 0.3);
}

TEST(Usda, IdsTellTileAndCandidateAndStayThroughEdits) {
  fill::DetailsFile file = stand(42);
  const auto ids_of = [](const fill::DetailsFile& of) {
    const Stage stage(of);
    // Tile and candidate back from the id, by what the file says of it.
    std::smatch m;
    const std::regex meaning(
        R"(\(z \* (\d+) \+ y\) \* (\d+) \+ x\) \* (\d+) \+ candidate.*counted from \((-?\d+), (-?\d+), (-?\d+)\))");
    EXPECT_TRUE(std::regex_search(stage.text, m, meaning));
    const auto n = [&](int i) { return std::atoll(m[static_cast<std::size_t>(i)].str().c_str()); };
    const std::vector<Place> places = places_of(of);
    const std::vector<double> ids = column(stage.text, "int64[] ids");
    EXPECT_EQ(ids.size(), places.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      long long id = static_cast<long long>(ids[i]);
      EXPECT_EQ(id % n(3), places[i].candidate);
      id /= n(3);
      EXPECT_EQ(id % n(2) + n(4), places[i].tile.x);
      id /= n(2);
      EXPECT_EQ(id % n(1) + n(5), places[i].tile.y);
      EXPECT_EQ(id / n(1) + n(6), places[i].tile.z);
    }
    return std::set<double>(ids.begin(), ids.end());
  };
  const std::set<double> before = ids_of(file);
  ASSERT_EQ(before.size(), file.details.count());
  // A box without bounds is no hindrance.
  fill::DetailsFile unbounded = file;
  const int far = 1 << 28;
  unbounded.filled = {-far, -far, -far, far, far, far};
  EXPECT_EQ(ids_of(unbounded).size(), before.size());
  // Take the first tile's instances away.
  const std::size_t gone = file.details.instances[0];
  file.details.instances[0] = 0;
  const std::set<double> after = ids_of(file);
  EXPECT_EQ(after.size(), before.size() - gone);
  EXPECT_TRUE(std::includes(before.begin(), before.end(), after.begin(), after.end()));
}

TEST(Usda, HoldsModelsWithTheirMaterials) {
  const fill::DetailsFile file = stand(43);
  const Stage stage(file, with_crs("LOCAL_CS[\"here\", \"a\\b\"]"));
  EXPECT_NE(stage.text.find(R"(LOCAL_CS[\"here\", \"a\\b\"])"), std::string::npos);
  EXPECT_EQ(stage.text.substr(0, 10), "#usda 1.0\n");
  const std::vector<std::string> prototypes = prototypes_of(stage.text);
  for (std::size_t o = 0; o < 4; ++o) {
    SCOPED_TRACE(prototypes[o]);
    const assets::Model& model = file.tile->objects[o].model;
    const std::size_t at = stage.text.find("def Xform \"" + prototypes[o] + "\"");
    ASSERT_NE(at, std::string::npos);
    const auto corners = column(stage.text, "int[] faceVertexIndices", at),
               points = column(stage.text, "point3f[] points", at);
    ASSERT_EQ(points.size(), 3 * model.positions.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_EQ(static_cast<float>(points[i]), model.positions[i / 3][static_cast<int>(i % 3)]);
    ASSERT_EQ(corners.size(), 3 * model.triangles.size());
    ASSERT_EQ(column(stage.text, "int[] faceVertexCounts", at), std::vector<double>(model.triangles.size(), 3));
    // The same triangles, and those of each material under its subset.
    std::multiset<std::array<double, 3>> due, found;
    for (const auto& t : model.triangles) due.insert({double(t[0]), double(t[1]), double(t[2])});
    for (std::size_t i = 0; i < corners.size(); i += 3) found.insert({corners[i], corners[i + 1], corners[i + 2]});
    EXPECT_EQ(found, due);
  }
  const std::size_t tents = stage.text.find("def Xform \"tents___two_\"");
  const std::size_t subset = stage.text.find("def GeomSubset \"canvas\"", tents);
  const auto corners = column(stage.text, "int[] faceVertexIndices", tents),
             of = column(stage.text, "int[] indices", subset);
  ASSERT_EQ(of.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& due = file.tile->objects[1].model.triangles[2 * k + 1];  // every other is of canvas
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(corners[3 * static_cast<std::size_t>(of[k]) + c], due[c]);
  }
  // Every path that is named is there.
  std::set<std::string> binds;
  const std::regex bound("rel material:binding = <([^>]+)>");
  for (std::sregex_iterator it(stage.text.begin(), stage.text.end(), bound), end; it != end; ++it)
    binds.insert((*it)[1]);
  EXPECT_EQ(binds.size(), 6u);
  for (const std::string& path : binds)
    EXPECT_NE(stage.text.find(path + "/surface.outputs:surface>"), std::string::npos);
  EXPECT_EQ(std::count(stage.text.begin(), stage.text.end(), '{'),
            std::count(stage.text.begin(), stage.text.end(), '}'));
  // Textures read back the same.
  const std::regex asset("@\\./([^@]+)@");
  std::size_t read = 0;
  for (std::sregex_iterator it(stage.text.begin(), stage.text.end(), asset), end; it != end; ++it) {
    assets::Picture picture;
    picture.name = (*it)[1];
    picture.file = stage.folder / picture.name;
    const assets::Texture texture = assets::load_texture(picture, nullptr, {4096, 0.5f});
    bool known = false;
    for (const objects::Detail& object : file.tile->objects)
      for (const assets::Texture& t : object.model.textures) known = known || same_picture(t, texture);
    EXPECT_TRUE(known) << picture.name;
    ++read;
  }
  EXPECT_EQ(read, 2u);
}

}  // namespace
}  // namespace ghosttile::exports
