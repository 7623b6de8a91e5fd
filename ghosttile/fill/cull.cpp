#include "ghosttile/fill/cull.h"

#include <algorithm>

namespace ghosttile::fill {

namespace {

using density::block_size;

// Calls use(first, values) for stretches of the points (x, y, z) + offset, in order.
template <typename Use>
void evaluate_points(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z,
                     std::size_t stretch, const density::Compiled& density, const V3& offset, CullScratch& scratch,
                     const Use& use) {
  scratch.x.resize(block_size);
  scratch.y.resize(block_size);
  scratch.z.resize(block_size);
  scratch.value.resize(block_size);
  for (std::size_t first = 0; first < x.size(); first += stretch) {
    const std::size_t count = std::min(stretch, x.size() - first);
    for (std::size_t p = 0; p < count; ++p) {
      scratch.x[p] = x[first + p] + offset.x;
      scratch.y[p] = y[first + p] + offset.y;
      scratch.z[p] = z[first + p] + offset.z;
    }
    density.evaluate({scratch.x.data(), scratch.y.data(), scratch.z.data(), count}, scratch.fields,
                     scratch.value.data());
    use(first, count, scratch.value.data());
  }
}

}  // namespace

std::vector<ObjectColumns> object_columns(const tile::GhostTile& tile) {
  std::vector<ObjectColumns> columns(tile.objects.size());
  for (std::size_t o = 0; o < tile.objects.size(); ++o) columns[o].anchors = tile.objects[o].anchors.size();
  for (std::size_t c = 0; c < tile.candidates.size(); ++c) {
    const tile::Candidate& candidate = tile.candidates[c];
    ObjectColumns& of = columns[candidate.object];
    of.candidates.push_back(static_cast<std::uint16_t>(c));
    of.at_x.push_back(candidate.at.x);
    of.at_y.push_back(candidate.at.y);
    of.at_z.push_back(candidate.at.z);
    of.z_axis.push_back(candidate.rotation.z_axis());
    of.scale.push_back(candidate.scale);
    for (const V3& anchor : tile.objects[candidate.object].anchors) {
      const V3 at = candidate(anchor);
      of.x.push_back(at.x);
      of.y.push_back(at.y);
      of.z.push_back(at.z);
    }
  }
  return columns;
}

void densities_at(const ObjectColumns& columns, const density::Compiled& density, const V3& offset,
                  CullScratch& scratch, float* least, float* most) {
  if (density.constant()) {
    std::fill_n(least, columns.candidates.size(), density.range.least);
    std::fill_n(most, columns.candidates.size(), density.range.least);
    return;
  }
  const std::size_t anchors = columns.anchors, stretch = std::max<std::size_t>(1, block_size / anchors) * anchors;
  evaluate_points(columns.x, columns.y, columns.z, stretch, density, offset, scratch,
                  [&](std::size_t first, std::size_t count, const float* value) {
                    float* low = least + first / anchors;
                    float* high = most + first / anchors;
                    for (std::size_t c = 0; c < count / anchors; ++c) {
                      low[c] = high[c] = value[c * anchors];
                      for (std::size_t a = 1; a < anchors; ++a) {
                        low[c] = std::min(low[c], value[c * anchors + a]);
                        high[c] = std::max(high[c], value[c * anchors + a]);
                      }
                    }
                  });
}

void values_at_origins(const ObjectColumns& columns, const density::Compiled& field, const V3& offset,
                       CullScratch& scratch, float* value) {
  if (field.constant()) {
    std::fill_n(value, columns.candidates.size(), field.range.least);
    return;
  }
  evaluate_points(
      columns.at_x, columns.at_y, columns.at_z, block_size, field, offset, scratch,
      [&](std::size_t first, std::size_t count, const float* values) { std::copy_n(values, count, value + first); });
}

void cosines_at(const ObjectColumns& columns, const density::Direction& direction, const density::Compiled& density,
                const V3d& corner, const V3& offset, CullScratch& scratch, float* cosine) {
  scratch.x.resize(block_size);
  scratch.y.resize(block_size);
  scratch.z.resize(block_size);
  scratch.directions.resize(block_size);
  for (std::size_t first = 0; first < columns.candidates.size(); first += block_size) {
    const std::size_t count = std::min(block_size, columns.candidates.size() - first);
    for (std::size_t c = 0; c < count; ++c) {
      scratch.x[c] = columns.at_x[first + c] + offset.x;
      scratch.y[c] = columns.at_y[first + c] + offset.y;
      scratch.z[c] = columns.at_z[first + c] + offset.z;
    }
    density::directions_at(direction, corner, {scratch.x.data(), scratch.y.data(), scratch.z.data(), count}, density,
                           scratch.fields, scratch.directions.data());
    for (std::size_t c = 0; c < count; ++c) {
      const V3& towards = scratch.directions[c];
      const bool none = towards.x == 0 && towards.y == 0 && towards.z == 0;
      cosine[first + c] = none ? -2.0f : towards.dot(columns.z_axis[first + c]);
    }
  }
}

}  // namespace ghosttile::fill
