#include "silvavis/scene/plant_model.h"

#include <algorithm>
#include <cmath>

namespace silvavis::scene {

namespace {

float sign_of(float x) { return x < 0 ? -1.0f : 1.0f; }

Cutout cutout_of(const assets::Material& material, const std::vector<assets::Texture>& textures) {
  Cutout cutout;
  cutout.two_sided = material.two_sided;
  if (material.alpha_cutoff <= 0 || material.texture == assets::no_texture) return cutout;
  const assets::Texture& texture = textures[static_cast<std::size_t>(material.texture)];
  if (!texture.has_alpha) return cutout;
  cutout.width = static_cast<std::uint32_t>(2 * texture.width);
  cutout.height = static_cast<std::uint32_t>(2 * texture.height);
  cutout.holes.assign((std::size_t{cutout.width} * cutout.height + 63) / 64, 0);
  const auto alpha = [&](int i, int j) {
    const int column = (i + texture.width) % texture.width, row = (j + texture.height) % texture.height;
    return static_cast<float>(texture.rgba[(static_cast<std::size_t>(row) * static_cast<std::size_t>(texture.width) +
                                            static_cast<std::size_t>(column)) *
                                               4 +
                                           3]);
  };
  for (std::uint32_t y = 0; y < cutout.height; ++y) {
    for (std::uint32_t x = 0; x < cutout.width; ++x) {
      // Centres of the finer cells lie a quarter off the texels': bilinear weights 3/4 and 1/4.
      const int i = static_cast<int>(x / 2), j = static_cast<int>(y / 2);
      const int di = x % 2 == 0 ? -1 : 1, dj = y % 2 == 0 ? -1 : 1;
      const float value = (9 * alpha(i, j) + 3 * alpha(i + di, j) + 3 * alpha(i, j + dj) + alpha(i + di, j + dj)) / 16;
      const std::uint64_t bit = std::uint64_t{y} * cutout.width + x;
      if (value < material.alpha_cutoff * 255.0f) cutout.holes[bit >> 6] |= std::uint64_t{1} << (bit & 63);
    }
  }
  return cutout;
}

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

std::size_t Looks::bytes() const {
  std::size_t sum = 0;
  for (const assets::Texture& texture : textures) sum += texture.rgba.size();
  for (const Cutout& cutout : cutouts) sum += cutout.holes.size() * sizeof(std::uint64_t);
  return sum;
}

std::shared_ptr<const Looks> looks_of(const assets::Model& model) {
  auto looks = std::make_shared<Looks>();
  looks->materials = model.materials;
  looks->textures = model.textures;
  for (const assets::Material& material : model.materials)
    looks->cutouts.push_back(cutout_of(material, model.textures));
  return looks;
}

}  // namespace silvavis::scene
