#include "silvasim/export/cover.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "silvasim/base/parallel.h"

namespace silvasim::exports {

namespace {

constexpr int band_px = 48;  // part of the algorithm only in that bands are what threads take

// A band of pixel rows while it is painted.
struct Band {
  int width = 0, first = 0, last = 0;  // rows [first, last)
  std::vector<Light> light;

  Light& at(int x, int y) {
    return light[static_cast<std::size_t>(y - first) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

struct Disc {
  float x = 0, y = 0, radius = 0;  // pixels
};

struct Window {
  int left = 0, top = 0, right = 0, bottom = 0;  // pixels [left, right) x [top, bottom)
};

// Calls visit(x, y, distance from the disc's centre to the pixel's) for the window's pixels that the disc may touch.
template <typename Visit>
void for_each_pixel(const Window& window, const Disc& disc, Visit&& visit) {
  const float reach = disc.radius + 1;
  const int left = std::max(window.left, static_cast<int>(std::floor(disc.x - reach)));
  const int right = std::min(window.right - 1, static_cast<int>(std::floor(disc.x + reach)));
  const int top = std::max(window.top, static_cast<int>(std::floor(disc.y - reach)));
  const int bottom = std::min(window.bottom - 1, static_cast<int>(std::floor(disc.y + reach)));
  for (int y = top; y <= bottom; ++y) {
    const float dy = static_cast<float>(y) + 0.5f - disc.y;
    for (int x = left; x <= right; ++x) {
      const float dx = static_cast<float>(x) + 0.5f - disc.x;
      visit(x, y, std::sqrt(dx * dx + dy * dy));
    }
  }
}

float within(float radius, float distance) { return std::clamp(radius - distance + 0.5f, 0.0f, 1.0f); }

void paint_crown(Band& band, const Disc& disc, Light fill, Light rim) {
  const float inner = disc.radius - outline_px(disc.radius), stem = stem_radius_px(disc.radius);
  for_each_pixel({0, band.first, band.width, band.last}, disc, [&](int x, int y, float distance) {
    const float inside = within(disc.radius, distance);
    if (inside <= 0) return;
    Light colour = mix(rim, fill, within(inner, distance));
    if (stem > 0) colour = mix(colour, rim, within(stem, distance));
    Light& pixel = band.at(x, y);
    pixel = mix(pixel, colour, inside);
  });
}

struct Cover {
  Light light;        // sum of colour times covered share
  float covered = 0;  // may exceed 1 where crowns overlap

  Cover& operator+=(const Cover& other) {
    light = light + other.light;
    covered += other.covered;
    return *this;
  }
  friend Cover operator*(const Cover& cover, float k) { return {cover.light * k, cover.covered * k}; }
};

// Covered shares of a band's pixels, and of one pixel around it for smoothing.
class CoverGrid {
 public:
  explicit CoverGrid(const Band& band) : width_(band.width + 2), top_(band.first - 1), bottom_(band.last + 1) {
    cells_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(bottom_ - top_));
  }

  // Adds the share of each pixel that the disc covers; over all pixels it sums up to the disc's area.
  void add(const Disc& disc, Light colour) {
    if (disc.radius < 0.8f) {
      // A square of the same area is as good as a disc here, and its shares are exact.
      const float half = disc.radius * 0.88622693f;  // sqrt(pi) / 2
      const float west = disc.x - half, east = disc.x + half, north = disc.y - half, south = disc.y + half;
      const int left = std::max(-1, static_cast<int>(std::floor(west)));
      const int right = std::min(width_ - 2, static_cast<int>(std::floor(east)));
      const int top = std::max(top_, static_cast<int>(std::floor(north)));
      const int bottom = std::min(bottom_ - 1, static_cast<int>(std::floor(south)));
      for (int y = top; y <= bottom; ++y) {
        const float tall = std::min(south, static_cast<float>(y + 1)) - std::max(north, static_cast<float>(y));
        for (int x = left; x <= right; ++x) {
          const float wide = std::min(east, static_cast<float>(x + 1)) - std::max(west, static_cast<float>(x));
          if (wide > 0 && tall > 0) at(x, y) += Cover{colour, 1} * (wide * tall);
        }
      }
      return;
    }
    // A soft rim adds a twelfth of a square pixel times pi to the area; a slightly smaller radius takes it away again.
    const float radius = std::sqrt(disc.radius * disc.radius - 1.0f / 12);
    for_each_pixel({-1, top_, width_ - 1, bottom_}, disc, [&](int x, int y, float distance) {
      const float share = within(radius, distance);
      if (share > 0) at(x, y) += Cover{colour, 1} * share;
    });
  }

  Cover at_pixel(int x, int y) const { return const_cast<CoverGrid*>(this)->at(x, y); }

  // The mean over 3 x 3 pixels, weighted 1 2 1: where a pixel holds few plants their chance numbers would show as
  // grain.
  Cover smoothed(int x, int y) const {
    Cover sum;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        sum += at_pixel(x + dx, y + dy) * (static_cast<float>((2 - dx * dx) * (2 - dy * dy)) / 16.0f);
      }
    }
    return sum;
  }

