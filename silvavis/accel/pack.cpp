#include "silvavis/accel/pack.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <vector>

#include "silvasim/base/error.h"
#include "silvavis/accel/embree_device.h"

namespace silvavis::accel {

namespace {

using scene::PlantModel;

struct Corner {
  std::array<std::uint16_t, 3> at;
};
struct Triangle {
  std::array<Corner, 3> corners;
  std::uint32_t from = 0;  // in the model of floats
};

struct Bounds {
  V3 least{std::numeric_limits<float>::max()}, most{std::numeric_limits<float>::lowest()};
  void add(const V3& p) {
    for (int a = 0; a < 3; ++a) {
      least[a] = std::min(least[a], p[a]);
      most[a] = std::max(most[a], p[a]);
    }
  }
  void add(const Bounds& other) {
    add(other.least);
    add(other.most);
  }
};

V3 decoded(const PlantModel& model, const Corner& corner) {
  return {model.origin.x + model.step_m * static_cast<float>(corner.at[0]),
          model.origin.y + model.step_m * static_cast<float>(corner.at[1]),
          model.origin.z + model.step_m * static_cast<float>(corner.at[2])};
}

bool has_area(const Triangle& t) {
  const auto edge = [&](std::size_t corner, std::size_t axis) {
    return static_cast<std::int64_t>(t.corners[corner].at[axis]) - static_cast<std::int64_t>(t.corners[0].at[axis]);
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3;
    if (edge(1, a) * edge(2, b) != edge(1, b) * edge(2, a)) return true;
  }
  return false;
}

std::vector<Triangle> quantised(const assets::Model& from, PlantModel& to) {
  Bounds box;
  for (const auto& triangle : from.triangles)
    for (const std::uint32_t index : triangle) box.add(from.positions[index]);
  const V3 size = box.most - box.least;
  to.origin = box.least;
  to.step_m = std::max({size.x, size.y, size.z}) / 65535.0f;
  std::vector<Triangle> triangles;
  triangles.reserve(from.triangles.size());
  for (std::size_t i = 0; i < from.triangles.size(); ++i) {
    Triangle triangle;
    triangle.from = static_cast<std::uint32_t>(i);
    for (std::size_t c = 0; c < 3; ++c) {
      const V3& p = from.positions[from.triangles[i][c]];
      for (std::size_t a = 0; a < 3; ++a) {
        const int axis = static_cast<int>(a);
        const float steps = std::round((p[axis] - box.least[axis]) / to.step_m);
        triangle.corners[c].at[a] = static_cast<std::uint16_t>(std::clamp(steps, 0.0f, 65535.0f));
      }
    }
    if (has_area(triangle)) triangles.push_back(triangle);
  }
  if (triangles.empty())
    throw silvasim::base::Error("model \"" + from.name + "\" has no triangle larger than 1/65535 of its size");
  return triangles;
}

// The binary tree as Embree's builder leaves it, in its own memory.
struct Built {
  bool leaf = false;
};
struct BuiltLeaf : Built {
  std::uint32_t count = 0;
  std::array<std::uint32_t, scene::block_size> triangles{};
};
struct BuiltNode : Built {
  std::array<Built*, 2> children{};
  std::array<Bounds, 2> bounds{};
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned int, void*) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), 16)) BuiltNode;
}
void set_children(void* pointer, void** children, unsigned int count, void*) {
  auto* node = static_cast<BuiltNode*>(pointer);
  for (unsigned int i = 0; i < count; ++i) node->children[i] = static_cast<Built*>(children[i]);
}
void set_bounds(void* pointer, const RTCBounds** bounds, unsigned int count, void*) {
  auto* node = static_cast<BuiltNode*>(pointer);
  for (unsigned int i = 0; i < count; ++i) {
    node->bounds[i].least = {bounds[i]->lower_x, bounds[i]->lower_y, bounds[i]->lower_z};
    node->bounds[i].most = {bounds[i]->upper_x, bounds[i]->upper_y, bounds[i]->upper_z};
  }
}
void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count, void*) {
  auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BuiltLeaf), 16)) BuiltLeaf;
  leaf->leaf = true;
  leaf->count = static_cast<std::uint32_t>(count);
  for (size_t i = 0; i < count; ++i) leaf->triangles[i] = primitives[i].primID;
  // Threads may part triangles in any order.
  std::sort(leaf->triangles.begin(), leaf->triangles.begin() + leaf->count);
  return leaf;
}

