#include "ghosttile/cover/trunks.h"

#include "land.h"

namespace ghosttile::cover::test {

namespace {

TEST(Trunks, AreAllStemsThatTouchTheBox) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
    const Chosen chosen = choose(plants, [&](const PlantSpecies&) { return random() % 3 > 0; });
    TrunkOptions options;
    options.gap_m = static_cast<float>(between(random, 0, 0.5));
    for (int round = 0; round < 20; ++round) {
      const auto corner = random_place(random, plants->ecosystem().extent);
      const double size = between(random, 0.1, 40), floor = between(random, 290, 340);
      const density::Box3 box{{corner.x, corner.y, floor}, {corner.x + size, corner.y + size, floor + 3}};
      const auto nodes = trunks(chosen, box, options);
      std::size_t expected = 0;
      for (const Stem& stem : all_stems(*plants)) {
        if (!chosen.selection.species[stem.species]) continue;
        const double radius = static_cast<double>(plants->stem_radius_m(stem));
        if (radius < 0.02) continue;
        const double dx = stem.x_m - std::clamp(stem.x_m, box.least.x, box.most.x),
                     dy = stem.y_m - std::clamp(stem.y_m, box.least.y, box.most.y);
        if (std::hypot(dx, dy) > radius + static_cast<double>(options.gap_m)) continue;
        const double ground = silvasim::ecosystem::height_at(plants->ecosystem().terrain, {stem.x_m, stem.y_m});
        if (ground - 0.5 > box.most.z || ground + 0.5 * static_cast<double>(plants->height_m(stem)) < box.least.z)
          continue;
        ++expected;
        bool found = false;
        for (const density::Node& node : nodes) {
          found = found || (node.points[0].x == stem.x_m && node.points[0].y == stem.y_m &&
                            std::fabs(node.points[0].z - ground + 0.5) < 1e-6 && node.points[1].z > ground &&
                            std::fabs(node.size.x - radius - static_cast<double>(options.gap_m)) < 1e-6);
        }
        EXPECT_TRUE(found);
      }
      EXPECT_EQ(nodes.size(), expected);
    }
  }
}

}  // namespace

}  // namespace ghosttile::cover::test
