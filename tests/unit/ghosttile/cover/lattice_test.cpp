#include "ghosttile/cover/lattice.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "land.h"

namespace ghosttile::cover::test {

namespace {

// Counts how often it is asked.
class Waves final : public Filler {
 public:
  explicit Waves(std::atomic<int>* fills = nullptr) : fills_(fills) {}
  static float at(double x, double y) {
    // Any pure function: the hash of the place's whole numbers.
    const auto h = static_cast<std::uint64_t>(std::llround(x * 8)) * 0x9E3779B97F4A7C15u ^
                   static_cast<std::uint64_t>(std::llround(y * 8)) * 0xC2B2AE3D27D4EB4Fu;
    return static_cast<float>((h * 0xFF51AFD7ED558CCDu) >> 40) * 0x1p-24f;
  }
  void fill(const NodeBlock& block, float* values) const override {
    if (fills_) ++*fills_;
    for (int j = 0; j < block_nodes; ++j) {
      for (int i = 0; i < block_nodes; ++i) values[j * block_nodes + i] = at(block.x(i), block.y(j));
    }
  }
  Range range(const Box&) const override { return {0, 1}; }

 private:
  std::atomic<int>* fills_;
};

float one(const Source& source, const V3d& origin, float x, float y) {
  float value = -1;
  source.sample(origin, &x, &y, 1, &value);
  return value;
}

TEST(Lattice, IsTheFillersAtNodesAndBilinearBetween) {
  const auto source = on_lattice(std::make_unique<Waves>(), 0.25, 1 << 20);
  Random random(1);
  for (int k = 0; k < 3000; ++k) {
    // Places around 0 and far from it, on both sides of blocks' rims.
    const double far = k % 2 ? 570000 : 0;
    const double column = std::floor(between(random, -200, 200)), row = std::floor(between(random, -200, 200));
    const double u = k % 3 ? between(random, 0, 1) : 0, v = k % 5 ? between(random, 0, 1) : 0;
    const double x = far + (column + u) * 0.25, y = -far + (row + v) * 0.25;
    const auto at = [&](int i, int j) {
      return static_cast<double>(Waves::at(far + (column + i) * 0.25, -far + (row + j) * 0.25));
    };
    const double expected =
        (1 - u) * (1 - v) * at(0, 0) + u * (1 - v) * at(1, 0) + (1 - u) * v * at(0, 1) + u * v * at(1, 1);
    ASSERT_NEAR(one(*source, {x, y, 0}, 0, 0), expected, 1e-6) << x << ", " << y;
  }
}

TEST(Lattice, DoesNotDependOnWhatElseIsAsked) {
  Random random(2);
  constexpr std::size_t count = 700;
  std::vector<float> x(count), y(count), together(count), narrow(count);
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = static_cast<float>(between(random, -300, 300));
    y[i] = static_cast<float>(i < 350 ? between(random, -300, 300) : between(random, 0, 3));
    if (i >= 350) x[i] *= 0.01f;
  }
  const V3d origin{1234.5, -777.25, 0};
  // So few bytes that blocks must be thrown away all the time.
  on_lattice(std::make_unique<Waves>(), 0.25, 64 << 20)->sample(origin, x.data(), y.data(), count, together.data());
  const auto small = on_lattice(std::make_unique<Waves>(), 0.25, 1);
  for (std::size_t i = count; i-- > 0;) ASSERT_EQ(one(*small, origin, x[i], y[i]), together[i]);
}

TEST(Lattice, KeepsBlocksAndLetsThemGo) {
  std::atomic<int> fills{0};
  const auto source = on_lattice(std::make_unique<Waves>(&fills), 1, 64 << 20);
  for (int k = 0; k < 1000; ++k) one(*source, {0, 0, 0}, static_cast<float>(k % 64) + 0.5f, 3);
  EXPECT_EQ(fills, 1);
  const auto small = on_lattice(std::make_unique<Waves>(&fills), 1, 1);
  fills = 0;
  for (int round = 0; round < 2; ++round) {
    for (int k = 0; k < 1000; ++k) one(*small, {0, 0, 0}, static_cast<float>(k) * 64, 3);
  }
  EXPECT_GT(fills, 1500);  // no room for a thousand
}

TEST(Lattice, IsTheSameFromManyThreads) {
  Random random(5);
  const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
  const Chosen chosen = choose_all(plants);
  const Box& extent = plants->ecosystem().extent;
  constexpr std::size_t blocks = 200, size = density::block_size;
  std::vector<float> x(blocks * size), y(blocks * size), alone(blocks * size);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = static_cast<float>(i / size % 20 * 7) + static_cast<float>(between(random, 0, 5));
    y[i] = static_cast<float>(i / size / 20 * 10) + static_cast<float>(between(random, 0, 5));
  }
  const V3d origin{extent.west, extent.south, 0};
  const auto first = on_lattice(crown_cover(chosen, {1, 0.25f, {}}), 0.25, 32 << 20);
  first->sample(origin, x.data(), y.data(), x.size(), alone.data());
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{32} << 20}) {
    const auto shared = on_lattice(crown_cover(chosen, {1, 0.25f, {}}), 0.25, bytes);
    std::vector<float> values(x.size());
    std::atomic<std::size_t> next{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 8; ++t) {
      threads.emplace_back([&] {
        for (std::size_t b; (b = next++) < blocks;) {
          const std::size_t at = (b * 37 % blocks) * size;
          shared->sample(origin, x.data() + at, y.data() + at, size, values.data() + at);
        }
      });
    }
    for (auto& thread : threads) thread.join();
    EXPECT_EQ(values, alone);
  }
}

