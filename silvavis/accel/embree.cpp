#include "silvavis/accel/embree.h"

#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <unordered_map>
#include <vector>

#include "silvasim/base/error.h"
#include "silvavis/accel/embree_device.h"
#include "silvavis/scene/detail_ray.h"
#include "silvavis/scene/instance.h"

namespace silvavis::accel {

namespace {

constexpr unsigned int ground_id = 0;
constexpr std::size_t packet_size = 16;

// Which plant an instance or primitive is.
struct Place {
  std::uint32_t position;  // column + row * columns, row 0 the southernmost
  std::uint32_t slot : 24;
  std::uint32_t layer : 8;
};

// Which detail.
struct DetailPlace {
  std::int32_t column, row, z;  // tile
  std::uint32_t slot;           // into DetailLayer::chosen
  std::uint8_t layer;
};

// What callbacks need of the ray they belong to, behind Embree's own context.
struct Context {
  RTCIntersectContext embree;
  const Ray* ray = nullptr;
  Hit* hit = nullptr;
  double best = 0;
};

// The same for the query of one plant, whose ray begins elsewhere than Embree's.
struct PlantContext {
  RTCIntersectContext embree;
  const scene::LocalRay* ray = nullptr;
};

// Denormal numbers slow Embree down; the thread's own setting comes back afterwards.
class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
  ~FlushDenormals() { _mm_setcsr(before_); }

 private:
  unsigned int before_;
};

// Whether a hit does not count: a hole, or the back of a leaf that has none.
bool is_nothing(const scene::PlantModel& model, unsigned int slot, float u, float v, bool from_behind) {
  return (from_behind && !model.looks->cutouts[model.material_of(slot)].two_sided) || scene::is_hole(model, slot, u, v);
}

bool from_behind(const RTCFilterFunctionNArguments& a, unsigned int i) {
  return RTCHitN_Ng_x(a.hit, a.N, i) * RTCRayN_dir_x(a.ray, a.N, i) +
             RTCHitN_Ng_y(a.hit, a.N, i) * RTCRayN_dir_y(a.ray, a.N, i) +
             RTCHitN_Ng_z(a.hit, a.N, i) * RTCRayN_dir_z(a.ray, a.N, i) >
         0;
}

// Embree calls this for each hit of a model with holes; "not valid" lets the ray go on.
void skip_holes(const RTCFilterFunctionNArguments* arguments) {
  const auto& model = *static_cast<const scene::PlantModel*>(arguments->geometryUserPtr);
  for (unsigned int i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned int slot = RTCHitN_primID(arguments->hit, arguments->N, i);
    if (is_nothing(model, slot, RTCHitN_u(arguments->hit, arguments->N, i), RTCHitN_v(arguments->hit, arguments->N, i),
                   from_behind(*arguments, i)))
      arguments->valid[i] = 0;
  }
}

// The same with the arithmetic of the nested trees.
void skip_holes_exactly(const RTCFilterFunctionNArguments* arguments) {
  const auto& model = *static_cast<const scene::PlantModel*>(arguments->geometryUserPtr);
  const scene::LocalRay& ray = *reinterpret_cast<const PlantContext*>(arguments->context)->ray;
  const unsigned int slot = RTCHitN_primID(arguments->hit, arguments->N, 0);
  const scene::TrianglePoint at = scene::meet_triangle(model, slot, ray.origin, ray.direction);
  if (arguments->valid[0] != 0 && is_nothing(model, slot, at.u, at.v, from_behind(*arguments, 0)))
    arguments->valid[0] = 0;
}

class Flatland final : public Tracer {
 public:
  Flatland(const scene::Scene& scene, Flat flat)
      : scene_(scene), exact_(flat == Flat::exact), packets_(flat == Flat::packets) {
    rtcSetDeviceMemoryMonitorFunction(device_.get(), count_bytes, &bytes_);
    top_ = rtcNewScene(device_.get());
    add_ground();
    for (const auto& model : scene_.models) models_.push_back(make_model(*model));
    list_plants();
    list_details();
    exact_ ? add_plants_as_primitives() : add_plants_as_instances();
    if (!details_.empty()) exact_ ? add_details_as_primitives() : add_details_as_instances();
    rtcCommitScene(top_);
    check();
  }
  Flatland(const Flatland&) = delete;
  Flatland& operator=(const Flatland&) = delete;
  ~Flatland() override {
    rtcReleaseScene(top_);
    for (RTCScene model : models_) rtcReleaseScene(model);
  }