 private:
  Cover& at(int x, int y) {
    return cells_[static_cast<std::size_t>(y - top_) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x + 1)];
  }

  int width_, top_, bottom_;
  std::vector<Cover> cells_;
};

// Half of the relief's light falls on what grows too, so that hills stay hills under forest.
float lit(float shade) { return 1 + 0.55f * (std::min(shade, 1.3f) - 1); }

std::array<Light, 256> ramp_lights() {
  std::array<Light, 256> lights{};
  for (std::size_t i = 0; i < lights.size(); ++i) lights[i] = light_of(ramp(static_cast<double>(i) / 255));
  return lights;
}

// The colours of one layer's species, or of the probabilities.
struct Palette {
  Palette(const ecosystem::Layer& layer, const std::vector<SpeciesCount>& counts, Subject subject_)
      : subject(subject_) {
    for (std::size_t s = 0; s < layer.species.size(); ++s) {
      shown.push_back(counts[s].shown);
      fill.push_back(light_of(layer.species[s].colour));
      rim.push_back(light_of(darker(layer.species[s].colour)));
    }
  }
  Light fill_of(const ecosystem::Plant& plant) const {
    return subject == Subject::species ? fill[plant.species]
                                       : heat[static_cast<std::size_t>(plant.probability * 255 + 0.5f)];
  }
  Light rim_of(const ecosystem::Plant& plant) const {
    return subject == Subject::species ? rim[plant.species] : fill_of(plant) * 0.42f;
  }

  Subject subject;
  std::vector<char> shown;
  std::vector<Light> fill, rim;
  std::array<Light, 256> heat = ramp_lights();
};

// Paints every band on its own and collects the bytes.
template <typename Paint>
Pixels in_bands(const View& view, Paint&& paint) {
  Pixels pixels{view.width_px, view.height_px, {}};
  const auto width = static_cast<std::size_t>(view.width_px);
  pixels.rgb.resize(width * static_cast<std::size_t>(view.height_px) * 3);
  const auto bands = static_cast<std::size_t>((view.height_px + band_px - 1) / band_px);
  base::parallel_for(bands, [&](std::size_t b) {
    Band band;
    band.width = view.width_px;
    band.first = static_cast<int>(b) * band_px;
    band.last = std::min(band.first + band_px, view.height_px);
    band.light.resize(width * static_cast<std::size_t>(band.last - band.first));
    paint(band);
    std::uint8_t* bytes = pixels.rgb.data() + static_cast<std::size_t>(band.first) * width * 3;
    for (const Light& light : band.light) {
      *bytes++ = byte_of(light.red);
      *bytes++ = byte_of(light.green);
      *bytes++ = byte_of(light.blue);
    }
  });
  return pixels;
}

// Fills the band with ground, and keeps its shade for what grows there.
void paint_ground(Band& band, const View& view, const Ground& ground, std::vector<float>* shades) {
  if (shades) shades->assign(band.light.size(), 1.0f);
  if (ground.plain()) {
    std::fill(band.light.begin(), band.light.end(), light_of(paper_colour));
    return;
  }
  std::size_t i = 0;
  for (int y = band.first; y < band.last; ++y) {
    for (int x = 0; x < band.width; ++x, ++i) {
      const Ground::Sample sample = ground.at(view.x_m(x + 0.5), view.y_m(y + 0.5));
      band.light[i] = sample.light;
      if (shades) (*shades)[i] = sample.shade;
    }
  }
}

}  // namespace

