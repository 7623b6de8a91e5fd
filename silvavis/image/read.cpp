#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

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

namespace {

constexpr std::size_t most_file_bytes = std::size_t{8} << 30;
constexpr int most_channels = 64;
// Deflate, the best packer among the formats, gains a factor of 1030; a file that promises more is lying.
constexpr std::size_t most_bytes_a_byte = 2000, always_allowed_bytes = std::size_t{1} << 20;

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  // What libraries say may hold pieces of the file.
  throw base::Error("cannot read \"" + path.string() + "\": " + base::shortened(why, 300));
}

// A picture's file in memory, opened by the one plugin that its name asks for, with its sizes checked.
class Input {
 public:
  explicit Input(const fs::path& path)
      : path_(path), format_(format_of(path)), bytes_(base::read_file(path, most_file_bytes)) {
    memory_ = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes_.data(), bytes_.size());
    guarded([&] {
      input_ = OIIO::ImageInput::create(plugin_of(format_), false, nullptr, memory_.get());
      OIIO::ImageSpec wish;
      wish.attribute("oiio:UnassociatedAlpha", 1);
      OIIO::ImageSpec spec;
      input_->set_ioproxy(memory_.get());
      if (!input_->open(path.filename().string(), spec, wish)) fail(path, message());
    });
    check();
  }

  const OIIO::ImageSpec& spec() const { return input_->spec(); }
  Format format() const { return format_; }
  std::size_t pixels() const {
    return static_cast<std::size_t>(spec().width) * static_cast<std::size_t>(spec().height);
  }

  template <class Value>
  void read(int first_channel, int end_channel, OIIO::TypeDesc type, Value* to) {
    guarded([&] {
      if (!input_->read_image(0, 0, first_channel, end_channel, type, to)) fail(path_, message());
    });
  }

 private:
  std::string message() const {
    const std::string text = input_->geterror();
    return text.empty() ? "it is no " + path_.extension().string().substr(1) + " file, or a broken one" : text;
  }

  template <class Act>
  void guarded(const Act& act) const {
    try {
      act();
    } catch (const base::Error&) {
      throw;
    } catch (const std::exception& error) {
      fail(path_, error.what());
    }
  }

  void check() const {
    const OIIO::ImageSpec& s = spec();
    if (s.width < 1 || s.height < 1 || s.width > most_side_px || s.height > most_side_px || s.depth > 1 ||
        static_cast<long long>(s.width) * s.height > most_pixels) {
      fail(path_, fmt::format("it claims {} x {} x {} pixels; a side can have 1 to {}, and all together {} million",
                              s.width, s.height, s.depth, most_side_px, most_pixels >> 20));
    }
    if (s.nchannels < 1 || s.nchannels > most_channels || s.deep) {
      fail(path_, fmt::format("it has {} channels{}; a picture has 1 to {}, flat", s.nchannels, s.deep ? ", deep" : "",
                              most_channels));
    }
    const std::size_t claimed = pixels() * s.pixel_bytes(true);
    if (claimed > always_allowed_bytes && claimed / most_bytes_a_byte > bytes_.size()) {
      fail(path_, fmt::format("it claims {} x {} pixels with {} channels, which no file of {} bytes holds", s.width,
                              s.height, s.nchannels, bytes_.size()));
    }
  }

  fs::path path_;
  Format format_;
  std::string bytes_;
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

int channel_named(const OIIO::ImageSpec& spec, const std::string& name) {
  const auto at = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
  return at == spec.channelnames.end() ? -1 : static_cast<int>(at - spec.channelnames.begin());
}

bool whole_numbers(OIIO::TypeDesc type) { return type == OIIO::TypeDesc::UINT8 || type == OIIO::TypeDesc::UINT16; }

// The named channels side by side, or an empty image where one is missing.
Image named(Input& input, std::initializer_list<const char*> names) {
  std::vector<int> indices;
  for (const char* name : names) indices.push_back(channel_named(input.spec(), name));
  if (std::find(indices.begin(), indices.end(), -1) != indices.end()) return {};
  Image image(input.spec().width, input.spec().height, static_cast<int>(indices.size()));
  std::vector<float> one(input.pixels());
  for (std::size_t c = 0; c < indices.size(); ++c) {
    input.read(indices[c], indices[c] + 1, OIIO::TypeDesc::FLOAT, one.data());
    for (std::size_t i = 0; i < one.size(); ++i) image.pixels[i * indices.size() + c] = one[i];
  }
  return image;
}

std::vector<std::uint32_t> whole(Input& input, const fs::path& path, const char* name) {
  const int channel = channel_named(input.spec(), name);
  if (channel < 0) return {};
  if (input.spec().channelformat(channel) != OIIO::TypeDesc::UINT32) {
    fail(path, fmt::format("its channel \"{}\" holds fractions; it must hold whole numbers (UINT)", name));
  }
  std::vector<std::uint32_t> values(input.pixels());
  input.read(channel, channel + 1, OIIO::TypeDesc::UINT32, values.data());
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
  const OIIO::ImageSpec& spec = input.spec();
  const int taken = std::min(spec.nchannels, 4);
  const bool grey = taken < 3, alpha = taken == 2 || taken == 4;
  std::vector<float> values(input.pixels() * static_cast<std::size_t>(taken));
  input.read(0, taken, OIIO::TypeDesc::FLOAT, values.data());
  Image image(spec.width, spec.height, alpha ? 4 : 3);
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
  const OIIO::ImageSpec& spec = input.spec();
  if (input.format() == Format::exr && spec.nchannels > 1) {
    Image image = named(input, {"R", "G", "B"});
    if (image.empty()) fail(path, "it has no channels R, G and B");
    return image;
  }
  const bool encoded = whole_numbers(spec.format);
  if (!encoded && spec.format != OIIO::TypeDesc::FLOAT && spec.format != OIIO::TypeDesc::HALF) {
    fail(path,
         fmt::format("its pixels are of type {}; they can be of 8 or 16 bit, half or float", spec.format.c_str()));
  }
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
