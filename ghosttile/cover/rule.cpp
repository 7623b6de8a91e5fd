#include "ghosttile/cover/rule.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace ghosttile::cover {

namespace {

float joined(Combine combine, float a, float b) {
  switch (combine) {
    case Combine::product:
      return a * b;
    case Combine::least:
      return std::min(a, b);
    case Combine::greatest:
      break;
  }
  return std::max(a, b);
}

void answer(const Factor& factor, const V3d& origin, const float* x, const float* y, std::size_t count, float* value) {
  if (factor.rule) {
    factor.rule->sample(origin, x, y, count, value);
    return;
  }
  std::array<float, density::block_size> asked;
  factor.source->sample(origin, x, y, count, asked.data());
  const float otherwise = factor.source->without_data();
  if (!factor.response) {
    for (std::size_t i = 0; i < count; ++i) {
      const float cut = asked[i] < 0 ? 0 : asked[i] > 1 ? 1 : asked[i];
      value[i] = asked[i] != asked[i] ? otherwise : cut;
    }
    return;
  }
  // Responses know no NaN.
  std::array<std::uint32_t, density::block_size> missing;
  std::uint32_t any = 0;
  for (std::size_t i = 0; i < count; ++i) {
    missing[i] = asked[i] != asked[i] ? 1 : 0;
    asked[i] = asked[i] != asked[i] ? 0 : asked[i];
    any |= missing[i];
  }
  factor.response->apply(asked.data(), value, count);
  if (any == 0) return;
  for (std::size_t i = 0; i < count; ++i) value[i] = missing[i] != 0 ? otherwise : value[i];
}

Range answer_range(const Factor& factor, const silvasim::base::Box& box) {
  if (factor.rule) return factor.rule->bounds(box.west, box.south, box.east, box.north);
  const SourceRange asked = factor.source->range(box);
  const float otherwise = factor.source->without_data();
  if (asked.known.least > asked.known.most) return {otherwise, otherwise};
  Range range{std::clamp(asked.known.least, 0.0f, 1.0f), std::clamp(asked.known.most, 0.0f, 1.0f)};
  if (factor.response) range = factor.response_range->of(*factor.response, asked.known);
  if (!asked.missing) return range;
  return {std::min(range.least, otherwise), std::max(range.most, otherwise)};
}

}  // namespace

void Rule::sample(const V3d& origin, const float* x, const float* y, std::size_t count, float* value) const {
  std::array<float, density::block_size> next;
  for (std::size_t done = 0; done < count; done += density::block_size) {
    const std::size_t some = std::min(count - done, density::block_size);
    float* const result = value + done;
    answer(factors_[0], origin, x + done, y + done, some, result);
    for (std::size_t f = 1; f < factors_.size(); ++f) {
      if (combine_ != Combine::greatest && std::all_of(result, result + some, [](float v) { return v == 0; })) break;
      answer(factors_[f], origin, x + done, y + done, some, next.data());
      for (std::size_t i = 0; i < some; ++i) result[i] = joined(combine_, result[i], next[i]);
    }
  }
}

Range Rule::bounds(double west, double south, double east, double north) const {
  const silvasim::base::Box box{west, south, east, north};
  Range all = answer_range(factors_[0], box);
  for (std::size_t f = 1; f < factors_.size(); ++f) {
    if (combine_ != Combine::greatest && all.most == 0) break;
    const Range next = answer_range(factors_[f], box);
    all = {joined(combine_, all.least, next.least), joined(combine_, all.most, next.most)};
  }
  return all;
}

}  // namespace ghosttile::cover