  void nearest(std::span<const Ray> rays, std::span<Hit> hits) const override {
    const FlushDenormals flush;
    std::size_t i = 0;
    if (packets_)
      for (; i < rays.size(); i += packet_size) nearest_packet(rays.subspan(i), hits.subspan(i));
    for (; i < rays.size(); ++i) hits[i] = nearest(rays[i]);
  }

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> answers) const override {
    const FlushDenormals flush;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Hit ignored;
      Context context = context_of(rays[i], ignored);
      RTCRay ray = ray_of(rays[i]);
      rtcOccluded1(top_, &context.embree, &ray);
      answers[i] = ray.tfar < 0 ? 1 : 0;
    }
  }

  std::size_t bytes() const override {
    return static_cast<std::size_t>(bytes_) + places_.capacity() * sizeof(Place) +
           details_.capacity() * sizeof(DetailPlace);
  }

 private:
  static bool count_bytes(void* sum, ssize_t change, bool) {
    // Embree calls from several threads.
    __atomic_fetch_add(static_cast<std::int64_t*>(sum), static_cast<std::int64_t>(change), __ATOMIC_RELAXED);
    return true;
  }

  void check() const {
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
      throw silvasim::base::Error(
          "Embree could not build the scene; it takes about 0.5 kB a plant, --backend nested far less");
  }

  static RTCRay ray_of(const Ray& from) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(from.origin.x);
    ray.org_y = static_cast<float>(from.origin.y);
    ray.org_z = static_cast<float>(from.origin.z);
    ray.dir_x = from.direction.x;
    ray.dir_y = from.direction.y;
    ray.dir_z = from.direction.z;
    ray.tnear = static_cast<float>(from.least);
    ray.tfar = static_cast<float>(from.most);
    ray.mask = ~0u;
    return ray;
  }

  static Context context_of(const Ray& ray, Hit& hit) {
    Context context;
    rtcInitIntersectContext(&context.embree);
    context.ray = &ray;
    context.hit = &hit;
    context.best = ray.most;
    return context;
  }

  Hit nearest(const Ray& from) const {
    Hit hit;
    Context context = context_of(from, hit);
    RTCRayHit query{};
    query.ray = ray_of(from);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(top_, &context.embree, &query);
    const bool on_ground = query.hit.instID[0] == RTC_INVALID_GEOMETRY_ID && query.hit.geomID == ground_id;
    if (exact_ && query.hit.geomID != RTC_INVALID_GEOMETRY_ID && !on_ground) return hit;  // filled on the way
    return hit_of(query.hit.geomID, query.hit.instID[0], query.hit.primID, query.ray.tfar, query.hit.u, query.hit.v);
  }

  // The first sixteen rays, or all where there are fewer.
  void nearest_packet(std::span<const Ray> rays, std::span<Hit> hits) const {
    const std::size_t count = std::min(rays.size(), packet_size);
    alignas(64) RTCRayHit16 query{};
    alignas(64) std::array<int, packet_size> valid{};
    for (std::size_t i = 0; i < count; ++i) {
      const RTCRay ray = ray_of(rays[i]);
      valid[i] = -1;
      query.ray.org_x[i] = ray.org_x;
      query.ray.org_y[i] = ray.org_y;
      query.ray.org_z[i] = ray.org_z;
      query.ray.dir_x[i] = ray.dir_x;
      query.ray.dir_y[i] = ray.dir_y;
      query.ray.dir_z[i] = ray.dir_z;
      query.ray.tnear[i] = ray.tnear;
      query.ray.tfar[i] = ray.tfar;
      query.ray.mask[i] = ray.mask;
      query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid.data(), top_, &context, &query);
    for (std::size_t i = 0; i < count; ++i)
      hits[i] = hit_of(query.hit.geomID[i], query.hit.instID[0][i], query.hit.primID[i], query.ray.tfar[i],
                       query.hit.u[i], query.hit.v[i]);
  }

  // What Embree's numbers mean.
  Hit hit_of(unsigned int geometry, unsigned int instance, unsigned int slot, float distance, float u, float v) const {
    Hit hit;
    if (geometry == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.distance = static_cast<double>(distance);
    if (instance == RTC_INVALID_GEOMETRY_ID && geometry == ground_id) {
      hit.surface = Surface::ground;
      return hit;
    }
    if (instance > places_.size()) {
      set_place(hit, details_[instance - 1 - places_.size()]);
    } else {
      set_place(hit, places_[instance - 1]);
    }
    hit.slot = slot;
    hit.u = u;
    hit.v = v;
    return hit;
  }

  scene::Instance instance_of(const Place& place) const {
    const scene::PlantLayer& layer = scene_.layers[place.layer];
    const int column = static_cast<int>(place.position) % layer.columns,
              row = static_cast<int>(place.position) / layer.columns;
    const std::uint8_t species = layer.plant_species[layer.first_slot[layer.position(column, row)] + place.slot];
    return scene::instance_at(scene_, layer, column, row, place.slot, species);
  }

  void set_place(Hit& hit, const Place& place) const {
    const scene::PlantLayer& layer = scene_.layers[place.layer];
    hit.surface = Surface::plant;
    hit.layer = static_cast<std::uint8_t>(place.layer);
    hit.column = static_cast<int>(place.position) % layer.columns;
    hit.row = static_cast<int>(place.position) / layer.columns;
    hit.site_slot = place.slot;
    hit.species = layer.plant_species[layer.first_slot[layer.position(hit.column, hit.row)] + place.slot];
    hit.model = instance_of(place).model;
  }

  const scene::DetailFrame& frame_of(const DetailPlace& place) const {
    const scene::DetailLayer& layer = scene_.details[place.layer];
    return layer.frames[layer.chosen[place.slot]];
  }
  V3d corner_of(const DetailPlace& place) const {
    const scene::DetailLayer& layer = scene_.details[place.layer];
    return {layer.corner.x + (place.column - layer.first_x) * layer.side_m,
            layer.corner.y + (place.row - layer.first_y) * layer.side_m, place.z * layer.side_m};
  }

  void set_place(Hit& hit, const DetailPlace& place) const {
    hit.surface = Surface::detail;
    hit.layer = place.layer;
    hit.column = place.column;
    hit.row = place.row;
    hit.site_slot = place.slot;
    hit.model = frame_of(place).model;
  }

  void add_ground() {
    const scene::Ground& ground = scene_.ground;
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    const auto columns = static_cast<std::size_t>(ground.columns), rows = static_cast<std::size_t>(ground.rows);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, columns * rows));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, (columns - 1) * (rows - 1) * 2));
    for (std::size_t j = 0; j < rows; ++j) {
      for (std::size_t i = 0; i < columns; ++i) {
        float* const vertex = vertices + (j * columns + i) * 3;
        vertex[0] = static_cast<float>(ground.west + static_cast<double>(i) * ground.cell_x_m);
        vertex[1] = static_cast<float>(ground.south + static_cast<double>(j) * ground.cell_y_m);
        vertex[2] = ground.heights_m[j * columns + i];
        if (i + 1 == columns || j + 1 == rows) continue;
        const auto corner = static_cast<std::uint32_t>(j * columns + i);
        const auto above = corner + static_cast<std::uint32_t>(columns);
        std::uint32_t* const triangles = indices + (j * (columns - 1) + i) * 6;
        const std::uint32_t corners[6] = {corner, corner + 1, above + 1, corner, above + 1, above};
        std::copy_n(corners, 6, triangles);
      }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(top_, geometry, ground_id);
    rtcReleaseGeometry(geometry);
  }

  RTCScene make_model(const scene::PlantModel& model) {
    RTCScene scene = rtcNewScene(device_.get());
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    // Corners at the same place share a vertex. Triangle numbers are slots; empty slots are triangles without area.
    std::unordered_map<std::uint64_t, std::uint32_t> numbers;
    std::vector<V3> vertices;
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, model.normals.size()));
    for (std::uint32_t slot = 0; slot < model.normals.size(); ++slot) {
      for (int c = 0; c < 3; ++c) {
        const auto& corner = model.blocks[slot / scene::block_size].corners[static_cast<std::size_t>(c)];
        const std::uint32_t lane = slot % scene::block_size;
        const std::uint64_t key =
            std::uint64_t{corner[0][lane]} << 32 | std::uint64_t{corner[1][lane]} << 16 | corner[2][lane];
        const auto [found, added] = numbers.try_emplace(key, static_cast<std::uint32_t>(vertices.size()));
        if (added) vertices.push_back(model.position_of(slot, c));
        indices[slot * 3 + static_cast<std::uint32_t>(c)] = found->second;
      }
    }
    auto* buffer = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertices.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i) std::copy_n(&vertices[i].x, 3, buffer + i * 3);
    rtcSetGeometryUserData(geometry, const_cast<scene::PlantModel*>(&model));
    const bool holes = std::any_of(model.looks->cutouts.begin(), model.looks->cutouts.end(),
                                   [](const scene::Cutout& cutout) { return cutout.width > 0 || !cutout.two_sided; });
    if (holes) {
      rtcSetGeometryIntersectFilterFunction(geometry, exact_ ? skip_holes_exactly : skip_holes);
      rtcSetGeometryOccludedFilterFunction(geometry, exact_ ? skip_holes_exactly : skip_holes);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    return scene;
  }

  void list_plants() {
    places_.reserve(scene_.plants);
    for (std::size_t k = 0; k < scene_.layers.size(); ++k) {
      const scene::PlantLayer& layer = scene_.layers[k];
      for (int row = 0; row < layer.rows; ++row) {
        for (int column = 0; column < layer.columns; ++column) {
          const std::size_t position = layer.position(column, row);
          const std::uint32_t count = layer.tile_sites[layer.tiles[position]].count;
          for (std::uint32_t slot = 0; slot < count; ++slot) {
            if (layer.plant_species[layer.first_slot[position] + slot] == scene::no_species) continue;
            places_.push_back(
                {static_cast<std::uint32_t>(row * layer.columns + column), slot, static_cast<std::uint32_t>(k)});
          }
        }
      }
    }
  }

  void list_details() {
    for (std::size_t k = 0; k < scene_.details.size(); ++k) {
      const scene::DetailLayer& layer = scene_.details[k];
      if (layer.nodes.empty()) continue;
      const auto list = [&](auto& self, std::uint32_t index, int level, int column, int row) -> void {
        const scene::DetailNode& node = layer.nodes[index];
        std::uint32_t child = node.first;
        for (std::uint32_t bits = node.children; bits != 0; bits &= bits - 1, ++child) {
          const int at = std::countr_zero(bits), x = column * 4 + (at & 3), y = row * 4 + (at >> 2);
          if (level > 0) {
            self(self, child, level - 1, x, y);
            continue;
          }
          for (std::uint32_t t = layer.columns[child].first_tile; t < layer.columns[child + 1].first_tile; ++t)
            for (std::uint32_t slot = layer.tiles[t].first; slot < layer.tiles[t + 1].first; ++slot)
              details_.push_back(
                  {layer.first_x + x, layer.first_y + y, layer.tiles[t].z, slot, static_cast<std::uint8_t>(k)});
        }
      };
      list(list, 0, layer.levels - 1, 0, 0);
    }
  }

  void add_details_as_instances() {
    for (std::size_t i = 0; i < details_.size(); ++i) {
      const scene::DetailFrame& frame = frame_of(details_[i]);
      const V3d at = corner_of(details_[i]) + V3d(frame.at);
      RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, models_[frame.model]);
      float matrix[12];
      for (int axis = 0; axis < 3; ++axis) {
        V3 unit(0, 0, 0);
        unit[axis] = frame.scale;
        const V3 column = frame.turned(unit);
        std::copy_n(&column.x, 3, matrix + 3 * axis);
      }
      for (int axis = 0; axis < 3; ++axis) matrix[9 + axis] = static_cast<float>(at[axis]);
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix);
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(top_, geometry, static_cast<unsigned int>(places_.size() + i + 1));
      rtcReleaseGeometry(geometry);
    }
  }

  void add_details_as_primitives() {
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned int>(details_.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bound_detail, this);
    rtcSetGeometryIntersectFunction(geometry, [](const RTCIntersectFunctionNArguments* a) {
      static_cast<const Flatland*>(a->geometryUserPtr)->meet_detail(*a);
    });
    rtcSetGeometryOccludedFunction(geometry, [](const RTCOccludedFunctionNArguments* a) {
      static_cast<const Flatland*>(a->geometryUserPtr)->meet_detail(*a);
    });
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(top_, geometry);
    rtcReleaseGeometry(geometry);
  }

  static void bound_detail(const RTCBoundsFunctionArguments* arguments) {
    const auto& self = *static_cast<const Flatland*>(arguments->geometryUserPtr);
    const DetailPlace& place = self.details_[arguments->primID];
    const scene::DetailLayer& layer = self.scene_.details[place.layer];
    const V3d corner = self.corner_of(place);
    const std::uint16_t candidate = layer.chosen[place.slot];
    constexpr double slack_m = 0.01;
    const auto least = [&](std::size_t a) {
      return static_cast<float>(corner[static_cast<int>(a)] + static_cast<double>(layer.least_m[a][candidate]) -
                                slack_m);
    };
    const auto most = [&](std::size_t a) {
      return static_cast<float>(corner[static_cast<int>(a)] + static_cast<double>(layer.most_m[a][candidate]) +
                                slack_m);
    };
    RTCBounds& box = *arguments->bounds_o;
    box.lower_x = least(0);
    box.lower_y = least(1);
    box.lower_z = least(2);
    box.upper_x = most(0);
    box.upper_y = most(1);
    box.upper_z = most(2);
  }

  void add_plants_as_instances() {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const scene::Instance plant = instance_of(places_[i]);
      RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, models_[plant.model]);
      const float c = plant.turn.cosine * plant.scale, s = plant.turn.sine * plant.scale;
      const float matrix[12] = {c,
                                s,
                                0,
                                -s,
                                c,
                                0,
                                0,
                                0,
                                plant.scale,
                                static_cast<float>(plant.foot.x),
                                static_cast<float>(plant.foot.y),
                                static_cast<float>(plant.foot.z)};
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix);
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(top_, geometry, static_cast<unsigned int>(i + 1));
      rtcReleaseGeometry(geometry);
    }
  }

  void add_plants_as_primitives() {
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned int>(places_.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bound_plant, this);
    rtcSetGeometryIntersectFunction(geometry, [](const RTCIntersectFunctionNArguments* a) {
      static_cast<const Flatland*>(a->geometryUserPtr)->meet(*a);
    });
    rtcSetGeometryOccludedFunction(geometry, [](const RTCOccludedFunctionNArguments* a) {
      static_cast<const Flatland*>(a->geometryUserPtr)->meet(*a);
    });
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(top_, geometry);
    rtcReleaseGeometry(geometry);
  }

  static void bound_plant(const RTCBoundsFunctionArguments* arguments) {
    const auto& self = *static_cast<const Flatland*>(arguments->geometryUserPtr);
    const scene::Instance plant = self.instance_of(self.places_[arguments->primID]);
    const scene::PlantModel& model = *self.scene_.models[plant.model];
    constexpr double slack_m = 0.1;
    const auto scale = static_cast<double>(plant.scale);
    const double reach = static_cast<double>(model.reach_m) * scale + slack_m;
    RTCBounds& box = *arguments->bounds_o;
    box.lower_x = static_cast<float>(plant.foot.x - reach);
    box.lower_y = static_cast<float>(plant.foot.y - reach);
    box.upper_x = static_cast<float>(plant.foot.x + reach);
    box.upper_y = static_cast<float>(plant.foot.y + reach);
    box.lower_z = static_cast<float>(plant.foot.z + static_cast<double>(model.least.z) * scale - slack_m);
    box.upper_z = static_cast<float>(plant.foot.z + static_cast<double>(model.most.z) * scale + slack_m);
  }

  static RTCRay local_ray_of(const scene::LocalRay& local, float scale, const Ray& ray, double best) {
    const double size = 1.0 / static_cast<double>(scale);
    RTCRay query{};
    query.org_x = local.origin.x;
    query.org_y = local.origin.y;
    query.org_z = local.origin.z;
    query.dir_x = local.direction.x;
    query.dir_y = local.direction.y;
    query.dir_z = local.direction.z;
    // Embree refuses what lies behind a ray's origin, so the ray begins before the plant.
    const double least = (ray.least - local.start) * size;
    const double back = std::clamp(least, -200.0, 0.0);
    query.org_x += static_cast<float>(back) * query.dir_x;
    query.org_y += static_cast<float>(back) * query.dir_y;
    query.org_z += static_cast<float>(back) * query.dir_z;
    query.tnear = static_cast<float>(std::max(least - back, 0.0));
    query.tfar = static_cast<float>(std::min((best - local.start) * size - back, 1e30));
    query.mask = ~0u;
    return query;
  }

  // A model by the ray in its own space; `set` fills in which instance it is.
  template <typename SetPlace>
  void meet_model(const RTCIntersectFunctionNArguments& arguments, const scene::LocalRay& local, float scale,
                  std::uint32_t model, const SetPlace& set) const {
    auto& context = *reinterpret_cast<Context*>(arguments.context);
    auto* const outer = reinterpret_cast<RTCRayHit*>(arguments.rayhit);
    // The ground, which Embree meets by itself, shortens the ray too.
    const double best = std::min(context.best, static_cast<double>(outer->ray.tfar));
    RTCRayHit query{};
    query.ray = local_ray_of(local, scale, *context.ray, best);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (query.ray.tfar <= query.ray.tnear) return;
    PlantContext inner;
    rtcInitIntersectContext(&inner.embree);
    inner.ray = &local;
    rtcIntersect1(models_[model], &inner.embree, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
    const scene::TrianglePoint at =
        scene::meet_triangle(*scene_.models[model], query.hit.primID, local.origin, local.direction);
    const double distance = local.start + static_cast<double>(at.t) * static_cast<double>(scale);
    if (distance >= best || distance < context.ray->least) return;
    context.best = distance;
    Hit& hit = *context.hit;
    hit = {};
    set(hit);
    hit.distance = distance;
    hit.slot = query.hit.primID;
    hit.u = at.u;
    hit.v = at.v;
    outer->ray.tfar = std::nextafter(static_cast<float>(distance), std::numeric_limits<float>::infinity());
    outer->hit.geomID = arguments.geomID;
    outer->hit.primID = arguments.primID;
    outer->hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  }

  void bar_model(const RTCOccludedFunctionNArguments& arguments, const scene::LocalRay& local, float scale,
                 std::uint32_t model) const {
    const auto& context = *reinterpret_cast<const Context*>(arguments.context);
    RTCRay query = local_ray_of(local, scale, *context.ray, context.ray->most);
    if (query.tfar <= query.tnear) return;
    PlantContext inner;
    rtcInitIntersectContext(&inner.embree);
    inner.ray = &local;
    rtcOccluded1(models_[model], &inner.embree, &query);
    if (query.tfar < 0) reinterpret_cast<RTCRay*>(arguments.ray)->tfar = -std::numeric_limits<float>::infinity();
  }

  static const Ray& ray_of_context(const RTCIntersectContext* context) {
    return *reinterpret_cast<const Context*>(context)->ray;
  }

  void meet(const RTCIntersectFunctionNArguments& arguments) const {
    if (arguments.valid[0] == 0) return;
    const Ray& ray = ray_of_context(arguments.context);
    const Place& place = places_[arguments.primID];
    const scene::Instance plant = instance_of(place);
    meet_model(arguments, scene::local_ray(plant, ray.origin, ray.direction), plant.scale, plant.model,
               [&](Hit& hit) { set_place(hit, place); });
  }

  void meet(const RTCOccludedFunctionNArguments& arguments) const {
    if (arguments.valid[0] == 0) return;
    const Ray& ray = ray_of_context(arguments.context);
    const scene::Instance plant = instance_of(places_[arguments.primID]);
    bar_model(arguments, scene::local_ray(plant, ray.origin, ray.direction), plant.scale, plant.model);
  }

  void meet_detail(const RTCIntersectFunctionNArguments& arguments) const {
    if (arguments.valid[0] == 0) return;
    const Ray& ray = ray_of_context(arguments.context);
    const DetailPlace& place = details_[arguments.primID];
    const scene::DetailFrame& frame = frame_of(place);
    meet_model(arguments, scene::detail_ray(frame, corner_of(place), ray.origin, ray.direction), frame.scale,
               frame.model, [&](Hit& hit) { set_place(hit, place); });
  }

  void meet_detail(const RTCOccludedFunctionNArguments& arguments) const {
    if (arguments.valid[0] == 0) return;
    const Ray& ray = ray_of_context(arguments.context);
    const DetailPlace& place = details_[arguments.primID];
    const scene::DetailFrame& frame = frame_of(place);
    bar_model(arguments, scene::detail_ray(frame, corner_of(place), ray.origin, ray.direction), frame.scale,
              frame.model);
  }

  const scene::Scene& scene_;
  bool exact_, packets_;
  mutable std::int64_t bytes_ = 0;  // counted by the device to its end
  EmbreeDevice device_;
  RTCScene top_ = nullptr;
  std::vector<RTCScene> models_;
  std::vector<Place> places_;
  std::vector<DetailPlace> details_;
};

}  // namespace

std::unique_ptr<Tracer> make_embree(const scene::Scene& scene, Flat flat) {
  return std::make_unique<Flatland>(scene, flat);
}

}  // namespace silvavis::accel
