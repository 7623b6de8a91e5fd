#include "silvavis/scene/details.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"

namespace silvavis::scene {

namespace {

namespace fill = ghosttile::fill;
using silvasim::base::parallel_for;

// A column of tiles while the tree is made.
struct Place {
  std::uint64_t key = 0;              // along the tree's own order
  std::uint32_t first = 0, last = 0;  // tiles of Details
};

// Digits of x and y in turn, four levels of two bits: the order of children of children.
std::uint64_t key_of(std::uint32_t x, std::uint32_t y) {
  std::uint64_t key = 0;
  for (int level = 0; level < 16; ++level) {
    const std::uint64_t child = (y >> (2 * level) & 3) * 4 + (x >> (2 * level) & 3);
    key |= child << (4 * level);
  }
  return key;
}

// Rounded outward.
float below(double x) { return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity()); }
float above(double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); }

class LayerMaker {
 public:
  LayerMaker(const DetailKind& kind, const fill::Details& details)
      : kind_(kind), details_(details), layer_(kind.empty), counts_(layer_.frames.size(), 0) {}

  DetailLayer run(silvasim::base::Point origin) {
    list_columns();
    if (places_.empty()) return std::move(layer_);
    layer_.corner = {layer_.first_x * layer_.side_m - origin.x, layer_.first_y * layer_.side_m - origin.y, 0};
    place_tiles();
    bound_groups();
    make_nodes();
    describe();
    return std::move(layer_);
  }

