#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "silvasim/base/error.h"
#include "tests/unit/ghosttile/export/stand.h"

namespace ghosttile::exports {
namespace {

using silvasim::base::ConfigError;
using silvasim::base::Error;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

template <typename Act>
std::string message_of(const Act& act) {
  try {
    act();
  } catch (const ConfigError& error) {
    return to_string(error.diagnostics().at(0));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// One candidate in each of many tiles.
fill::DetailsFile many(std::size_t tiles, std::uint16_t candidate) {
  fill::DetailsFile file = stand(1);
  file.details = {};
  for (std::size_t t = 0; t < tiles; ++t) {
    file.details.tiles.push_back({static_cast<int>(t), 0, 0});
    file.details.first.push_back(static_cast<std::uint32_t>(t));
  }
  file.details.first.push_back(static_cast<std::uint32_t>(tiles));
  file.details.chosen.assign(tiles, candidate);
  file.details.instances.assign(tiles, 1);
  return file;
}

TEST(Formats, AreToldByNameOrExtension) {
  EXPECT_EQ(format_for("", "a/b.GLB").name, "gltf");
  EXPECT_EQ(format_for("", "b.gltf").name, "gltf");
  EXPECT_EQ(format_for("obj", "b.csv").name, "obj");
  for (const Format& format : formats()) {
    EXPECT_EQ(&format_for(format.name, ""), &format);
    for (const std::string& extension : format.extensions) EXPECT_EQ(&format_for("", "a" + extension), &format);
  }
  EXPECT_EQ(message_of([] { format_for("", "b.blend"); }),
            "--to: error: the name \"b.blend\" does not tell the format; give one of csv, usda, gltf, obj, ply");
  EXPECT_EQ(message_of([] { format_for("usd", "b.usd"); }),
            "--to: error: there is no format \"usd\"; did you mean \"usda\"?");
}

TEST(Formats, RefuseTooMany) {
  const Folder folder;
  const auto straws = many(most_gltf_instances + 1, 4);
  EXPECT_THAT(message_of([&] { write_gltf(straws, folder / "a.glb", {}); }),
              AllOf(HasSubstr("200001 instances"), HasSubstr("at most 200000"), HasSubstr("usda and csv")));
  const std::size_t each = straws.tile->objects[2].model.triangles.size();
  const auto toadstools = many(most_triangles / each + 1, 2);
  for (const char* name : {"obj", "ply"}) {
    EXPECT_THAT(message_of([&] { format_for(name, "").write(toadstools, folder / "a", {}); }),
                AllOf(HasSubstr("too many for " + std::string(name)), HasSubstr("at most 50000000"),
                      HasSubstr("usda and csv")));
  }
  EXPECT_THAT(folder.names(), IsEmpty());
  // One fewer is none too many.
  write_gltf(many(most_gltf_instances, 4), folder / "a.glb", {});
}

TEST(Formats, WriteFilesWithoutInstances) {
  for (const Format& format : formats()) {
    for (const std::string& extension : format.extensions) {
      const Folder folder;
      format.write(empty_stand(), folder / ("none" + extension), {});
      EXPECT_THAT(folder.names(), testing::ElementsAre("none" + extension));
      const std::string text = text_of(folder / ("none" + extension));
      EXPECT_EQ(text.find("nan"), std::string::npos);
      EXPECT_EQ(text.find("mtllib"), std::string::npos);
    }
  }
}

TEST(Formats, LeaveNothingWhenStopped) {
  for (const Format& format : formats()) {
    const Folder folder;
    int calls = 0;
    WriteOptions options;
    options.progress = [&](std::string_view, double) { return ++calls < 2; };
    EXPECT_THROW(format.write(stand(1), folder / "a", options), silvasim::base::Cancelled) << format.name;
    EXPECT_THAT(folder.names(), IsEmpty()) << format.name;
  }
}

TEST(Formats, ReportHowFarTheyAre) {
  const auto straws = many(30'000, 4);
  for (const Format& format : formats()) {
    const Folder folder;
    std::vector<double> done;
    WriteOptions options;
    options.progress = [&](std::string_view, double share) { return done.push_back(share), true; };
    format.write(straws, folder / "a", options);
    ASSERT_GE(done.size(), 4u) << format.name;
    EXPECT_EQ(done.front(), 0);
    EXPECT_TRUE(std::is_sorted(done.begin(), done.end())) << format.name;
    EXPECT_GT(done.back(), 0.7) << format.name;
    EXPECT_LE(done.back(), 1) << format.name;
  }
}

TEST(Formats, NeverWriteOverInputs) {
  for (const Format& format : formats()) {
    const Folder folder;
    const auto path = folder / "a.details";
    std::ofstream(path) << "mine";
    const std::vector<std::filesystem::path> inputs{path};
    WriteOptions options;
    options.inputs = inputs;
    EXPECT_THAT(message_of([&] { format.write(stand(1), path, options); }), HasSubstr("it is also an input"));
    EXPECT_EQ(text_of(path), "mine");
    EXPECT_THAT(folder.names(), testing::ElementsAre("a.details"));
  }
}

// A texture beside the file could hit an input too.
TEST(Formats, NeverWriteOverInputsWithWhatStandsBeside) {
  const Folder first;
  write_usda(stand(1), first / "a.usda", {});
  for (const std::string& name : first.names()) {
    if (name == "a.usda") continue;
    for (const std::string format : {"usda", "obj"}) {
      const Folder folder;
      std::ofstream(folder / name) << "mine";
      const std::vector<std::filesystem::path> inputs{folder / name};
      WriteOptions options;
      options.inputs = inputs;
      EXPECT_THAT(message_of([&] { format_for(format, "").write(stand(1), folder / ("a." + format), options); }),
                  HasSubstr("it is also an input"));
      EXPECT_EQ(text_of(folder / name), "mine");
      EXPECT_THAT(folder.names(), testing::ElementsAre(name));
    }
  }
  EXPECT_EQ(first.names().size(), 3u);
}

TEST(Obj, MayNotBearItsLibrarysName) {
  const Folder folder;
  EXPECT_THAT(message_of([&] { write_obj(stand(1), folder / "a.mtl", {}); }), HasSubstr("give it another extension"));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(Formats, RefuseFramesThatAreNoNumbers) {
  fill::DetailsFile file = stand(1);
  auto tile = std::make_shared<tile::GhostTile>(*file.tile);
  const std::uint16_t bad = file.details.chosen[0];
  tile->candidates[bad].rotation.y = std::numeric_limits<float>::quiet_NaN();
  file.tile = tile;
  for (const Format& format : formats()) {
    const Folder folder;
    EXPECT_THAT(message_of([&] { format.write(file, folder / "a", {}); }),
                AllOf(HasSubstr("candidate " + std::to_string(bad)), HasSubstr("no number")));
    EXPECT_THAT(folder.names(), IsEmpty());
  }
}

TEST(Formats, NameAFolderThatIsMissing) {
  const Folder folder;
  for (const Format& format : formats())
    EXPECT_THAT(message_of([&] { format.write(stand(1), folder / "none/a", {}); }), HasSubstr("there is no folder"));
}

}  // namespace
}  // namespace ghosttile::exports
