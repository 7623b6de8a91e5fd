#include "ghosttile/density/kernels.h"

#include <cmath>

#include "silvasim/base/vector_clones.h"

namespace ghosttile::density {

namespace {

inline float above_zero(float x) { return x > 0 ? x : 0; }
inline float outside(float x, float low, float high) { return above_zero(x - high) + above_zero(low - x); }

// (1 - t^2)^3 by Wyvill, McPheeters and Wyvill 1986. What is not a number becomes 0.
inline float wyvill(float t_squared) {
  const float v = 1 - (t_squared < 1 ? t_squared : 1);
  return v * v * v;
}

// All bits of a cell's number and a key mixed ("lowbias32", found by Wellons 2018).
inline std::uint32_t mixed(std::uint32_t h) {
  h = (h ^ (h >> 16)) * 0x7FEB352Du;
  h = (h ^ (h >> 15)) * 0x846CA68Bu;
  return h ^ (h >> 16);
}
constexpr std::uint32_t step_x = 0x8DA6B343u, step_y = 0xD8163841u, step_z = 0xCB1AB31Fu;

// Ten bits as a number in [-1, 1].
inline float signed_share(std::uint32_t bits) {
  return static_cast<float>(static_cast<std::int32_t>(bits & 1023u)) * (2.0f / 1023) - 1;
}

inline std::int32_t cell_of(float x) {
  const std::int32_t cell = static_cast<std::int32_t>(x);
  return cell - static_cast<std::int32_t>(x < static_cast<float>(cell));
}

inline float fade(float s) { return s * s * s * (s * (s * 6 - 15) + 10); }
inline float mix(float a, float b, float s) { return a + (b - a) * s; }

}  // namespace

SILVA_VECTOR_CLONES void point_squares(const Points& at, const Parameters& p, float* __restrict result) {
  const float *x = at.x, *y = at.y, *z = at.z;
  const float cx = p[0], cy = p[1], cz = p[2];
  for (std::size_t i = 0; i < at.count; ++i) {
    const float dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
    result[i] = dx * dx + dy * dy + dz * dz;
  }
}

SILVA_VECTOR_CLONES void sphere_squares(const Points& at, const Parameters& p, float* __restrict result) {
  const float *x = at.x, *y = at.y, *z = at.z;
  const float cx = p[0], cy = p[1], cz = p[2], radius = p[3];
  for (std::size_t i = 0; i < at.count; ++i) {
    const float dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
    const float d = above_zero(std::sqrt(dx * dx + dy * dy + dz * dz) - radius);
    result[i] = d * d;
  }
}

SILVA_VECTOR_CLONES void line_squares(const Points& at, const Parameters& p, float* __restrict result) {
  const float *x = at.x, *y = at.y, *z = at.z;
  const float cx = p[0], cy = p[1], cz = p[2], ax = p[3], ay = p[4], az = p[5], low = p[6], high = p[7];
  for (std::size_t i = 0; i < at.count; ++i) {
    const float dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
    const float u = dx * ax + dy * ay + dz * az;
    const float ox = dx - u * ax, oy = dy - u * ay, oz = dz - u * az, along = outside(u, low, high);
    result[i] = ox * ox + oy * oy + oz * oz + along * along;
  }
}

SILVA_VECTOR_CLONES void cylinder_squares(const Points& at, const Parameters& p, float* __restrict result) {
  const float *x = at.x, *y = at.y, *z = at.z;
  const float cx = p[0], cy = p[1], cz = p[2], ax = p[3], ay = p[4], az = p[5], low = p[6], high = p[7], radius = p[8];
  for (std::size_t i = 0; i < at.count; ++i) {
    const float dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
    const float u = dx * ax + dy * ay + dz * az;
    const float ox = dx - u * ax, oy = dy - u * ay, oz = dz - u * az, along = outside(u, low, high);
    const float across = above_zero(std::sqrt(ox * ox + oy * oy + oz * oz) - radius);
    result[i] = across * across + along * along;
  }
}

SILVA_VECTOR_CLONES void disc_squares(const Points& at, const Parameters& p, float* __restrict result) {
  const float *x = at.x, *y = at.y, *z = at.z;
  const float cx = p[0], cy = p[1], cz = p[2], ax = p[3], ay = p[4], az = p[5], radius = p[6];
  for (std::size_t i = 0; i < at.count; ++i) {
    const float dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
    const float h = dx * ax + dy * ay + dz * az;
    const float ox = dx - h * ax, oy = dy - h * ay, oz = dz - h * az;
    const float across = above_zero(std::sqrt(ox * ox + oy * oy + oz * oz) - radius);
    result[i] = across * across + h * h;
  }
}

SILVA_VECTOR_CLONES void box_squares(const Points& at, const Parameters& p, float* __restrict result) {
  const float *x = at.x, *y = at.y, *z = at.z;
  const float cx = p[0], cy = p[1], cz = p[2], cosine = p[3], sine = p[4], hx = p[5], hy = p[6], hz = p[7];
  for (std::size_t i = 0; i < at.count; ++i) {
    const float qx = x[i] - cx, qy = y[i] - cy, qz = z[i] - cz;
    const float dx = above_zero(std::abs(qx * cosine + qy * sine) - hx);
    const float dy = above_zero(std::abs(qy * cosine - qx * sine) - hy);
    const float dz = above_zero(std::abs(qz) - hz);
    result[i] = dx * dx + dy * dy + dz * dz;
  }
}

SILVA_VECTOR_CLONES void layer_squares(const Points& at, const float* plane, double corner_z_m, const Parameters& p,
                                       float* __restrict result) {
  const float* z = at.z;
  const float middle = p[1], half = p[2];
  for (std::size_t i = 0; i < at.count; ++i) {
    const float over = z[i] + static_cast<float>(corner_z_m - static_cast<double>(plane[i]));
    const float d = above_zero(std::abs(over - middle) - half);
    result[i] = d * d;
  }
}

SILVA_VECTOR_CLONES void values_above(const Points& at, const float* plane, double corner_z_m, float from_m,
                                      float* __restrict result) {
  const float* z = at.z;
  for (std::size_t i = 0; i < at.count; ++i) {
    const float over = z[i] + static_cast<float>(corner_z_m - static_cast<double>(plane[i]));
    result[i] = over >= from_m ? 1.0f : 0.0f;
  }
}

SILVA_VECTOR_CLONES void values_of_plane(const float* plane, std::size_t count, float* __restrict result) {
  for (std::size_t i = 0; i < count; ++i) result[i] = above_zero(plane[i]);
}

SILVA_VECTOR_CLONES void smooth_falloff(float per_square, std::size_t count, float* column) {
  for (std::size_t i = 0; i < count; ++i) column[i] = wyvill(column[i] * per_square);
}

SILVA_VECTOR_CLONES void cored_falloff(float per_metre, float core, std::size_t count, float* column) {
  for (std::size_t i = 0; i < count; ++i) {
    const float t = above_zero(std::sqrt(column[i]) * per_metre - core);
    column[i] = wyvill(t * t);
  }
}

SILVA_VECTOR_CLONES void sharp_falloff(float square, std::size_t count, float* column) {
  for (std::size_t i = 0; i < count; ++i) column[i] = column[i] <= square ? 1.0f : 0.0f;
}

SILVA_VECTOR_CLONES void add(const float* other, std::size_t count, float* __restrict column) {
  for (std::size_t i = 0; i < count; ++i) column[i] += other[i];
}

SILVA_VECTOR_CLONES void keep_greatest(const float* other, std::size_t count, float* __restrict column) {
  for (std::size_t i = 0; i < count; ++i) column[i] = other[i] > column[i] ? other[i] : column[i];
}

SILVA_VECTOR_CLONES void keep_least(const float* other, std::size_t count, float* __restrict column) {
  for (std::size_t i = 0; i < count; ++i) column[i] = other[i] < column[i] ? other[i] : column[i];
}

SILVA_VECTOR_CLONES void take_away(const float* other, std::size_t count, float* __restrict column) {
  for (std::size_t i = 0; i < count; ++i) {
    const float left = 1 - other[i];
    column[i] = above_zero(left < column[i] ? left : column[i]);
  }
}

SILVA_VECTOR_CLONES void multiply(const float* other, std::size_t count, float* __restrict column) {
  for (std::size_t i = 0; i < count; ++i) column[i] *= other[i];
}

SILVA_VECTOR_CLONES void cap(std::size_t count, float* column) {
  for (std::size_t i = 0; i < count; ++i) column[i] = column[i] < 1 ? column[i] : 1;
}

SILVA_VECTOR_CLONES void multiply(float by, std::size_t count, float* column) {
  for (std::size_t i = 0; i < count; ++i) column[i] *= by;
}

SILVA_VECTOR_CLONES void moved_places(const Points& at, const Noise& noise, float* __restrict x, float* __restrict y,
                                      float* __restrict z) {
  const std::uint32_t base = noise.key + noise.cell[0] * step_x + noise.cell[1] * step_y + noise.cell[2] * step_z;
  const float wx = noise.within[0], wy = noise.within[1], wz = noise.within[2];
  const float per_metre = noise.per_metre, far_m = noise.far_m;
  const float *px = at.x, *py = at.y, *pz = at.z;
  for (std::size_t i = 0; i < at.count; ++i) {
    const float u = px[i] * per_metre + wx, v = py[i] * per_metre + wy, w = pz[i] * per_metre + wz;
    const std::int32_t cu = cell_of(u), cv = cell_of(v), cw = cell_of(w);
    const float su = fade(u - static_cast<float>(cu)), sv = fade(v - static_cast<float>(cv)),
                sw = fade(w - static_cast<float>(cw));
    const std::uint32_t h = base + static_cast<std::uint32_t>(cu) * step_x + static_cast<std::uint32_t>(cv) * step_y +
                            static_cast<std::uint32_t>(cw) * step_z;
    const std::uint32_t a = mixed(h), b = mixed(h + step_x), c = mixed(h + step_y), d = mixed(h + step_x + step_y);
    const std::uint32_t e = mixed(h + step_z), f = mixed(h + step_x + step_z), g = mixed(h + step_y + step_z),
                        k = mixed(h + step_x + step_y + step_z);
    const auto blended = [&](int shift) {
      const float low = mix(mix(signed_share(a >> shift), signed_share(b >> shift), su),
                            mix(signed_share(c >> shift), signed_share(d >> shift), su), sv);
      const float high = mix(mix(signed_share(e >> shift), signed_share(f >> shift), su),
                             mix(signed_share(g >> shift), signed_share(k >> shift), su), sv);
      return mix(low, high, sw);
    };
    x[i] = px[i] + far_m * blended(0);
    y[i] = py[i] + far_m * blended(10);
    z[i] = pz[i] + far_m * blended(20);
  }
}

}  // namespace ghosttile::density
