#include "silvavis/progressive.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "silvasim/base/parallel.h"

namespace silvavis {

namespace {

constexpr int side_px = 8;  // of a block; small, so that time is kept
constexpr std::array<int, 7> first_strides{2, 3, 4, 6, 8, 12, 16};
constexpr int unknown_stride = 8;  // before the first picture has told what a sample costs

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

int parts(int whole, int part) { return (whole + part - 1) / part; }

// What is sampled after squares of that side.
int finer(int stride) { return stride > 3 ? stride / 2 : 1; }

// Blocks in an order whose every beginning is spread evenly over the picture: that of Bayer's matrix (1973).
std::vector<std::size_t> spread_order(int across, int down) {
  std::vector<std::pair<std::uint32_t, std::size_t>> keys;
  for (int y = 0; y < down; ++y) {
    for (int x = 0; x < across; ++x) {
      std::uint32_t key = 0;
      for (int bit = 0; bit < 12; ++bit) {
        const auto both = static_cast<std::uint32_t>((x ^ y) >> bit & 1),
                   row = static_cast<std::uint32_t>(y >> bit & 1);
        key = key << 2 | both << 1 | row;
      }
      keys.emplace_back(key, keys.size());
    }
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> order;
  for (const auto& [key, block] : keys) order.push_back(block);
  return order;
}

// Bilinear between the middles of squares of `ratio` pixels, the first of which begins at the upper left corner.
void enlarge(const image::Image& from, double ratio, image::Image& to) {
  struct Between {
    int first = 0, second = 0;
    float weight = 0;  // of the second
  };
  const auto between = [&](int at, int count) {
    const double place = std::clamp((at + 0.5) / ratio - 0.5, 0.0, static_cast<double>(count - 1));
    const int first = static_cast<int>(place);
    return Between{first, std::min(first + 1, count - 1), static_cast<float>(place - first)};
  };
  std::vector<Between> columns(static_cast<std::size_t>(to.width));
  for (int x = 0; x < to.width; ++x) columns[static_cast<std::size_t>(x)] = between(x, from.width);
  const auto bands = static_cast<std::size_t>(parts(to.height, side_px));
  silvasim::base::parallel_for(bands, [&](std::size_t band) {
    std::vector<float> mixed(static_cast<std::size_t>(from.width) * 3);
    const int top = static_cast<int>(band) * side_px;
    for (int y = top; y < std::min(top + side_px, to.height); ++y) {
      const Between rows = between(y, from.height);
      const float* const upper = from.at(0, rows.first);
      const float* const lower = from.at(0, rows.second);
      for (std::size_t i = 0; i < mixed.size(); ++i) mixed[i] = upper[i] + (lower[i] - upper[i]) * rows.weight;
      float* pixel = to.at(0, y);
      for (const Between& column : columns) {
        const float* const left = mixed.data() + 3 * column.first;
        const float* const right = mixed.data() + 3 * column.second;
        for (int c = 0; c < 3; ++c) *pixel++ = left[c] + (right[c] - left[c]) * column.weight;
      }
    }
  });
}

// The same view with one ray for a square of pixels, as wide as that.
shade::Lens coarser(shade::Lens lens, int stride) {
  lens.pixel *= stride;
  lens.centre_x /= stride;
  lens.centre_y /= stride;
  lens.footprint_rad = 2 * std::atan(lens.pixel / 2);
  return lens;
}

}  // namespace

Progressive::Progressive(const scene::Scene& scene, const accel::Tracer& tracer, const shade::Land& land)
    : scene_(scene), tracer_(tracer), land_(land) {}

void Progressive::look(const Light& light, const RenderOptions& options) {
  lens_ = shade::lens_of(options.camera);
  light_ = &light;
  options_ = options;
  options_.aovs = false;
  square_options_ = options_;
  square_options_.samples = 1;
  stride_ = shown_stride_ = 0;
  samples_ = 0;
  enlarged_ = true;
  finished_ = false;
  statistics_ = {};
}

double Progressive::samples_a_pixel() const {
  if (stride_ == 0) return 0;
  if (stride_ > 1) return 1.0 / (shown_stride_ * shown_stride_);
  return static_cast<double>(samples_) / (static_cast<double>(options_.camera.width) * options_.camera.height);
}

void Progressive::refine(double seconds) {
  const Seconds until = now_s() + seconds;
  const bool is_first = stride_ == 0;
  if (is_first) {
    usual_stride_ = first_stride(seconds);
    begin(usual_stride_);
    const Seconds start = now_s();
    work(std::numeric_limits<Seconds>::infinity());
    const Seconds each = (now_s() - start) / (static_cast<double>(squares_.width) * squares_.height);
    seconds_a_sample_ = seconds_a_sample_ == 0 ? each : (seconds_a_sample_ + each) / 2;
  }
  for (bool worked = is_first; !finished_ && (!worked || now_s() < until); worked = true) {
    if (is_through()) {
      const int next = finer(stride_);
      // While the eye moves, no picture is half coarse and half fine.
      if (is_first && foreseen(next) > until - now_s()) break;
      if (stride_ == 1) {
        begin_pass();
      } else {
        begin(next);
      }
    }
    if (!finished_) work(until);
  }
  if (stride_ > 1) enlarged_ = false;
}

const image::Image& Progressive::picture() {
  if (!enlarged_) enlarge(squares_, shown_stride_, picture_);
  enlarged_ = true;
  return picture_;
}

// The finest that fits, but no wavering between two: finer only where there is ample time.
int Progressive::first_stride(Seconds budget) const {
  if (seconds_a_sample_ == 0) return unknown_stride;
  for (const int stride : first_strides)
    if (foreseen(stride) < (stride < usual_stride_ ? 0.7 : 0.95) * budget) return stride;
  return first_strides.back();
}

Progressive::Seconds Progressive::foreseen(int stride) const {
  const double samples =
      static_cast<double>(parts(options_.camera.width, stride)) * parts(options_.camera.height, stride);
  return samples * seconds_a_sample_;
}

void Progressive::begin(int stride) {
  const int width = options_.camera.width, height = options_.camera.height;
  if (stride_ == 0 && (picture_.width != width || picture_.height != height)) picture_ = image::Image(width, height, 3);
  if (stride > 1) {
    finer_squares_ = image::Image(parts(width, stride), parts(height, stride), 3);
    order_ = spread_order(parts(finer_squares_.width, side_px), parts(finer_squares_.height, side_px));
    done_ = 0;
  } else {
    enlarge(squares_, shown_stride_, picture_);
    enlarged_ = true;
    blocks_.clear();
    for (int top = 0; top < height; top += side_px) {
      for (int left = 0; left < width; left += side_px) blocks_.push_back(square_of(left, top, side_px, width, height));
    }
    begin_pass();
  }
  stride_ = stride;
}

// One more sample for all pixels that have not enough.
void Progressive::begin_pass() {
  order_ = spread_order(parts(options_.camera.width, side_px), parts(options_.camera.height, side_px));
  std::erase_if(order_, [&](std::size_t i) {
    return std::all_of(blocks_[i].begin(), blocks_[i].end(), [&](const Pixel& p) { return has_enough(p, options_); });
  });
  done_ = 0;
  finished_ = order_.empty();
}

// Until the pass is through, or the time is up; at least a block a thread.
void Progressive::work(Seconds until) {
  const RenderOptions& options = stride_ > 1 ? square_options_ : options_;
  const shade::Lens lens = stride_ > 1 ? coarser(lens_, stride_) : lens_;
  std::atomic<std::size_t> next = done_;
  std::atomic<std::uint64_t> samples = 0, eye_rays = 0, shadow_rays = 0;
  silvasim::base::parallel_for(static_cast<std::size_t>(silvasim::base::thread_count()), [&](std::size_t) {
    Sampler sampler(scene_, tracer_, *light_, land_, options, lens);
    do {
      const std::size_t i = next++;
      if (i >= order_.size()) break;
      if (stride_ > 1) {
        fill_squares(sampler, order_[i]);
      } else {
        samples += fill_pixels(sampler, order_[i]);
      }
    } while (now_s() < until);
    eye_rays += sampler.statistics.eye_rays;
    shadow_rays += sampler.statistics.shadow_rays;
  });
  done_ = std::min(next.load(), order_.size());
  // A picture half of coarse and half of fine squares would look like a chequerboard.
  if (stride_ > 1 && is_through()) {
    std::swap(squares_, finer_squares_);
    shown_stride_ = stride_;
  }
  samples_ += samples;
  statistics_.eye_rays += eye_rays;
  statistics_.shadow_rays += shadow_rays;
}

void Progressive::fill_squares(Sampler& sampler, std::size_t block) {
  const int across = parts(finer_squares_.width, side_px);
  const int left = static_cast<int>(block) % across * side_px, top = static_cast<int>(block) / across * side_px;
  std::vector<Pixel> pixels = square_of(left, top, side_px, finer_squares_.width, finer_squares_.height);
  std::vector<std::size_t> all(pixels.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  sampler.add(pixels, all, 1);
  for (const Pixel& pixel : pixels) std::copy_n(&pixel.sum.x, 3, finer_squares_.at(pixel.x, pixel.y));
}

std::size_t Progressive::fill_pixels(Sampler& sampler, std::size_t block) {
  std::vector<Pixel>& pixels = blocks_[block];
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (!has_enough(pixels[i], options_)) open.push_back(i);
  sampler.add(pixels, open, 1);
  for (const std::size_t i : open) {
    const Rgb mean = pixels[i].mean();
    std::copy_n(&mean.x, 3, picture_.at(pixels[i].x, pixels[i].y));
  }
  return open.size();
}

}  // namespace silvavis