TEST(Lattice, IsContinuous) {
  Random random(6);
  const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
  const auto source = on_lattice(crown_cover(choose_all(plants), {0.5f, 0.25f, {}}), 0.25, 32 << 20);
  const Box& extent = plants->ecosystem().extent;
  // Along a line across the land, by the hundredth of a millimetre at each node, where cells and blocks meet.
  const double y = std::floor((extent.south + extent.north) / 2) + 0.1;
  for (double x = std::floor(extent.west); x < extent.east; x += 0.25) {
    const float before = one(*source, {x - 1e-5, y, 0}, 0, 0), after = one(*source, {x + 1e-5, y, 0}, 0, 0);
    ASSERT_NEAR(before, after, 4e-4) << x;
  }
}

TEST(Lattice, HasSoundRanges) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
    const Chosen chosen = choose(plants, [&](const PlantSpecies&) { return random() % 2 == 0; });
    const std::shared_ptr<const Source> sources[] = {
        on_lattice(crown_cover(chosen, {0.5f, 0.25f, {}}), 0.25, 32 << 20),
        on_lattice(stem_distance(chosen, 4), 0.25, 32 << 20),
        on_lattice(stand_density(chosen, 7, DensityMeasure::stems), 0.5, 32 << 20),
        on_lattice(stand_density(chosen, 7, DensityMeasure::basal_area), 0.5, 32 << 20),
        on_lattice(light(chosen, {}), 0.5, 32 << 20),
        on_lattice(patches(seed, 3), 0.125, 32 << 20),
        on_lattice(std::make_unique<Waves>(), 1, 32 << 20)};
    for (const auto& source : sources) {
      int tight = 0;
      for (int round = 0; round < 60; ++round) {
        const auto corner = random_place(random, grown(plants->ecosystem().extent, 30));
        const double size = std::pow(10, between(random, -2, 2.5));
        const SourceRange range = source->range({corner.x, corner.y, corner.x + size, corner.y + size});
        std::vector<float> x(1000), y(1000), value(1000);
        for (std::size_t i = 0; i < x.size(); ++i) {
          x[i] = static_cast<float>(between(random, 0, size));
          y[i] = static_cast<float>(between(random, 0, size));
        }
        source->sample({corner.x, corner.y, 0}, x.data(), y.data(), x.size(), value.data());
        float least = value[0], most = value[0];
        for (const float v : value) {
          least = std::min(least, v);
          most = std::max(most, v);
        }
        ASSERT_GE(least, range.known.least) << size;
        ASSERT_LE(most, range.known.most) << size;
        if (range.known.least == range.known.most) {
          ASSERT_EQ(least, most);
        }
        tight += range.known.most - range.known.least < 2 * (most - least) + 1e-5f ? 1 : 0;
      }
      EXPECT_GT(tight, 10);  // not just everything that there might be
    }
  }
}

}  // namespace

}  // namespace ghosttile::cover::test
