#include <cstdlib>
#include <sstream>

#include "tests/unit/ghosttile/export/stand.h"

namespace ghosttile::exports {
namespace {

TEST(Csv, HoldsEachInstanceInFull) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    const fill::DetailsFile file = stand(seed);
    const Folder folder;
    write_csv(file, folder / "rows.csv", {});
    std::istringstream in(text_of(folder / "rows.csv"));
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "object,x,y,z,qw,qx,qy,qz,scale,tile_x,tile_y,tile_z,candidate");
    const std::vector<Place> places = places_of(file);
    ASSERT_GT(places.size(), 30u);
    for (const Place& place : places) {
      ASSERT_TRUE(std::getline(in, line));
      std::string name = place.object->name;
      if (name == "tents, \"two\"") name = "\"tents, \"\"two\"\"\"";
      ASSERT_EQ(line.substr(0, name.size() + 1), name + ",");
      std::vector<double> numbers;
      std::istringstream rest(line.substr(name.size() + 1));
      for (std::string word; std::getline(rest, word, ',');) numbers.push_back(std::strtod(word.c_str(), nullptr));
      const tile::Candidate& frame = *place.frame;
      ASSERT_EQ(numbers.size(), 12u);
      // To the last bit.
      EXPECT_EQ(V3d(numbers[0], numbers[1], numbers[2]), place.at);
      EXPECT_EQ(static_cast<float>(numbers[3]), frame.rotation.w);
      EXPECT_EQ(static_cast<float>(numbers[4]), frame.rotation.x);
      EXPECT_EQ(static_cast<float>(numbers[5]), frame.rotation.y);
      EXPECT_EQ(static_cast<float>(numbers[6]), frame.rotation.z);
      EXPECT_EQ(static_cast<float>(numbers[7]), frame.scale);
      EXPECT_EQ(
          fill::TilePlace(static_cast<int>(numbers[8]), static_cast<int>(numbers[9]), static_cast<int>(numbers[10])),
          place.tile);
      EXPECT_EQ(numbers[11], place.candidate);
    }
    EXPECT_FALSE(std::getline(in, line));
  }
}

}  // namespace
}  // namespace ghosttile::exports
