#include "silvavis/sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "silvasim/base/random.h"

namespace silvavis {

namespace {

// The pixels' filter is a Gaussian of standard deviation 0.45 pixels, cut at 1.5: samples are drawn from it and all count
// the same (Ernst, Stamminger and Greiner 2006, filter importance sampling).
float filter_offset(float u) {
  constexpr float deviation = 0.45f, most = 1.5f;
  // Acklam's rational approximation would be finer; a sum of logistic form is within 2 % and has no tails to cut.
  const float clamped = std::clamp(u, 1e-4f, 1 - 1e-4f);
  return std::clamp(deviation * 0.5876f * std::log(clamped / (1 - clamped)), -most, most);
}

V3 cosine_weighted(const V3& normal, float u, float v) {
  const float r = std::sqrt(u), angle = 2 * std::numbers::pi_v<float> * v;
  // An orthonormal frame without branches at the poles (Duff et al. 2017).
  const float sign = std::copysign(1.0f, normal.z);
  const float a = -1 / (sign + normal.z), b = normal.x * normal.y * a;
  const V3 x(1 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
      y(b, sign + normal.y * normal.y * a, -normal.y);
  const V3 d = x * (r * std::cos(angle)) + y * (r * std::sin(angle)) + normal * std::sqrt(std::max(0.0f, 1 - u));
  return d.normalized();
}

float fresnel_of_water(float cosine) {
  const float grazing = 1 - std::clamp(cosine, 0.0f, 1.0f);
  return 0.02f + 0.98f * grazing * grazing * grazing * grazing * grazing;  // Schlick 1994
}

// A place on the sun's disc: what stands high above the ground casts soft shadows.
V3 on_disc(const V3& sun, float u, float v) {
  const float r = static_cast<float>(shade::Atmosphere::sun_radius_rad) * std::sqrt(u);
  const float angle = 2 * std::numbers::pi_v<float> * v;
  const V3 side = std::abs(sun.z) < 0.9f ? V3(-sun.y, sun.x, 0).normalized() : V3(0, sun.z, -sun.y).normalized();
  return (sun + (side * std::cos(angle) + sun.cross(side) * std::sin(angle)) * r).normalized();
}

// Where a shadow ray may begin: off the surface by what rounding needs, Embree's floats most. Not farther: what begins two
// centimetres off a leaf misses its neighbours, and a wood under a low sun looks lighter by some per cent.
double lift(double distance_m) { return 2e-3 + 1e-7 * distance_m; }
// Details lie within millimetres of each other.
double lift_of(accel::Surface surface, double distance_m) {
  return surface == accel::Surface::detail ? 2e-4 + 1e-6 * distance_m : lift(distance_m);
}

}  // namespace

Sampler::Sampler(const scene::Scene& scene, const accel::Tracer& tracer, const Light& light, const shade::Land& land,
                 const RenderOptions& options, const shade::Lens& lens, image::Frame* channels)
    : scene_(scene),
      tracer_(tracer),
      light_(light),
      land_(land),
      options_(options),
      lens_(lens),
      channels_(channels),
      sequence_(options.seed, 0, 0, options.samples) {
  eye_height_ = static_cast<float>(std::max(0.0, lens.eye.z - static_cast<double>(scene.ground.pyramid.origin_m)));
  constexpr auto earth_m = static_cast<float>(shade::Atmosphere::ground_radius_m);
  horizon_m_ = std::sqrt(2 * earth_m * std::max(eye_height_, 2.0f));
}

void Sampler::add(std::span<Pixel> pixels, std::span<const std::size_t> open, int count) {
  samples_.clear();
  for (const std::size_t i : open) {
    const int more = std::min(count, options_.samples - pixels[i].samples);
    sequence_.move_to(pixels[i].x, pixels[i].y);
    for (int k = 0; k < more; ++k) {
      samples_.push_back(sample_of(pixels[i], pixels[i].samples + k));
      samples_.back().pixel = i;
    }
  }
  rays_.resize(samples_.size());
  hits_.resize(samples_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) rays_[i] = samples_[i].ray;
  tracer_.nearest(rays_, hits_);
  statistics.eye_rays += rays_.size();
  for (std::size_t i = 0; i < samples_.size(); ++i) meet(samples_[i], hits_[i]);
  mirror_water();
  add_sun();
  add_sky();
  for (const Sample& sample : samples_) finish(sample, pixels[sample.pixel]);
}

void Sampler::meet(Sample& sample, const accel::Hit& hit) const {
  sample.hit = hit;
  sample.distance_m = hit.distance;
  shade::Surroundings::Point around;
  if (land_.around.meet(scene_.ground, sample.ray, hit.distance, around)) {
    sample.hit = {};
    sample.lit = true;
    constexpr double shadows_reach_m = 300;
    sample.in_shade = around.outside_m < shadows_reach_m;
    sample.distance_m = around.distance_m;
    sample.point.at = around.at;
    sample.point.normal = sample.point.plane = around.normal;
    sample.point.reflectance = around.reflectance;
  } else if (hit.surface != accel::Surface::none) {
    sample.lit = sample.in_shade = true;
    sample.point = shade::surface_at(scene_, land_, sample.ray, hit);
    // Bare land beyond what is planted is like the land around it.
    if (hit.surface == accel::Surface::ground && !land_.around.empty() && land_.drape.empty() && !sample.point.water &&
        land_.around.outside_planted(sample.point.at.x, sample.point.at.y) > 0) {
      sample.point.reflectance =
          land_.around.colour_at(sample.point.at.x, sample.point.at.y, -sample.ray.direction, width_at(sample));
    }
  }
}

Sampler::Sample Sampler::sample_of(const Pixel& pixel, int number) const {
  silvasim::base::Stream random(options_.seed, silvasim::base::Purpose::picture, static_cast<std::uint32_t>(pixel.x),
                                static_cast<std::uint32_t>(pixel.y), static_cast<std::uint32_t>(number));
  Sample sample;
  const auto [sky_u, sky_v] = sequence_.at(1, number);
  sample.draws[0] = sky_u;
  sample.draws[1] = sky_v;
  sample.draws[2] = random.next_float();
  sample.draws[3] = random.next_float();
  float dx = 0, dy = 0;
  if (options_.samples > 1) {
    const auto [u, v] = sequence_.at(0, number);
    dx = filter_offset(u);
    dy = filter_offset(v);
  }
  sample.offset = dx * dx + dy * dy;
  const shade::CameraRay ray =
      shade::ray_through(lens_, pixel.x + 0.5 + static_cast<double>(dx), pixel.y + 0.5 + static_cast<double>(dy));
  sample.ray.origin = ray.origin;
  sample.ray.direction = ray.direction;
  if (options_.lod) sample.ray.spread = static_cast<float>(lens_.footprint_rad);
  return sample;
}

// What leaves a surface is as wide as the ray that came: both then meet the same level.
float Sampler::width_at(const Sample& sample) const {
  return sample.ray.spread * static_cast<float>(sample.distance_m);
}

// Water shows what it mirrors: the sky, or dark trees at its far shore.
void Sampler::mirror_water() {
  rays_.clear();
  askers_.clear();
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (!samples_[i].point.water) continue;
    const V3 in = samples_[i].ray.direction;
    // Ripples: a slight tilt, other for each sample.
    const V3 normal = V3((samples_[i].draws[2] - 0.5f) * 0.03f, (samples_[i].draws[3] - 0.5f) * 0.03f, 1).normalized();
    V3 out = in - normal * (2 * in.dot(normal));
    out.z = std::max(out.z, 0.002f);
    accel::Ray ray;
    ray.origin = samples_[i].point.at + V3d(0, 0, 0.01);
    ray.direction = out.normalized();
    ray.width_m = width_at(samples_[i]);
    ray.spread = samples_[i].ray.spread;
    rays_.push_back(ray);
    askers_.push_back(i);
  }
  if (rays_.empty()) return;
  hits_.resize(rays_.size());
  tracer_.nearest(rays_, hits_);
  statistics.eye_rays += rays_.size();
  for (std::size_t k = 0; k < rays_.size(); ++k) {
    Sample& sample = samples_[askers_[k]];
    Rgb seen = light_.over_land.radiance(rays_[k].direction);
    if (hits_[k].surface != accel::Surface::none) {
      const shade::SurfacePoint far = shade::surface_at(scene_, land_, rays_[k], hits_[k]);
      const float sunny = std::max(0.0f, far.normal.dot(light_.over_land.sun_direction()));
      seen = far.reflectance *
             (light_.over_land.sun_irradiance() * (0.6f * sunny) + light_.over_land.sky_irradiance() * 0.5f) /
             std::numbers::pi_v<float>;
    }
    sample.light += seen * fresnel_of_water(-sample.ray.direction.z);
  }
}

void Sampler::add_sun() {
  const V3 sun = light_.over_land.sun_direction();
  if (luminance(light_.over_land.sun_irradiance()) <= 0) return;
  rays_.clear();
  askers_.clear();
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Sample& sample = samples_[i];
    if (!sample.lit) continue;
    const float facing = sample.point.normal.dot(sun);
    if (facing <= 0 && luminance(sample.point.transmittance) <= 0) continue;
    accel::Ray ray;
    if (!sample.in_shade) {
      const float sunny = std::max(0.0f, facing) / std::numbers::pi_v<float>;
      samples_[i].light += sample.point.reflectance * light_.over_land.sun_irradiance() * sunny;
      continue;
    }
    const V3 towards = on_disc(sun, sample.draws[2], sample.draws[3]);
    if (!shade::ray_from(sample.point, sample.hit, towards, lift_of(sample.hit.surface, sample.distance_m), ray) &&
        options_.sun_shadows)
      continue;
    ray.width_m = width_at(sample);
    rays_.push_back(ray);
    askers_.push_back(i);
  }
  shaded_.assign(rays_.size(), 0);
  if (options_.sun_shadows) {
    tracer_.occluded(rays_, shaded_);
    statistics.shadow_rays += rays_.size();
  }
  for (std::size_t k = 0; k < rays_.size(); ++k) {
    if (shaded_[k]) continue;
    Sample& sample = samples_[askers_[k]];
    const float facing = sample.point.normal.dot(sun);
    const Rgb& share = facing > 0 ? sample.point.reflectance : sample.point.transmittance;
    sample.light += share * light_.over_land.sun_irradiance() * (std::abs(facing) / std::numbers::pi_v<float>);
  }
}

