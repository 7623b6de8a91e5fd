#include "silvavis/shade/overhead.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "silvasim/base/parallel.h"
#include "silvavis/shade/surface.h"

namespace silvavis::shade {

namespace {

using silvasim::base::Point;

constexpr double lift_m = 0.01;

// A place of an even pattern in [0, 1): of the numbers that fill the unit square, cube ... best (Roberts 2018).
float even(std::size_t i, double step) {
  const double x = step * static_cast<double>(i) + 0.5;
  return static_cast<float>(x - std::floor(x));
}

V3 direction_of(float turn, float sine) {
  const float angle = 2 * pi * turn, level = std::sqrt(std::max(0.0f, 1 - sine * sine));
  return V3(std::cos(angle) * level, std::sin(angle) * level, sine);
}

// What one of many rays meets.
struct Met {
  accel::Hit hit;
  SurfacePoint point;
  bool land = false;  // no: nothing is met, or water
};

std::vector<Met> met_by(const Overhead& o, const std::vector<accel::Ray>& rays) {
  std::vector<accel::Hit> hits(rays.size());
  o.tracer.nearest(rays, hits);
  std::vector<Met> met(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].surface == accel::Surface::none) continue;
    met[i].hit = hits[i];
    met[i].point = surface_at(o.scene, o.land, rays[i], hits[i]);
    met[i].land = !met[i].point.water;
  }
  return met;
}

// From above all that stands there down to places, from the side of `up`, by rays of that width.
std::vector<accel::Ray> rays_down(const Overhead& o, std::span<const Point> places, const auto& up, float width_m) {
  std::vector<accel::Ray> rays(places.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const V3 from = up(i);
    const double ground_m = scene::ground_at(o.scene.ground, places[i].x, places[i].y).height_m;
    rays[i].origin =
        V3d(places[i].x, places[i].y, ground_m) + V3d(from) * ((o.top_m - ground_m) / static_cast<double>(from.z));
    rays[i].direction = -from;
    rays[i].width_m = width_m;
  }
  return rays;
}

// Asks for each met point whether light from a direction comes to it; gives shares * facing, 0 where it is barred.
class Lamps {
 public:
  explicit Lamps(const Overhead& o) : o_(o) {}
  void ask(std::size_t asker, const Met& met, const V3& towards, const Rgb& light, float width_m) {
    const float facing = met.point.normal.dot(towards);
    const Rgb& part = facing > 0 ? met.point.reflectance : met.point.transmittance;
    accel::Ray ray;
    const bool open = ray_from(met.point, met.hit, towards, lift_m, ray);
    ray.width_m = width_m;
    rays_.push_back(ray);
    shares_.push_back(open ? part * light * std::abs(facing) : Rgb(0, 0, 0));
    askers_.push_back(asker);
  }
  void add_to(std::vector<Rgb>& sums) const {
    std::vector<std::uint8_t> barred(rays_.size());
    o_.tracer.occluded(rays_, barred);
    for (std::size_t k = 0; k < rays_.size(); ++k)
      if (!barred[k]) sums[askers_[k]] += shares_[k];
  }

 private:
  const Overhead& o_;
  std::vector<accel::Ray> rays_;
  std::vector<Rgb> shares_;
  std::vector<std::size_t> askers_;
};

struct Seen {
  Rgb colour{0, 0, 0};  // as an albedo
  bool land = false;
};

// From aslant under a sun half up the sky, from all sides.
std::vector<Seen> seen_at(const Overhead& o, std::span<const Point> places) {
  constexpr float from_sun = 0.85f, from_sky = 0.15f;  // of the light on level land
  constexpr float half_up = 0.70710678f;
  const auto rays = rays_down(
      o, places, [](std::size_t i) { return direction_of(even(i, 0.7548777), half_up); }, 0);
  const std::vector<Met> met = met_by(o, rays);
  std::vector<Rgb> colours(met.size(), Rgb(0, 0, 0));
  Lamps lamps(o);
  for (std::size_t i = 0; i < met.size(); ++i) {
    if (!met[i].land) continue;
    lamps.ask(i, met[i], direction_of(even(i, 0.5698403), half_up), Rgb(from_sun / half_up), 0);
    // Evenly over the upper half of all directions: 1 / (2 pi) for each, of a light of 1 / pi.
    lamps.ask(i, met[i], direction_of(even(i, 0.8191725), even(i, 0.6710436)), Rgb(2 * from_sky), 0);
  }
  lamps.add_to(colours);
  std::vector<Seen> seen(met.size());
  for (std::size_t i = 0; i < met.size(); ++i) seen[i] = {colours[i], met[i].land};
  return seen;
}

