#include "ghosttile/tile/frames.h"

#include <cmath>

#include "assets/grown/draws.h"
#include "silvasim/base/random.h"

namespace ghosttile::tile {

namespace {

using silvasim::base::Purpose;
using silvasim::base::Stream;

struct InDisc {
  float x, y, square;
};
InDisc in_disc(Stream& stream) {
  for (;;) {
    const float x = 2 * stream.next_float() - 1, y = 2 * stream.next_float() - 1, square = x * x + y * y;
    if (square > 1e-6f && square < 1) return {x, y, square};
  }
}

Rotation any_rotation(Stream& stream) {
  const InDisc a = in_disc(stream), b = in_disc(stream);
  const float rest = std::sqrt((1 - a.square) / b.square);
  return {a.x, a.y, b.x * rest, b.y * rest};
}

// First about z anyhow, then leaned over by an angle between the tilt's, to any side.
Rotation tilted(Stream& stream, const Tilt& tilt) {
  const InDisc side = in_disc(stream), turn = in_disc(stream);
  const float least = assets::grown::cosine(assets::grown::radians(tilt.least_deg)),
              most = assets::grown::cosine(assets::grown::radians(tilt.most_deg));
  const float cosine = std::fmin(1.0f, std::fmax(-1.0f, least + (most - least) * stream.next_float()));
  const float half_cosine = std::sqrt((1 + cosine) * 0.5f), half_sine = std::sqrt((1 - cosine) * 0.5f);
  const float to_side = half_sine / std::sqrt(side.square), to_turn = 1 / std::sqrt(turn.square);
  const float lean_x = side.x * to_side, lean_y = side.y * to_side, c = turn.x * to_turn, s = turn.y * to_turn;
  return {half_cosine * c, lean_x * c + lean_y * s, lean_y * c - lean_x * s, half_cosine * s};
}

const Tilt& choose(const std::vector<Tilt>& tilts, float chance) {
  float sum = 0;
  for (const Tilt& tilt : tilts) sum += tilt.share;
  float left = chance * sum;
  for (const Tilt& tilt : tilts) {
    left -= tilt.share;
    if (left < 0) return tilt;
  }
  return tilts.back();
}

}  // namespace

Candidate random_frame(std::uint64_t seed, std::uint16_t object, std::uint32_t index, const Spread& spread,
                       float side_m) {
  Stream stream(seed, Purpose::candidate, object, index);
  Candidate candidate;
  candidate.object = object;
  const float x = stream.next_float(), y = stream.next_float(), z = stream.next_float();
  candidate.at = V3(x, y, z) * side_m;
  candidate.scale = spread.least_scale + (spread.most_scale - spread.least_scale) * stream.next_float();
  candidate.rotation =
      spread.tilts.empty() ? any_rotation(stream) : tilted(stream, choose(spread.tilts, stream.next_float()));
  return candidate;
}

}  // namespace ghosttile::tile
