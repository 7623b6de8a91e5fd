#include "silvavis/scene/plant_model.h"

#include <algorithm>
#include <cmath>

namespace silvavis::scene {

namespace {

float sign_of(float x) { return x < 0 ? -1.0f : 1.0f; }

}  // namespace

TrianglePoint meet_triangle(const PlantModel& model, std::uint32_t slot, const V3& origin, const V3& direction) {
  const V3 base = model.origin - origin;
  const auto corner = [&](std::size_t c) {
    const auto& at = model.blocks[slot / block_size].corners[c];
    const std::uint32_t lane = slot % block_size;
    return V3(base.x + model.step_m * static_cast<float>(at[0][lane]),
              base.y + model.step_m * static_cast<float>(at[1][lane]),
              base.z + model.step_m * static_cast<float>(at[2][lane]));
  };
  const V3 a = corner(0), e1 = corner(1) - a, e2 = corner(2) - a;
  const V3 p = direction.cross(e2);
  const float inverse = 1.0f / (e1.x * p.x + e1.y * p.y + e1.z * p.z);
  const V3 q = e1.cross(a);
  return {(e2.x * q.x + e2.y * q.y + e2.z * q.z) * inverse, -((a.x * p.x + a.y * p.y + a.z * p.z) * inverse),
          (direction.x * q.x + direction.y * q.y + direction.z * q.z) * inverse};
}

std::array<std::uint8_t, 2> packed_normal(const V3& normal) {
  const float sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  float u = normal.x / sum, v = normal.y / sum;
  if (normal.z < 0) {
    const float folded = (1 - std::abs(v)) * sign_of(u);
    v = (1 - std::abs(u)) * sign_of(v);
    u = folded;
  }
  const auto stored = [](float x) { return static_cast<std::uint8_t>(std::lround((x * 0.5f + 0.5f) * 254.0f)); };
  return {stored(u), stored(v)};
}

V3 unpacked_normal(const std::array<std::uint8_t, 2>& packed) {
  float u = static_cast<float>(packed[0]) / 127.0f - 1.0f, v = static_cast<float>(packed[1]) / 127.0f - 1.0f;
  const float z = 1 - std::abs(u) - std::abs(v);
  if (z < 0) {
    const float folded = (1 - std::abs(v)) * sign_of(u);
    v = (1 - std::abs(u)) * sign_of(v);
    u = folded;
  }
  return V3(u, v, z).normalized();
}

bool is_hole(const PlantModel& model, std::uint32_t slot, float u, float v) {
  const assets::Material& material = model.materials[model.slots[slot].material];
  if (material.alpha_cutoff <= 0 || material.texture == assets::no_texture) return false;
  const assets::Texture& texture = model.textures[static_cast<std::size_t>(material.texture)];
  if (!texture.has_alpha) return false;
  const V2 at = model.uv_of(slot, 0) * (1 - u - v) + model.uv_of(slot, 1) * u + model.uv_of(slot, 2) * v;
  const float x = (at.x - std::floor(at.x)) * static_cast<float>(texture.width) - 0.5f;
  const float y = (at.y - std::floor(at.y)) * static_cast<float>(texture.height) - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const float s = x - left, t = y - top;
  const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
  const auto alpha = [&](int i, int j) {
    const int column = i < 0 ? texture.width - 1 : i >= texture.width ? 0 : i;
    const int row = j < 0 ? texture.height - 1 : j >= texture.height ? 0 : j;
    const std::size_t pixel =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(texture.width) + static_cast<std::size_t>(column);
    return static_cast<float>(texture.rgba[pixel * 4 + 3]);
  };
  const float top_alpha = alpha(x0, y0) * (1 - s) + alpha(x0 + 1, y0) * s;
  const float bottom_alpha = alpha(x0, y0 + 1) * (1 - s) + alpha(x0 + 1, y0 + 1) * s;
  return top_alpha * (1 - t) + bottom_alpha * t < material.alpha_cutoff * 255.0f;
}

}  // namespace silvavis::scene
