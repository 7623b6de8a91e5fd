#include "silvavis/commands/overhead.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "silvavis/commands/stage.h"
#include "silvavis/shade/surface.h"

namespace silvavis::commands {

namespace {

// What land throws back as a whole, seen from aslant under a sun half up the sky, from all sides: with the shade that plants cast on
// themselves and on the ground, in rays that are spread evenly (Roberts 2018).
class Overhead {
 public:
  Overhead(const scene::Scene& scene, const accel::Tracer& tracer, const shade::Land& land)
      : scene_(scene), tracer_(tracer), land_(land), top_m_(scene_box(scene).greatest_z_m + 10) {}

  struct Seen {
    Rgb colour{0, 0, 0};  // as an albedo
    bool land = false;    // no: nothing is seen, or water
  };
  std::vector<Seen> at(const std::vector<silvasim::base::Point>& places) const {
    constexpr float from_sun = 0.85f, from_sky = 0.15f;  // of the light on level land
    constexpr float half_up = 0.70710678f;
    const auto share = [](std::size_t i, double step) {
      const double x = step * static_cast<double>(i);
      return static_cast<float>(x - std::floor(x));
    };
    const auto direction = [](float turn, float sine) {
      const float angle = 2 * std::numbers::pi_v<float> * turn, level = std::sqrt(std::max(0.0f, 1 - sine * sine));
      return V3(std::cos(angle) * level, std::sin(angle) * level, sine);
    };
    std::vector<accel::Ray> rays(places.size()), to_sun, to_sky;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const V3 up = direction(share(i, 0.7548777), half_up);
      const double ground_m = scene::ground_at(scene_.ground, places[i].x, places[i].y).height_m;
      rays[i].origin =
          V3d(places[i].x, places[i].y, ground_m) + V3d(up) * ((top_m_ - ground_m) / static_cast<double>(half_up));
      rays[i].direction = -up;
    }
    std::vector<accel::Hit> hits(rays.size());
    tracer_.nearest(rays, hits);
    std::vector<Seen> seen(rays.size());
    std::vector<Rgb> by_sun, by_sky;
    std::vector<std::size_t> askers;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].surface == accel::Surface::none) continue;
      const shade::SurfacePoint point = shade::surface_at(scene_, land_, rays[i], hits[i]);
      if (point.water) continue;
      seen[i].land = true;
      const auto ask = [&](const V3& towards, float light, std::vector<accel::Ray>& asked, std::vector<Rgb>& shares) {
        accel::Ray ray;
        const bool open = shade::ray_from(point, hits[i], towards, 0.01, ray);
        const float facing = point.normal.dot(towards);
        const Rgb& part = facing > 0 ? point.reflectance : point.transmittance;
        asked.push_back(ray);
        shares.push_back(open ? part * (light * std::abs(facing)) : Rgb(0, 0, 0));
      };
      ask(direction(share(i, 0.5698403), half_up), from_sun / half_up, to_sun, by_sun);
      // Evenly over the upper half of all directions: 1 / (2 pi) for each, of a light of 1 / pi.
      ask(direction(share(i, 0.8191725), share(i, 0.6710436)), 2 * from_sky, to_sky, by_sky);
      askers.push_back(i);
    }
    const auto add = [&](const std::vector<accel::Ray>& asked, const std::vector<Rgb>& shares) {
      std::vector<std::uint8_t> shaded(asked.size());
      tracer_.occluded(asked, shaded);
      for (std::size_t k = 0; k < askers.size(); ++k)
        if (!shaded[k]) seen[askers[k]].colour += shares[k];
    };
    add(to_sun, by_sun);
    add(to_sky, by_sky);
    return seen;
  }

  // Their mean, or `otherwise` where none shows land.
  static Rgb mean(std::span<const Seen> seen, const Rgb& otherwise) {
    Rgb sum(0, 0, 0);
    float count = 0;
    for (const Seen& one : seen) {
      sum += one.colour;
      count += one.land ? 1.0f : 0.0f;
    }
    if (count <= 0) return otherwise;
    sum /= count;
    return Rgb(std::clamp(sum.x, 0.0f, 1.0f), std::clamp(sum.y, 0.0f, 1.0f), std::clamp(sum.z, 0.0f, 1.0f));
  }

 private:
  const scene::Scene& scene_;
  const accel::Tracer& tracer_;
  const shade::Land& land_;
  double top_m_;
};

// On an even grid, for the light that the land sends back to the sky.
Rgb albedo_from_above(const Overhead& overhead, const silvasim::base::Box& box, const Rgb& otherwise) {
  constexpr int side = 48;
  std::vector<silvasim::base::Point> places;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      places.push_back({box.west + (column + 0.5) * box.width() / side, box.south + (row + 0.5) * box.height() / side});
  return Overhead::mean(overhead.at(places), otherwise);
}

// Along the planted border, in as many parts as the land around has: each from an even pattern (Roberts 2018) over a strip.
std::vector<Rgb> border_colours(const Overhead& overhead, const silvasim::base::Box& box, const Rgb& otherwise) {
  constexpr int parts = shade::Surroundings::parts, a_part = 40;
  constexpr double depth = 0.05;  // of the side
  std::vector<silvasim::base::Point> places;
  for (int i = 0; i < 4 * parts; ++i) {
    for (int k = 0; k < a_part; ++k) {
      const double along = (i % parts + (k + 0.5) / a_part) / parts;
      const double in = depth * (0.618034 * k - std::floor(0.618034 * k));
      const int side = i / parts;
      const double u = side == 0 ? along : side == 1 ? 1 - in : side == 2 ? 1 - along : in;
      const double v = side == 0 ? in : side == 1 ? along : side == 2 ? 1 - in : 1 - along;
      places.push_back({box.west + u * box.width(), box.south + v * box.height()});
    }
  }
  const std::vector<Overhead::Seen> seen = overhead.at(places);
  std::vector<Rgb> colours;
  for (std::size_t i = 0; i < seen.size(); i += a_part)
    colours.push_back(Overhead::mean(std::span(seen).subspan(i, a_part), otherwise));
  return colours;
}

}  // namespace

OverheadColours colours_from_above(const scene::Scene& scene, const accel::Tracer& tracer, const shade::Land& land,
                                   const Rgb& otherwise, bool border) {
  const Overhead overhead(scene, tracer, land);
  OverheadColours colours;
  colours.albedo = albedo_from_above(overhead, scene.extent, otherwise);
  if (border) colours.border = border_colours(overhead, scene.extent, colours.albedo);
  return colours;
}

}  // namespace silvavis::commands
