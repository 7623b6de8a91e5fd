#include "silvavis/scene/impostor.h"

namespace silvavis::scene {

namespace {

// At a diamond angle around the axis.
V3 direction_of(float sine, float angle) {
  const float part = angle - std::floor(angle);
  float x = 1 - part, y = part;
  const float length = std::sqrt(x * x + y * y), level = std::sqrt(std::max(0.0f, 1 - sine * sine));
  x *= level / length;
  y *= level / length;
  for (int turn = static_cast<int>(angle) & 3; turn > 0; --turn) {
    const float old = x;
    x = -y;
    y = old;
  }
  return {x, y, sine};
}

}  // namespace

V3 impostor_direction(int elevation, int side) {
  const float sine = (static_cast<float>(elevation) + 0.5f) * (2.0f / Impostor::elevations) - 1;
  return direction_of(sine, static_cast<float>(side) * (4.0f / Impostor::sides));
}

V3 lamp_direction(std::uint32_t lamp) {
  constexpr std::uint32_t bands = Impostor::lamp_bands;
  return direction_of((static_cast<float>(lamp % bands) + 0.5f) / Impostor::lamp_bands,
                      static_cast<float>(lamp / bands) * (4.0f / Impostor::lamp_azimuths));
}

}  // namespace silvavis::scene