// Which nodes of the binary tree become nodes of sixteen children: those that make the sum of their surfaces least, which is
// how many of them a ray is expected to visit. For each node and 1 to 16 places in the node above, the least sum that its part
// of the tree can have, from the bottom up (Ylitie, Karras and Laine 2017, section 3; here leaves are given).
class Collapse {
 public:
  Collapse(const Built* root, const Bounds& bounds) {
    places_.reserve(count(root));
    root_ = add(root, bounds);
  }

  struct Child {
    const Built* built;
    const Bounds* bounds;
    std::uint32_t index;
  };
  // The up to sixteen children of a node of the binary tree that becomes one of the wide tree.
  std::vector<Child> children_of(std::uint32_t index) const {
    std::vector<Child> children;
    const Place& place = places_[index];
    if (place.built->leaf) return {{place.built, place.bounds, index}};  // a model of one block
    gather(place.first, place.split[scene::node_size - 1], children);
    gather(place.second, static_cast<std::uint8_t>(scene::node_size - place.split[scene::node_size - 1]), children);
    return children;
  }
  std::uint32_t root() const { return root_; }
  std::size_t leaves() const { return leaves_; }

 private:
  struct Place {
    const Built* built = nullptr;
    const Bounds* bounds = nullptr;                      // in the builder's memory
    std::uint32_t first = 0, second = 0;                 // children
    std::array<float, scene::node_size> cost{};          // [places - 1]
    std::array<std::uint8_t, scene::node_size> split{};  // how many places the first child takes; 0: a node of its own
  };

  static std::size_t count(const Built* built) {
    if (built->leaf) return 1;
    const auto& children = static_cast<const BuiltNode&>(*built).children;
    return 1 + count(children[0]) + count(children[1]);
  }

  static float area(const Bounds& b) {
    const V3 size = b.most - b.least;
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }

  std::uint32_t add(const Built* built, const Bounds& bounds) {
    Place place;
    place.built = built;
    place.bounds = &bounds;
    if (built->leaf) {
      ++leaves_;
    } else {
      const auto& node = static_cast<const BuiltNode&>(*built);
      place.first = add(node.children[0], node.bounds[0]);
      place.second = add(node.children[1], node.bounds[1]);
      const Place &a = places_[place.first], &b = places_[place.second];
      for (std::size_t places = 2; places <= scene::node_size; ++places) {
        float& least = place.cost[places - 1];
        least = std::numeric_limits<float>::max();
        for (std::size_t k = 1; k < places; ++k) {
          const float cost = a.cost[k - 1] + b.cost[places - k - 1];
          if (cost >= least) continue;
          least = cost;
          place.split[places - 1] = static_cast<std::uint8_t>(k);
        }
      }
      place.cost[0] = place.cost[scene::node_size - 1] + area(bounds);
      for (std::size_t places = 2; places < scene::node_size; ++places) {
        if (place.cost[0] > place.cost[places - 1]) continue;
        place.cost[places - 1] = place.cost[0];
        place.split[places - 1] = 0;
      }
    }
    places_.push_back(place);
    return static_cast<std::uint32_t>(places_.size() - 1);
  }

  void gather(std::uint32_t index, std::uint8_t places, std::vector<Child>& children) const {
    const Place& place = places_[index];
    if (place.built->leaf || places == 1 || place.split[places - 1u] == 0) {
      children.push_back({place.built, place.bounds, index});
      return;
    }
    gather(place.first, place.split[places - 1u], children);
    gather(place.second, static_cast<std::uint8_t>(places - place.split[places - 1u]), children);
  }

  std::vector<Place> places_;
  std::uint32_t root_ = 0;
  std::size_t leaves_ = 0;
};

class Packer {
 public:
  Packer(const assets::Model& from, PlantModel& to) : from_(from), to_(to), triangles_(quantised(from, to)) {}

  void run() {
    set_measures();
    set_uv_range();
    set_hull();
    build();
    to_.triangles = static_cast<std::uint32_t>(triangles_.size());
  }