void Sampler::add_sky() {
  if (options_.sky_rays == 0) {
    for (Sample& sample : samples_) {
      if (!sample.lit) continue;
      sample.light += (sample.point.reflectance * light_.over_land.irradiance(sample.point.normal) +
                       sample.point.transmittance * light_.over_land.irradiance(-sample.point.normal)) *
                      (0.6f / std::numbers::pi_v<float>);
    }
    return;
  }
  for (int number = 0; number < options_.sky_rays; ++number) {
    rays_.clear();
    askers_.clear();
    shares_.clear();
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Sample& sample = samples_[i];
      if (!sample.in_shade) {
        if (sample.lit && number == 0) {
          samples_[i].light +=
              sample.point.reflectance * light_.over_land.irradiance(sample.point.normal) / std::numbers::pi_v<float>;
        }
        continue;
      }
      // Light from the one side or from the other, by how much each counts; some of it by where the sky is bright.
      const float front = luminance(sample.point.reflectance), back = luminance(sample.point.transmittance);
      if (front + back <= 0) continue;
      const float share = front / (front + back), by_light = light_.sky_rays.share();
      const float shifted = sample.draws[0] + 0.618034f * static_cast<float>(number), u = shifted - std::floor(shifted);
      V3 skyward;
      if (u < by_light) {
        skyward = light_.sky_rays.towards(u / by_light, sample.draws[1]);
      } else {
        const bool through = sample.draws[1] >= share;
        const float v =
            through ? (sample.draws[1] - share) / std::max(1 - share, 1e-6f) : sample.draws[1] / std::max(share, 1e-6f);
        skyward = cosine_weighted(through ? -sample.point.normal : sample.point.normal, (u - by_light) / (1 - by_light),
                                  std::min(v, 0.999999f));
      }
      const float facing = sample.point.normal.dot(skyward), cosine = std::abs(facing) / std::numbers::pi_v<float>;
      const Rgb& colour = facing > 0 ? sample.point.reflectance : sample.point.transmittance;
      const float density = (1 - by_light) * (facing > 0 ? share : 1 - share) * cosine +
                            (by_light > 0 ? by_light * light_.sky_rays.density(skyward) : 0.0f);
      if (!(density > 0) || luminance(colour) <= 0) continue;
      const Rgb weight = colour * (cosine / (density * static_cast<float>(options_.sky_rays)));
      accel::Ray ray;
      if (!shade::ray_from(sample.point, sample.hit, skyward, lift_of(sample.hit.surface, sample.distance_m), ray)) {
        samples_[i].light += weight * light_.among;
        continue;
      }
      ray.width_m = width_at(sample);
      rays_.push_back(ray);
      askers_.push_back(i);
      shares_.push_back(weight);
    }
    shaded_.assign(rays_.size(), 0);
    tracer_.occluded(rays_, shaded_);
    statistics.shadow_rays += rays_.size();
    for (std::size_t k = 0; k < rays_.size(); ++k)
      samples_[askers_[k]].light +=
          shares_[k] * (shaded_[k] ? light_.among : light_.over_land.radiance(rays_[k].direction));
  }
}