 private:
  void list_columns() {
    int west = std::numeric_limits<int>::max(), south = west, east = std::numeric_limits<int>::min(), north = east;
    for (std::size_t t = 0; t < details_.tiles.size(); ++t) {
      if (details_.instances[t] == 0) continue;
      const fill::TilePlace& at = details_.tiles[t];
      west = std::min(west, at.x);
      east = std::max(east, at.x);
      south = std::min(south, at.y);
      north = std::max(north, at.y);
    }
    if (west > east) return;
    layer_.first_x = west;
    layer_.first_y = south;
    const std::int64_t across = std::max(std::int64_t{east} - west, std::int64_t{north} - south) + 1;
    while ((std::int64_t{1} << (2 * layer_.levels)) < across) ++layer_.levels;
    for (std::size_t t = 0; t < details_.tiles.size();) {
      const fill::TilePlace& at = details_.tiles[t];
      std::size_t last = t;
      bool any = false;
      for (; last < details_.tiles.size() && details_.tiles[last].x == at.x && details_.tiles[last].y == at.y; ++last)
        any = any || details_.instances[last] > 0;
      if (any)
        places_.push_back({key_of(static_cast<std::uint32_t>(at.x - west), static_cast<std::uint32_t>(at.y - south)),
                           static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(last)});
      t = last;
    }
    std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.key < b.key; });
  }

  void place_tiles() {
    const std::uint64_t count = details_.count();
    if (count + detail_group > std::numeric_limits<std::uint32_t>::max())
      throw silvasim::base::Error("there are " + std::to_string(count) +
                                  " details in one layer; pictures hold at most 2^32");
    layer_.chosen.reserve(count + detail_group);
    layer_.columns.reserve(places_.size() + 1);
    std::vector<std::uint32_t> numbers(details_.tiles.size() + 1, 0);
    for (std::size_t t = 0; t < details_.tiles.size(); ++t) numbers[t + 1] = numbers[t] + details_.instances[t];
    std::uint32_t groups = 0;
    for (const Place& place : places_) {
      layer_.columns.push_back({static_cast<std::uint32_t>(layer_.tiles.size()), 0, {}});
      for (std::uint32_t t = place.first; t < place.last; ++t) {
        const auto chosen = details_.of(t);
        if (chosen.empty()) continue;
        layer_.tiles.push_back(
            {details_.tiles[t].z, static_cast<std::uint32_t>(layer_.chosen.size()), groups, numbers[t]});
        layer_.chosen.insert(layer_.chosen.end(), chosen.begin(), chosen.end());
        groups += (static_cast<std::uint32_t>(chosen.size()) + detail_group - 1) / detail_group;
      }
    }
    layer_.columns.push_back({static_cast<std::uint32_t>(layer_.tiles.size()), 0, {}});
    layer_.tiles.push_back({0, static_cast<std::uint32_t>(layer_.chosen.size()), groups, numbers.back()});
    for (const std::uint16_t c : layer_.chosen) ++counts_[c];
    layer_.chosen.insert(layer_.chosen.end(), detail_group, 0);
    layer_.group_bounds.assign(6 * std::size_t{groups} + 16, 0);
    layer_.tiles.shrink_to_fit();
  }

  // Margins of what stands, boxes of groups in bytes of a box that holds a tile and the margins.
  void bound_groups() {
    const auto side = static_cast<float>(layer_.side_m);
    float margin = 0;
    for (std::size_t c = 0; c < counts_.size(); ++c) {
      if (counts_[c] == 0) continue;
      for (std::size_t a = 0; a < 3; ++a)
        margin = std::max({margin, -layer_.least_m[a][c], layer_.most_m[a][c] - side});
    }
    layer_.margin_m = margin;
    layer_.group_origin_m = -margin;
    layer_.group_step_m = (side + 2 * margin) * (1.0f / 254);
    parallel_for(layer_.tiles.size() - 1, [&](std::size_t t) {
      const DetailTile& tile = layer_.tiles[t];
      const std::uint32_t end = layer_.tiles[t + 1].first, groups = layer_.tiles[t + 1].first_group - tile.first_group;
      std::uint8_t* const bytes = layer_.group_bounds.data() + 6 * std::size_t{tile.first_group};
      for (std::uint32_t g = 0; g < groups; ++g) {
        for (std::size_t a = 0; a < 3; ++a) {
          float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
          for (std::uint32_t i = tile.first + g * detail_group; i < std::min(end, tile.first + (g + 1) * detail_group);
               ++i) {
            least = std::min(least, layer_.least_m[a][layer_.chosen[i]]);
            most = std::max(most, layer_.most_m[a][layer_.chosen[i]]);
          }
          const auto byte = [&](float at, bool up) {
            const float steps = (at - layer_.group_origin_m) / layer_.group_step_m;
            return static_cast<std::uint8_t>(
                std::clamp(up ? std::ceil(steps + 0.01f) : std::floor(steps - 0.01f), 0.0f, 255.0f));
          };
          bytes[(2 * a) * groups + g] = byte(least, false);
          bytes[(2 * a + 1) * groups + g] = byte(most, true);
        }
      }
    });
  }

  // Level by level from the root, so that the children of a node lie together; then heights from below.
  void make_nodes() {
    struct Part {
      std::size_t first, last;  // of places_
    };
    std::vector<Part> parts{{0, places_.size()}};
    std::vector<std::size_t> level_begins;
    for (int level = layer_.levels - 1; level >= 0; --level) {
      std::vector<Part> next;
      level_begins.push_back(layer_.nodes.size());
      const std::size_t below_begin = layer_.nodes.size() + parts.size();
      for (const Part& part : parts) {
        DetailNode node;
        node.first = static_cast<std::uint32_t>(level == 0 ? part.first : below_begin + next.size());
        for (std::size_t i = part.first; i < part.last;) {
          const std::uint64_t digits = places_[i].key >> (4 * level);
          std::size_t last = i;
          while (last < part.last && places_[last].key >> (4 * level) == digits) ++last;
          node.children = static_cast<std::uint16_t>(node.children | 1u << (digits & 15));
          next.push_back({i, last});
          i = last;
        }
        layer_.nodes.push_back(node);
      }
      parts = std::move(next);
    }
    V3d least(std::numeric_limits<double>::max()), most(std::numeric_limits<double>::lowest());
    for (std::size_t n = layer_.nodes.size(); n-- > 0;) {
      DetailNode& node = layer_.nodes[n];
      node.least_m.fill(1);
      node.most_m.fill(0);
      std::uint32_t child = node.first;
      for (std::uint32_t bits = node.children; bits != 0; bits &= bits - 1, ++child) {
        const auto at = static_cast<std::size_t>(std::countr_zero(bits));
        if (n >= level_begins.back()) {
          heights_of(layer_.columns[child].first_tile, layer_.columns[child + 1].first_tile, node.least_m[at],
                     node.most_m[at]);
        } else {
          const DetailNode& under = layer_.nodes[child];
          float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
          for (std::uint32_t there = under.children; there != 0; there &= there - 1) {
            const auto k = static_cast<std::size_t>(std::countr_zero(there));
            low = std::min(low, under.least_m[k]);
            high = std::max(high, under.most_m[k]);
          }
          node.least_m[at] = low;
          node.most_m[at] = high;
        }
        least.z = std::min(least.z, static_cast<double>(node.least_m[at]));
        most.z = std::max(most.z, static_cast<double>(node.most_m[at]));
      }
    }
    int east = 0, north = 0;
    for (const Place& place : places_) {
      east = std::max(east, details_.tiles[place.first].x - layer_.first_x);
      north = std::max(north, details_.tiles[place.first].y - layer_.first_y);
    }
    const auto margin = static_cast<double>(layer_.margin_m);
    least.x = layer_.corner.x - margin;
    least.y = layer_.corner.y - margin;
    most.x = layer_.corner.x + (east + 1) * layer_.side_m + margin;
    most.y = layer_.corner.y + (north + 1) * layer_.side_m + margin;
    layer_.least = least;
    layer_.most = most;
  }

  void heights_of(std::uint32_t first, std::uint32_t last, float& least, float& most) const {
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
    for (std::uint32_t t = first; t < last; ++t) {
      const double floor = layer_.tiles[t].z * layer_.side_m;
      for (std::uint32_t i = layer_.tiles[t].first; i < layer_.tiles[t + 1].first; ++i) {
        low = std::min(low, floor + static_cast<double>(layer_.least_m[2][layer_.chosen[i]]));
        high = std::max(high, floor + static_cast<double>(layer_.most_m[2][layer_.chosen[i]]));
      }
    }
    least = below(low);
    most = above(high);
  }

  // What columns look like from afar, and from what width of rays on.
  void describe() {
    const float per_area = 1.0f / static_cast<float>(layer_.side_m * layer_.side_m);
    parallel_for(layer_.columns.size() - 1, [&](std::size_t k) {
      DetailColumn& column = layer_.columns[k];
      Rgb colour(0, 0, 0);
      float area = 0;
      for (std::uint32_t i = layer_.tiles[column.first_tile].first;
           i < layer_.tiles[layer_.columns[k + 1].first_tile].first; ++i) {
        const std::uint16_t c = layer_.chosen[i];
        area += kind_.covered_m2[c];
        colour += kind_.colours[layer_.frames[c].object] * kind_.covered_m2[c];
      }
      column.depth = static_cast<std::uint8_t>(std::min(255.0f, std::round(area * per_area / detail_depth_step)));
      for (int a = 0; a < 3; ++a) {
        const float mean = area > 0 ? std::clamp(colour[a] / area, 0.0f, 1.0f) : 0.0f;
        column.colour[static_cast<std::size_t>(a)] = static_cast<std::uint8_t>(std::lround(255 * std::sqrt(mean)));
      }
    });
    for (std::size_t c = 0; c < counts_.size(); ++c)
      if (counts_[c] > 0) layer_.most_size_m = std::max(layer_.most_size_m, layer_.frames[c].size_m);
    constexpr std::size_t steps = 64;
    layer_.part_faded.assign(steps + 1, 0);
    double sum = 0;
    for (std::size_t c = 0; c < counts_.size(); ++c) {
      if (counts_[c] == 0) continue;
      const double weight = static_cast<double>(counts_[c]) * static_cast<double>(kind_.covered_m2[c]);
      sum += weight;
      for (std::size_t s = 0; s <= steps; ++s) {
        const float width = layer_.most_faded() * static_cast<float>(s) / static_cast<float>(steps);
        const float part = std::clamp((width / (2 * layer_.frames[c].size_m) - 0.75f) / 0.5f, 0.0f, 1.0f);
        layer_.part_faded[s] += static_cast<float>(weight * static_cast<double>(part));
      }
    }
    for (float& part : layer_.part_faded) part = sum > 0 ? std::min(1.0f, part / static_cast<float>(sum)) : 0.0f;
  }

  const DetailKind& kind_;
  const fill::Details& details_;
  DetailLayer layer_;
  std::vector<std::uint64_t> counts_;  // by candidate
  std::vector<Place> places_;
};

}  // namespace

DetailLayer make_detail_layer(const DetailKind& kind, const fill::Details& details, silvasim::base::Point origin,
                              std::string name) {
  DetailLayer layer = LayerMaker(kind, details).run(origin);
  layer.name = std::move(name);
  return layer;
}

void number_details(Scene& scene) {
  std::uint64_t plant = 0;
  std::uint32_t object = 0;
  for (const PlantLayer& layer : scene.layers) {
    object += static_cast<std::uint32_t>(layer.species.size());
    plant += layer.first_slot.back();
  }
  for (DetailLayer& layer : scene.details) {
    layer.first_object = object;
    layer.first_plant = plant;
    object += static_cast<std::uint32_t>(layer.objects.size());
    plant += layer.count();
  }
}

}  // namespace silvavis::scene