 private:
  void set_measures() {
    Bounds box;
    float reach = 0;
    for_each_corner([&](const V3& p) {
      box.add(p);
      reach = std::max(reach, std::hypot(p.x, p.y));
    });
    to_.least = box.least;
    to_.most = box.most;
    to_.reach_m = reach;
    const float foot_top = std::max(box.least.z, 0.0f) + 0.02f * (box.most.z - std::max(box.least.z, 0.0f));
    // A stem that goes on below the ground needs no sinking.
    if (box.least.z > -0.02f * box.most.z) {
      for_each_corner([&](const V3& p) {
        if (p.z <= foot_top) to_.foot_m = std::max(to_.foot_m, std::hypot(p.x, p.y));
      });
    }
  }

  void set_uv_range() {
    V2 least(std::numeric_limits<float>::max()), most(std::numeric_limits<float>::lowest());
    for (const V2& uv : from_.uvs) {
      least = {std::min(least.x, uv.x), std::min(least.y, uv.y)};
      most = {std::max(most.x, uv.x), std::max(most.y, uv.y)};
    }
    to_.uv_origin = least;
    to_.uv_step = (most - least) / 65535.0f;
  }

  void set_hull() {
    const float height = to_.most.z - to_.least.z;
    for (std::size_t i = 0; i <= scene::hull_size; ++i)
      to_.hull.edges_m[i] = to_.least.z + height * static_cast<float>(i) / static_cast<float>(scene::hull_size);
    for (const Triangle& triangle : triangles_) {
      float low = std::numeric_limits<float>::max(), high = -low, reach = 0;
      for (const Corner& corner : triangle.corners) {
        const V3 p = decoded(to_, corner);
        low = std::min(low, p.z);
        high = std::max(high, p.z);
        reach = std::max(reach, std::hypot(p.x, p.y));
      }
      for (std::size_t i = 0; i < scene::hull_size; ++i) {
        if (high < to_.hull.edges_m[i] || low > to_.hull.edges_m[i + 1]) continue;
        to_.hull.radii_m[i] = std::max(to_.hull.radii_m[i], reach);
      }
    }
    // What rounding in a ray's arithmetic may need.
    const float slack = 1e-4f * std::max(to_.reach_m, height);
    for (float& radius : to_.hull.radii_m) radius += radius > 0 ? slack : 0;
    to_.hull.edges_m.front() -= slack;
    to_.hull.edges_m.back() += slack;
  }