Rgb mean_of(std::span<const Seen> seen, const Rgb& otherwise) {
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

// Cells of an even grid whose ground is no steeper than what may lie around a scene; all, where few are.
// `rim`: so many rows along the border are left out.
std::vector<Point> gentle_places(const Overhead& o, int side, int rim) {
  constexpr double steep = 0.3;
  const silvasim::base::Box& box = o.scene.extent;
  std::vector<Point> all, gentle;
  for (int row = rim; row < side - rim; ++row) {
    for (int column = rim; column < side - rim; ++column) {
      const Point at{box.west + (column + 0.5) * box.width() / side, box.south + (row + 0.5) * box.height() / side};
      all.push_back(at);
      const V3 up = scene::ground_normal(o.scene.ground, at.x, at.y);
      if (static_cast<double>(up.z) * std::sqrt(1 + steep * steep) >= 1) gentle.push_back(at);
    }
  }
  return gentle.size() * 5 >= all.size() ? gentle : all;
}

}  // namespace

Rgb albedo_from_above(const Overhead& overhead, const Rgb& otherwise) {
  constexpr int side = 48;
  const silvasim::base::Box& box = overhead.scene.extent;
  std::vector<Point> places;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      places.push_back({box.west + (column + 0.5) * box.width() / side, box.south + (row + 0.5) * box.height() / side});
  return mean_of(seen_at(overhead, places), otherwise);
}

std::vector<Rgb> border_colours(const Overhead& overhead, const Rgb& otherwise) {
  constexpr int parts = Surroundings::parts, a_part = 40;
  constexpr double depth = 0.05;  // of the side
  const silvasim::base::Box& box = overhead.scene.extent;
  std::vector<Point> places;
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
  const std::vector<Seen> seen = seen_at(overhead, places);
  std::vector<Rgb> colours;
  for (std::size_t i = 0; i < seen.size(); i += a_part)
    colours.push_back(mean_of(std::span(seen).subspan(i, a_part), otherwise));
  return colours;
}

std::vector<Rgb> usual_colours(const Overhead& overhead, const Rgb& otherwise) {
  constexpr int side = 40;
  constexpr std::size_t a_place = 24;
  const silvasim::base::Box& box = overhead.scene.extent;
  const double width = box.width() / side, height = box.height() / side;
  const std::vector<Point> cells = gentle_places(overhead, side, 0);
  std::vector<Point> places;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t k = 0; k < a_place; ++k) {
      places.push_back({cells[i].x + (static_cast<double>(even(i * a_place + k, 0.3819660)) - 0.5) * width,
                        cells[i].y + (static_cast<double>(even(k, 1.0 / a_place)) - 0.5) * height});
    }
  }
  const std::vector<Seen> seen = seen_at(overhead, places);
  std::vector<Rgb> colours;
  double within = 0;  // variance of a cell's mean, by what its rays differ
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto cell = std::span(seen).subspan(i * a_place, a_place);
    if (!std::all_of(cell.begin(), cell.end(), [](const Seen& one) { return one.land; })) continue;
    colours.push_back(mean_of(cell, otherwise));
    const auto mean = static_cast<double>(luminance(colours.back()));
    for (const Seen& one : cell) {
      const double away = static_cast<double>(luminance(one.colour)) - mean;
      within += away * away / (a_place * (a_place - 1));
    }
  }
  constexpr std::size_t shades = Surroundings::shades;
  std::vector<Rgb> usual(shades, otherwise);
  if (colours.size() < shades) return usual;
  std::stable_sort(colours.begin(), colours.end(),
                   [](const Rgb& a, const Rgb& b) { return luminance(a) < luminance(b); });
  for (std::size_t i = 0; i < shades; ++i) {
    const std::size_t from = i * colours.size() / shades, to = (i + 1) * colours.size() / shades;
    Rgb sum(0, 0, 0);
    for (std::size_t k = from; k < to; ++k) sum += colours[k];
    usual[i] = sum / static_cast<float>(to - from);
  }
  // Few rays make cells differ that are alike: their colours come closer to the mean by that share of the variance (Efron and Morris 1975).
  Rgb mean(0, 0, 0);
  for (const Rgb& colour : colours) mean += colour / static_cast<float>(colours.size());
  double between = 0;
  for (const Rgb& colour : colours) {
    const double away = static_cast<double>(luminance(colour) - luminance(mean));
    between += away * away;
  }
  const auto real = static_cast<float>(std::sqrt(std::max(0.0, 1 - within / std::max(between, 1e-12))));
  for (Rgb& colour : usual) colour = mean + (colour - mean) * real;
  return usual;
}