void Sampler::finish(const Sample& sample, Pixel& pixel) {
  Rgb seen;
  if (sample.lit) {
    seen = light_.haze.apply(sample.light, static_cast<float>(sample.distance_m), eye_height_, sample.ray.direction);
  } else {
    seen = light_.sky.radiance_with_disc(sample.ray.direction);
  }
  if (sample.lit && sample.hit.surface == accel::Surface::none) {
    // The land around ends in the sky's own ground, which the horizon is made of.
    const auto far = static_cast<float>(sample.distance_m) / horizon_m_;
    const float share = std::clamp(1.6f * far - 0.6f, 0.0f, 1.0f);
    seen = seen * (1 - share) + light_.sky.radiance(sample.ray.direction) * share;
  }
  pixel.sum += seen;
  const double tone = std::sqrt(std::max(0.0, static_cast<double>(luminance(seen))));
  pixel.tone += tone;
  pixel.tone_squared += tone * tone;
  ++pixel.samples;
  if (channels_ && options_.aovs && sample.offset < pixel.nearest_offset) {
    pixel.nearest_offset = sample.offset;
    keep_channels(pixel, sample);
  }
}

void Sampler::keep_channels(const Pixel& pixel, const Sample& sample) {
  const std::size_t i = static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(options_.camera.width) +
                        static_cast<std::size_t>(pixel.x);
  const bool sky = sample.hit.surface == accel::Surface::none;
  *channels_->depth.at(pixel.x, pixel.y) = static_cast<float>(sample.hit.distance);
  const V3 normal = sky ? V3(0, 0, 0) : sample.point.normal;
  std::copy_n(&normal.x, 3, channels_->normal.at(pixel.x, pixel.y));
  channels_->species[i] = sky ? image::species_sky : sample.point.water ? image::species_water : image::species_ground;
  channels_->plants[i] = image::no_plant;
  if (sample.hit.surface == accel::Surface::plant) {
    const scene::PlantLayer& layer = scene_.layers[sample.hit.layer];
    const std::size_t position = layer.position(sample.hit.column, sample.hit.row);
    const std::uint32_t site = layer.tile_sites[layer.tiles[position]].site_ids[sample.hit.site_slot];
    channels_->species[i] = static_cast<std::uint16_t>(layer.first_species + sample.hit.species);
    channels_->plants[i] = static_cast<std::uint32_t>(layer.first_plant + layer.first_slot[position] + site);
  } else if (sample.hit.surface == accel::Surface::detail) {
    const scene::DetailLayer& layer = scene_.details[sample.hit.layer];
    const scene::DetailFrame& frame = layer.frames[layer.chosen[sample.hit.site_slot]];
    channels_->species[i] = static_cast<std::uint16_t>(layer.first_object + frame.object);
    channels_->plants[i] =
        static_cast<std::uint32_t>(layer.first_plant + scene::detail_number(layer, sample.hit.site_slot));
  }
}

}  // namespace silvavis