  void build() {
    const EmbreeDevice device;
    std::vector<RTCBuildPrimitive> primitives(triangles_.size());
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      Bounds box;
      for (const Corner& corner : triangles_[i].corners) box.add(decoded(to_, corner));
      primitives[i] = {box.least.x, box.least.y, box.least.z, 0,
                       box.most.x,  box.most.y,  box.most.z,  static_cast<unsigned int>(i)};
    }
    RTCBVH bvh = rtcNewBVH(device.get());
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = 1024;
    arguments.sahBlockSize = scene::block_size;
    arguments.minLeafSize = scene::block_size;
    arguments.maxLeafSize = scene::block_size;
    arguments.bvh = bvh;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = primitives.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    const auto* root = static_cast<const Built*>(rtcBuildBVH(&arguments));
    if (!root) {
      rtcReleaseBVH(bvh);
      throw silvasim::base::Error("Embree could not build the tree of model \"" + from_.name + "\"");
    }
    primitives = {};
    {
      const Bounds whole{to_.least, to_.most};
      const Collapse collapse(root, whole);
      to_.blocks.reserve(collapse.leaves());
      to_.normals.reserve(collapse.leaves() * scene::block_size);
      to_.nodes.resize(1);
      fill(0, collapse, collapse.root(), 0);
      to_.nodes.shrink_to_fit();
    }
    rtcReleaseBVH(bvh);
  }

  void fill(std::size_t index, const Collapse& collapse, std::uint32_t from, int depth) {
    if (depth >= scene::most_depth)
      throw silvasim::base::Error("the triangles of model \"" + from_.name + "\" lie so that no tree of " +
                                  std::to_string(scene::most_depth) + " levels holds them");
    const std::vector<Collapse::Child> children = collapse.children_of(from);
    scene::TreeNode node;
    Bounds box;
    for (const auto& child : children) box.add(*child.bounds);
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      node.origin[axis] = box.least[a];
      // The least power of two whose 254 steps reach across; one byte is left for rounding outward.
      int power = 0;
      std::frexp(std::max((box.most[a] - box.least[a]) / 254.0f, 1e-9f), &power);
      node.exponent[axis] = static_cast<std::uint8_t>(power + 127);
      const float step = node.step(axis);
      for (std::size_t c = 0; c < children.size(); ++c) {
        const auto decoded_bound = [&](int byte) { return node.origin[axis] + step * static_cast<float>(byte); };
        int low = static_cast<int>(std::floor((children[c].bounds->least[a] - node.origin[axis]) / step));
        int high = static_cast<int>(std::ceil((children[c].bounds->most[a] - node.origin[axis]) / step));
        while (low > 0 && decoded_bound(low) > children[c].bounds->least[a]) --low;
        while (high < 255 && decoded_bound(high) < children[c].bounds->most[a]) ++high;
        node.least[axis][c] = static_cast<std::uint8_t>(std::clamp(low, 0, 255));
        node.most[axis][c] = static_cast<std::uint8_t>(std::clamp(high, 0, 255));
      }
    }
    std::uint32_t inner = 0;
    for (std::size_t c = 0; c < children.size(); ++c) {
      const auto bit = static_cast<std::uint16_t>(1u << c);
      if (children[c].built->leaf) {
        node.leaves |= bit;
      } else {
        node.inner |= bit;
        ++inner;
      }
    }
    node.first_block = static_cast<std::uint32_t>(to_.blocks.size());
    for (std::size_t c = 0; c < children.size(); ++c)
      if (children[c].built->leaf) add_block(*static_cast<const BuiltLeaf*>(children[c].built));
    node.first_node = static_cast<std::uint32_t>(to_.nodes.size());
    to_.nodes.resize(to_.nodes.size() + inner);
    to_.nodes[index] = node;
    std::uint32_t next = node.first_node;
    for (std::size_t c = 0; c < children.size(); ++c)
      if (!children[c].built->leaf) fill(next++, collapse, children[c].index, depth + 1);
  }

  void add_block(const BuiltLeaf& leaf) {
    scene::TriangleBlock block{};
    const auto& first = triangles_[leaf.triangles[0]].corners[0].at;
    for (std::size_t lane = 0; lane < scene::block_size; ++lane) {
      const bool there = lane < leaf.count;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          block.corners[corner][axis][lane] =
              there ? triangles_[leaf.triangles[lane]].corners[corner].at[axis] : first[axis];
        }
      }
      to_.normals.emplace_back();
      if (there) fill_attributes(block, lane, triangles_[leaf.triangles[lane]].from);
    }
    to_.blocks.push_back(block);
  }

  void fill_attributes(scene::TriangleBlock& block, std::size_t lane, std::uint32_t triangle) {
    const auto stored = [](float at, float step) {
      return static_cast<std::uint16_t>(step > 0 ? std::lround(at / step) : 0);
    };
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t vertex = from_.triangles[triangle][c];
      const V2 uv = from_.uvs[vertex] - to_.uv_origin;
      block.uv[c][0][lane] = stored(uv.x, to_.uv_step.x);
      block.uv[c][1][lane] = stored(uv.y, to_.uv_step.y);
      to_.normals.back()[c] = scene::packed_normal(from_.normals[vertex]);
    }
    block.materials[lane] = from_.triangle_materials[triangle];
  }

  template <typename Visit>
  void for_each_corner(Visit&& visit) const {
    for (const Triangle& triangle : triangles_)
      for (const Corner& corner : triangle.corners) visit(decoded(to_, corner));
  }

  const assets::Model& from_;
  PlantModel& to_;
  std::vector<Triangle> triangles_;
};

}  // namespace

PlantModel pack(const assets::Model& model, std::shared_ptr<const scene::Looks> looks) {
  PlantModel packed;
  packed.name = model.name;
  packed.looks = looks ? std::move(looks) : scene::looks_of(model);
  Packer(model, packed).run();
  return packed;
}

}  // namespace silvavis::accel
