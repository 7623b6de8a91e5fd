#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ghosttile/cover/fillers.h"
#include "silvasim/base/random.h"

namespace ghosttile::cover {

namespace {

constexpr int octaves = 3;

float smooth(float t) { return t * t * (3 - 2 * t); }

class PatchFiller final : public Filler {
 public:
  PatchFiller(std::uint64_t seed, double size_m) : seed_(seed), size_m_(size_m) {}

  void fill(const NodeBlock& block, float* values) const override {
    std::fill_n(values, static_cast<std::size_t>(block_nodes) * block_nodes, 0.0f);
    float weight = 4.0f / 7, all = 0;
    double a_metre = 1 / size_m_;
    for (std::uint32_t octave = 0; octave < octaves; ++octave, weight *= 0.5f, a_metre *= 2) {
      add(block, octave, a_metre, weight, values);
      all += weight;
    }
    for (int i = 0; i < block_nodes * block_nodes; ++i) values[i] = std::clamp(values[i] / all, 0.0f, 1.0f);
  }

  Range range(const Box&) const override { return {0, 1}; }

 private:
  // Along one axis: between which draws a node lies, counted from the block's first one.
  struct Axis {
    std::int64_t first = 0;
    std::array<int, block_nodes> before{};
    std::array<float, block_nodes> share{};
  };
  template <typename Place>
  static Axis axis(double a_metre, Place&& place) {
    Axis axis;
    axis.first = static_cast<std::int64_t>(std::floor(place(0) * a_metre));
    for (int i = 0; i < block_nodes; ++i) {
      const double at = place(i) * a_metre, whole = std::floor(at);
      axis.before[static_cast<std::size_t>(i)] = static_cast<int>(static_cast<std::int64_t>(whole) - axis.first);
      axis.share[static_cast<std::size_t>(i)] = smooth(static_cast<float>(at - whole));
    }
    return axis;
  }

  void add(const NodeBlock& block, std::uint32_t octave, double a_metre, float weight, float* values) const {
    const Axis across = axis(a_metre, [&](int i) { return block.x(i); });
    const Axis along = axis(a_metre, [&](int j) { return block.y(j); });
    const int columns = across.before.back() + 2, rows = along.before.back() + 2;
    std::vector<float> draws(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) {
        draws[static_cast<std::size_t>(r * columns + c)] = silvasim::base::uniform_at(
            seed_, silvasim::base::Purpose::cover, static_cast<std::uint32_t>(across.first + c),
            static_cast<std::uint32_t>(along.first + r), octave);
      }
    }
    for (std::size_t j = 0; j < block_nodes; ++j) {
      for (std::size_t i = 0; i < block_nodes; ++i) {
        const float* const four = draws.data() + along.before[j] * columns + across.before[i];
        const float south = four[0] + across.share[i] * (four[1] - four[0]);
        const float north = four[columns] + across.share[i] * (four[columns + 1] - four[columns]);
        values[j * block_nodes + i] += weight * (south + along.share[j] * (north - south));
      }
    }
  }

  std::uint64_t seed_;
  double size_m_;
};

}  // namespace

std::unique_ptr<const Filler> patches(std::uint64_t seed, double size_m) {
  return std::make_unique<PatchFiller>(seed, size_m);
}

}  // namespace ghosttile::cover
