#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/base/parallel.h"
#include "silvasim/base/words.h"
#include "silvavis/image/file.h"
#include "silvavis/image/format.h"
#include "silvavis/image/tone.h"

namespace silvavis::image {

namespace fs = std::filesystem;
namespace base = silvasim::base;
using assets::pictures::Sample;

namespace {

constexpr std::size_t most_file_bytes = std::size_t{8} << 30;
constexpr std::size_t most_channels = 64;
// Deflate, the best packer among the formats, gains a factor of 1030; a file that promises more is lying.
constexpr std::size_t most_bytes_a_byte = 2000, always_allowed_bytes = std::size_t{1} << 20;

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  // What libraries say may hold pieces of the file.
  throw base::Error("cannot read \"" + path.string() + "\": " + base::shortened(why, 300));
}

// A picture's file in memory, opened by the one reader that its name asks for, with its sizes checked.
class Input {
 public:
  explicit Input(const fs::path& path)
      : path_(path), format_(format_of(path)), bytes_(base::read_file(path, most_file_bytes)) {
    guarded([&] {
      file_ = assets::pictures::open_bytes(format_, path.filename().string(), std::as_bytes(std::span(bytes_)));
    });
    check();
  }

  const assets::pictures::Shape& shape() const { return file_->shape(); }
  Format format() const { return format_; }
  std::size_t pixels() const {
    return static_cast<std::size_t>(shape().width) * static_cast<std::size_t>(shape().height);
  }

  void read(int first_channel, int end_channel, Sample sample, void* to) {
    guarded([&] { file_->read(0, shape().height, first_channel, end_channel, sample, to); });
  }

 private:
  template <class Act>
  void guarded(const Act& act) const {
    try {
      act();
    } catch (const base::Error& error) {
      fail(path_, error.what());
    }
  }

  void check() const {
    const assets::pictures::Shape& s = shape();
    if (s.width < 1 || s.height < 1 || s.width > most_side_px || s.height > most_side_px || s.depth > 1 ||
        static_cast<long long>(s.width) * s.height > most_pixels) {
      fail(path_, fmt::format("it claims {} x {} x {} pixels; a side can have 1 to {}, and all together {} million",
                              s.width, s.height, s.depth, most_side_px, most_pixels >> 20));
    }
    if (s.channels.empty() || s.channels.size() > most_channels || s.deep) {
      fail(path_, fmt::format("it has {} channels{}; a picture has 1 to {}, flat", s.channels.size(),
                              s.deep ? ", deep" : "", most_channels));
    }
    const std::size_t claimed = pixels() * s.pixel_bytes;
    if (claimed > always_allowed_bytes && claimed / most_bytes_a_byte > bytes_.size()) {
      fail(path_, fmt::format("it claims {} x {} pixels with {} channels, which no file of {} bytes holds", s.width,
                              s.height, s.channels.size(), bytes_.size()));
    }
  }

  fs::path path_;
  Format format_;
  std::string bytes_;
  std::unique_ptr<assets::pictures::PictureFile> file_;
};

int channel_named(const assets::pictures::Shape& shape, const std::string& name) {
  const auto at = std::find_if(shape.channels.begin(), shape.channels.end(),
                               [&](const assets::pictures::Shape::Channel& channel) { return channel.name == name; });
  return at == shape.channels.end() ? -1 : static_cast<int>(at - shape.channels.begin());
}

// The named channels side by side, or an empty image where one is missing.
Image named(Input& input, std::initializer_list<const char*> names) {
  std::vector<int> indices;
  for (const char* name : names) indices.push_back(channel_named(input.shape(), name));
  if (std::find(indices.begin(), indices.end(), -1) != indices.end()) return {};
  Image image(input.shape().width, input.shape().height, static_cast<int>(indices.size()));
  std::vector<float> one(input.pixels());
  for (std::size_t c = 0; c < indices.size(); ++c) {
    input.read(indices[c], indices[c] + 1, Sample::f32, one.data());
    for (std::size_t i = 0; i < one.size(); ++i) image.pixels[i * indices.size() + c] = one[i];
  }
  return image;
}

std::vector<std::uint32_t> whole(Input& input, const fs::path& path, const char* name) {
  const int channel = channel_named(input.shape(), name);
  if (channel < 0) return {};
  if (input.shape().channels[static_cast<std::size_t>(channel)].sample != Sample::u32) {
    fail(path, fmt::format("its channel \"{}\" holds fractions; it must hold whole numbers (UINT)", name));
  }
  std::vector<std::uint32_t> values(input.pixels());
  input.read(channel, channel + 1, Sample::u32, values.data());
  return values;
}

void linearize(Image& image, int colours) {
  const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  base::parallel_for(static_cast<std::size_t>(image.height), [&](std::size_t y) {
    for (std::size_t i = y * row; i < (y + 1) * row; ++i) {
      const int channel = static_cast<int>(i % static_cast<std::size_t>(image.channels));
      if (channel < colours) image.pixels[i] = srgb_decoded(image.pixels[i]);
    }
  });
}

// Grey (and alpha) or colours (and alpha), in the order in which the file has them.
Image first_channels(Input& input) {
  const assets::pictures::Shape& shape = input.shape();
  const int taken = std::min(static_cast<int>(shape.channels.size()), 4);
  const bool grey = taken < 3, alpha = taken == 2 || taken == 4;
  std::vector<float> values(input.pixels() * static_cast<std::size_t>(taken));
  input.read(0, taken, Sample::f32, values.data());
  Image image(shape.width, shape.height, alpha ? 4 : 3);
  const std::size_t step = static_cast<std::size_t>(taken), channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < input.pixels(); ++i) {
    const float* from = values.data() + i * step;
    float* to = image.pixels.data() + i * channels;
    for (std::size_t c = 0; c < 3; ++c) to[c] = from[grey ? 0 : c];
    if (alpha) to[3] = from[step - 1];
  }
  return image;
}

Image colours_of(Input& input, const fs::path& path) {
  if (input.format() == Format::exr && input.shape().channels.size() > 1) {
    Image image = named(input, {"R", "G", "B"});
    if (image.empty()) fail(path, "it has no channels R, G and B");
    return image;
  }
  const Sample sample = input.shape().channels[0].sample;
  const bool encoded = sample == Sample::u8 || sample == Sample::u16;
  if (!encoded && sample != Sample::f32 && sample != Sample::half)
    fail(path, "its pixels are of another type than 8 or 16 bit, half or float");
  Image image = first_channels(input);
  if (encoded) linearize(image, 3);
  return image;
}

}  // namespace

Image read(const fs::path& path) {
  Input input(path);
  return colours_of(input, path);
}

Frame read_frame(const fs::path& path) {
  Input input(path);
  Frame frame;
  frame.colour = colours_of(input, path);
  if (frame.colour.channels == 4) {
    Image opaque(frame.colour.width, frame.colour.height, 3);
    for (int y = 0; y < opaque.height; ++y) {
      for (int x = 0; x < opaque.width; ++x) std::copy_n(frame.colour.at(x, y), 3, opaque.at(x, y));
    }
    frame.colour = std::move(opaque);
  }
  if (input.format() != Format::exr) return frame;
  frame.depth = named(input, {"Z"});
  frame.normal = named(input, {"N.X", "N.Y", "N.Z"});
  frame.plants = whole(input, path, "plant");
  for (const std::uint32_t value : whole(input, path, "species")) {
    if (value > species_sky)
      fail(path, fmt::format("its channel \"species\" holds {}; at most {}", value, species_sky));
    frame.species.push_back(static_cast<std::uint16_t>(value));
  }
  return frame;
}

}  // namespace silvavis::image
