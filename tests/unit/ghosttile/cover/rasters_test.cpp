#include "ghosttile/cover/rasters.h"

#include "rule_land.h"

namespace ghosttile::cover::test {

namespace {

float one(const Source& source, double x, double y) {
  const float zero = 0;
  float value = -1;
  source.sample({x, y, 0}, &zero, &zero, 1, &value);
  return value;
}

TEST(Rasters, ReadTheGroundAsTheEcosystemDoes) {
  Random random(1);
  const auto ecosystem = random_ecosystem(random);
  const auto source = ground_source(ecosystem->terrain, GroundMeasure::elevation);
  for (int k = 0; k < 2000; ++k) {
    const auto at = random_place(random, ecosystem->extent);
    ASSERT_NEAR(one(*source, at.x, at.y), silvasim::ecosystem::height_at(ecosystem->terrain, at), 1e-3);
  }
  EXPECT_TRUE(std::isnan(one(*source, ecosystem->extent.east + 1000, ecosystem->extent.north)));
  EXPECT_EQ(one(*ground_source({}, GroundMeasure::slope), 3, 4), 0);
}

// A plane that rises to the north-east: what the measures are is known.
TEST(Rasters, KnowAPlanesSlopeAndAspect) {
  silvasim::ecosystem::Terrain terrain;
  terrain.columns = 20;
  terrain.rows = 20;
  terrain.north = 200;
  terrain.cell_width_m = terrain.cell_height_m = 10;
  const double east = 0.3, north = 0.4;
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 20; ++column) {
      terrain.heights_m.push_back(static_cast<float>(east * (column * 10 + 5) + north * (200 - row * 10 - 5)));
    }
  }
  const double slope = std::atan(0.5);
  EXPECT_NEAR(one(*ground_source(terrain, GroundMeasure::slope), 77, 88), slope * 180 / M_PI, 1e-3);
  EXPECT_NEAR(one(*ground_source(terrain, GroundMeasure::northness), 77, 88), -0.8 * std::sin(slope), 1e-4);
  EXPECT_NEAR(one(*ground_source(terrain, GroundMeasure::eastness), 77, 88), -0.6 * std::sin(slope), 1e-4);
}

TEST(Rasters, HaveSoundRanges) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const TestLand land = random_land(random);
    std::vector<std::shared_ptr<const Source>> sources;
    for (std::size_t f = 0; f < land.fields->fields.size(); ++f) sources.push_back(field_source(land.fields, f));
    for (const auto measure : {GroundMeasure::elevation, GroundMeasure::slope, GroundMeasure::northness}) {
      sources.push_back(ground_source(land.plants->ecosystem().terrain, measure));
    }
    for (std::size_t s = 0; s < sources.size(); ++s) {
      int missing = 0;
      for (int round = 0; round < 200; ++round) {
        const auto corner = random_place(random, grown(land.plants->ecosystem().extent, 20));
        const double size = std::pow(10, between(random, -2, 2.3));
        const SourceRange range = sources[s]->range({corner.x, corner.y, corner.x + size, corner.y + size});
        float least = 1e9f, most = -1e9f;
        for (int i = 0; i < 300; ++i) {
          const float value =
              one(*sources[s], corner.x + between(random, 0, size), corner.y + between(random, 0, size));
          if (std::isnan(value)) {
            ++missing;
            ASSERT_TRUE(range.missing);
            continue;
          }
          least = std::min(least, value);
          most = std::max(most, value);
          ASSERT_GE(value, range.known.least) << "source " << s << ", size " << size;
          ASSERT_LE(value, range.known.most) << "source " << s << ", size " << size;
        }
      }
      EXPECT_EQ(missing > 0, s != 3);  // "fill" leaves none
    }
  }
}

TEST(Rasters, AnswerByTheFieldsPolicy) {
  Random random(6);
  const TestLand land = random_land(random);
  const Box& extent = land.plants->ecosystem().extent;
  const double x = extent.west + 60, y = extent.north - 90;  // in the hole
  EXPECT_TRUE(std::isnan(one(*field_source(land.fields, 1), x, y)));
  EXPECT_EQ(field_source(land.fields, 1)->without_data(), 0);
  EXPECT_TRUE(std::isnan(one(*field_source(land.fields, 2), x, y)));
  EXPECT_EQ(field_source(land.fields, 2)->without_data(), 1);
  EXPECT_EQ(one(*field_source(land.fields, 3), x, y), 42);
}

}  // namespace

}  // namespace ghosttile::cover::test