Pixels draw_ground(const View& view, const Ground& ground) {
  return in_bands(view, [&](Band& band) { paint_ground(band, view, ground, nullptr); });
}

Pixels draw_heat(const View& view, const Ground& ground, const Heat& heat) {
  const std::array<Light, 256> colours = ramp_lights();
  return in_bands(view, [&](Band& band) {
    std::vector<float> shades;
    paint_ground(band, view, ground, &shades);
    std::size_t i = 0;
    for (int y = band.first; y < band.last; ++y) {
      for (int x = 0; x < band.width; ++x, ++i) {
        const Heat::Sample sample = heat.at(view.x_m(x + 0.5), view.y_m(y + 0.5));
        if (sample.opacity <= 0) continue;
        const Light colour = colours[static_cast<std::size_t>(std::min(sample.share, 1.0f) * 255 + 0.5f)];
        band.light[i] = mix(band.light[i], colour * lit(shades[i]), sample.opacity);
      }
    }
  });
}

Pixels draw_map(const ecosystem::Ecosystem& ecosystem, const Census& census, const View& view, const Ground& ground,
                Subject subject) {
  const Style style = style_of(census, view);
  const double radius_px = census.mean_radius_m * view.px_per_m();
  const int boldness = boldness_of(radius_px, subject);
  const bool smooth = radius_px < 1.6;
  std::vector<Palette> palettes;
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    palettes.emplace_back(ecosystem.layers[l], census.layers[l], subject);
  }
  return in_bands(view, [&](Band& band) {
    std::vector<float> shades;
    paint_ground(band, view, ground, &shades);
    for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
      const ecosystem::Layer& layer = ecosystem.layers[l];
      const Palette& palette = palettes[l];
      // The band's box, wider by the widest crown and two pixels for soft rims.
      const base::Box near = base::grown({view.box.west, view.y_m(band.last), view.box.east, view.y_m(band.first)},
                                         layer.tile_set.most_radius_m + 3 / view.px_per_m());
      const auto disc_of = [&](const ecosystem::Plant& plant) {
        return Disc{static_cast<float>(view.x_px(plant.at.x)), static_cast<float>(view.y_px(plant.at.y)),
                    static_cast<float>(static_cast<double>(plant.radius_m) * view.px_per_m())};
      };
      if (style == Style::crowns) {
        for_each_plant_near(layer, census.offsets[l], near, [&](const ecosystem::Plant& plant) {
          if (palette.shown[plant.species] && near.contains(plant.at)) {
            paint_crown(band, disc_of(plant), palette.fill_of(plant), palette.rim_of(plant));
          }
        });
        continue;
      }
      CoverGrid cover(band);
      for_each_plant_near(layer, census.offsets[l], near, [&](const ecosystem::Plant& plant) {
        if (palette.shown[plant.species] && near.contains(plant.at)) cover.add(disc_of(plant), palette.fill_of(plant));
      });
      std::size_t i = 0;
      for (int y = band.first; y < band.last; ++y) {
        for (int x = 0; x < band.width; ++x, ++i) {
          const Cover here = smooth ? cover.smoothed(x, y) : cover.at_pixel(x, y);
          if (here.covered <= 0) continue;
          const float bright = subject == Subject::species ? lit(shades[i]) : 1.0f;
          band.light[i] = mix(band.light[i], here.light * (bright / here.covered), opacity(here.covered, boldness));
        }
      }
    }
  });
}

}  // namespace silvasim::exports