SentBack sent_back(const Overhead& overhead, const Sky& sky, const Rgb& albedo) {
  constexpr std::size_t a_view = 512, count = Views::sides * Views::heights;
  constexpr float width_m = 0;  // full models: the same light with and without levels of detail
  const std::vector<Point> gentle = gentle_places(overhead, 64, 12);  // woods' edges have more light
  const V3& sun = sky.sun_direction();
  const bool day = luminance(sky.sun_irradiance()) > 0;
  struct View {
    Rgb light{0, 0, 0}, closed{0, 0, 0}, near{0, 0, 0}, near_closed{0, 0, 0};
    float land = 0, met_near = 0;  // numbers; the second weighted by how much light each stands for
  };
  std::array<View, count> views;
  // Sun and sky on all that was met, of a light of 1 / pi; and which ray to the sky is barred, and how much light it stands for.
  struct Lit {
    std::vector<Rgb> light, closed;
    std::vector<accel::Ray> barred;
    std::vector<float> weights;  // of those
  };
  const auto light_on = [&](const std::vector<Met>& met, std::size_t first) {
    Lit lit{std::vector<Rgb>(met.size(), Rgb(0, 0, 0)), std::vector<Rgb>(met.size(), Rgb(0, 0, 0)), {}, {}};
    Lamps sunlight(overhead);
    std::vector<accel::Ray> rays;
    std::vector<std::size_t> askers;
    std::vector<Rgb> shares;
    for (std::size_t i = 0; i < met.size(); ++i) {
      if (!met[i].land) continue;
      if (day) sunlight.ask(i, met[i], sun, sky.sun_irradiance() / pi, width_m);
      // Evenly over all directions: 4 cosine for each.
      const V3 towards = direction_of(even(first + i, 0.8191725), 2 * even(first + i, 0.6710436) - 1);
      const float facing = met[i].point.normal.dot(towards);
      const Rgb share = (facing > 0 ? met[i].point.reflectance : met[i].point.transmittance) * (4 * std::abs(facing));
      if (luminance(share) <= 0) continue;
      accel::Ray ray;
      if (!ray_from(met[i].point, met[i].hit, towards, lift_m, ray)) {
        lit.closed[i] += share;
        continue;
      }
      ray.width_m = width_m;
      rays.push_back(ray);
      askers.push_back(i);
      shares.push_back(share);
    }
    sunlight.add_to(lit.light);
    std::vector<std::uint8_t> barred(rays.size());
    overhead.tracer.occluded(rays, barred);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      if (barred[k]) {
        lit.closed[askers[k]] += shares[k];
        lit.barred.push_back(rays[k]);
        lit.weights.push_back(luminance(shares[k]));
      } else {
        lit.light[askers[k]] += shares[k] * sky.radiance(rays[k].direction);
      }
    }
    return lit;
  };
  silvasim::base::parallel_for(count, [&](std::size_t number) {
    const V3 up = Views::direction(number);
    std::vector<Point> places(a_view);
    for (std::size_t i = 0; i < a_view; ++i)
      places[i] =
          gentle[static_cast<std::size_t>(even(number * a_view + i, 0.6180340) * static_cast<float>(gentle.size())) %
                 gentle.size()];
    const std::vector<Met> met = met_by(overhead, rays_down(
                                                      overhead, places, [&](std::size_t) { return up; }, width_m));
    View& view = views[number];
    const Lit lit = light_on(met, number * a_view);
    for (std::size_t i = 0; i < met.size(); ++i) {
      view.land += met[i].land ? 1.0f : 0.0f;
      view.light += lit.light[i];
      view.closed += lit.closed[i];
    }
    const std::vector<Met> near = met_by(overhead, lit.barred);
    const Lit near_lit = light_on(near, number * a_view + 7);
    for (std::size_t i = 0; i < near.size(); ++i) {
      const float weight = near[i].land ? lit.weights[i] : 0.0f;
      view.met_near += weight;
      view.near += near_lit.light[i] * weight;
      view.near_closed += near_lit.closed[i] * weight;
    }
  });
  SentBack result;
  Rgb near(0, 0, 0), near_closed(0, 0, 0);
  float met_near = 0;
  for (const View& view : views) {
    near += view.near;
    near_closed += view.near_closed;
    met_near += view.met_near;
  }
  // What bars the sky is lit itself, and sees things lit like itself where its own sky is barred.
  if (met_near > 0) {
    near /= met_near;
    near_closed /= met_near;
    for (int c = 0; c < 3; ++c) result.among[c] = near[c] / (1 - std::min(near_closed[c], 0.9f));
  }
  const Rgb level = albedo * (sky.sun_irradiance() * std::max(sun.z, 0.0f) + sky.sky_irradiance()) / pi;
  for (std::size_t number = 0; number < count; ++number) {
    const View& view = views[number];
    if (view.land <= 0) continue;
    const Rgb seen = (view.light + view.closed * result.among) / view.land;
    for (int c = 0; c < 3; ++c)
      result.views.shares[number][c] = std::clamp(seen[c] / std::max(level[c], 1e-9f), 0.1f, 8.0f);
  }
  result.views.smooth();
  return result;
}

}  // namespace silvavis::shade
