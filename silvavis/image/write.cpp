#include <Imath/half.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <memory>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvavis/image/file.h"
#include "silvavis/image/format.h"
#include "silvavis/image/tone.h"

namespace silvavis::image {

namespace fs = std::filesystem;
namespace base = silvasim::base;

namespace {

using Bytes = std::vector<unsigned char>;
constexpr int strip_rows = 64;

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw base::Error("cannot write \"" + path.string() + "\": " + why);
}

void check(const fs::path& path, const Frame& frame, const WriteOptions& options) {
  const Image& colour = frame.colour;
  if (colour.width < 1 || colour.height < 1 || colour.width > most_side_px || colour.height > most_side_px ||
      static_cast<long long>(colour.width) * colour.height > most_pixels) {
    fail(path, fmt::format("a picture of {} x {} pixels; a side can have 1 to {}, and all together {} million",
                           colour.width, colour.height, most_side_px, most_pixels >> 20));
  }
  const std::size_t pixels = static_cast<std::size_t>(colour.width) * static_cast<std::size_t>(colour.height);
  const auto fits = [&](const char* name, std::size_t values, std::size_t a_pixel) {
    if (values != 0 && values != pixels * a_pixel) {
      fail(path, fmt::format("its {} has {} values for {} pixels", name, values, pixels));
    }
  };
  if (colour.channels != 3 || colour.pixels.empty()) fail(path, "its colour needs 3 channels");
  fits("colour", colour.pixels.size(), 3);
  fits("depth", frame.depth.pixels.size(), 1);
  fits("normal", frame.normal.pixels.size(), 3);
  fits("species", frame.species.size(), 1);
  fits("plants", frame.plants.size(), 1);
  if (options.jpeg_quality < 1 || options.jpeg_quality > 100) {
    fail(path, fmt::format("a JPEG's quality is 1 to 100, not {}", options.jpeg_quality));
  }
}

bool has_more_than_colour(const Frame& frame) {
  return !frame.depth.empty() || !frame.normal.empty() || !frame.species.empty() || !frame.plants.empty();
}

// Encodes `rows(first, count)`, strip by strip, in memory: so that every error of the disk is NewFile's to find.
template <class Rows>
Bytes encoded(const fs::path& path, const char* plugin, OIIO::ImageSpec spec, const Rows& rows) {
  // Without this the libraries would note the time of day.
  spec.attribute("DateTime", "1970:01:01 00:00:00");
  Bytes bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  try {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(plugin, &memory);
    if (!output) fail(path, OIIO::geterror());
    if (!output->open(path.filename().string(), spec)) fail(path, output->geterror());
    for (int first = 0; first < spec.height; first += strip_rows) {
      const int end = std::min(first + strip_rows, spec.height);
      const auto strip = rows(first, end);
      const OIIO::TypeDesc type = spec.channelformats.empty() ? spec.format : OIIO::TypeDesc::UNKNOWN;
      if (!output->write_scanlines(first, end, 0, type, strip.data())) fail(path, output->geterror());
    }
    if (!output->close()) fail(path, output->geterror());
  } catch (const base::Error&) {
    throw;
  } catch (const std::exception& error) {
    fail(path, error.what());
  }
  return bytes;
}

struct Channel {
  std::string name;
  OIIO::TypeDesc type;
  const float* values = nullptr;  // each `stride` floats one, or
  std::size_t stride = 1;
  const std::uint16_t* words = nullptr;
  const std::uint32_t* wholes = nullptr;
};

std::vector<Channel> channels_of(const Frame& frame, bool whole_floats) {
  const OIIO::TypeDesc fine = whole_floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::HALF;
  std::vector<Channel> channels;
  const auto add_colour = [&](const Image& image, std::initializer_list<const char*> names) {
    std::size_t i = 0;
    for (const char* name : names) channels.push_back({name, fine, image.pixels.data() + i++, 3});
  };
  add_colour(frame.colour, {"R", "G", "B"});
  if (!frame.depth.empty()) channels.push_back({"Z", OIIO::TypeDesc::FLOAT, frame.depth.pixels.data()});
  if (!frame.normal.empty()) add_colour(frame.normal, {"N.X", "N.Y", "N.Z"});
  if (!frame.species.empty()) {
    channels.push_back({"species", OIIO::TypeDesc::UINT32, nullptr, 1, frame.species.data()});
  }
  if (!frame.plants.empty()) {
    channels.push_back({"plant", OIIO::TypeDesc::UINT32, nullptr, 1, nullptr, frame.plants.data()});
  }
  return channels;
}

// A half ends at 65504; the sun's disc must not become infinite.
Imath::half half_of(float value) {
  constexpr float most = 65504.0f;
  return Imath::half(std::isnan(value) ? value : std::clamp(value, -most, most));
}

Bytes packed(const std::vector<Channel>& channels, std::size_t first_pixel, std::size_t end_pixel) {
  std::size_t pixel_bytes = 0;
  for (const Channel& channel : channels) pixel_bytes += channel.type.size();
  Bytes bytes((end_pixel - first_pixel) * pixel_bytes);
  std::size_t offset = 0;
  for (const Channel& channel : channels) {
    unsigned char* to = bytes.data() + offset;
    for (std::size_t i = first_pixel; i < end_pixel; ++i, to += pixel_bytes) {
      if (channel.values && channel.type == OIIO::TypeDesc::HALF) {
        const Imath::half value = half_of(channel.values[i * channel.stride]);
        std::memcpy(to, &value, sizeof value);
      } else if (channel.values) {
        std::memcpy(to, &channel.values[i * channel.stride], sizeof(float));
      } else {
        const std::uint32_t value = channel.words ? channel.words[i] : channel.wholes[i];
        std::memcpy(to, &value, sizeof value);
      }
    }
    offset += channel.type.size();
  }
  return bytes;
}

Bytes exr_of(const fs::path& path, const Frame& frame, const WriteOptions& options) {
  const std::vector<Channel> channels = channels_of(frame, options.whole_floats);
  OIIO::ImageSpec spec(frame.colour.width, frame.colour.height, static_cast<int>(channels.size()),
                       OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const Channel& channel : channels) {
    spec.channelnames.push_back(channel.name);
    spec.channelformats.push_back(channel.type);
  }
  spec.attribute("compression", "zip");
  for (const auto& [name, value] : options.metadata) spec.attribute("silva:" + name, value);
  const std::size_t width = static_cast<std::size_t>(frame.colour.width);
  return encoded(path, "openexr", spec, [&](int first, int end) {
    return packed(channels, static_cast<std::size_t>(first) * width, static_cast<std::size_t>(end) * width);
  });
}

Image rows_of(const Image& image, int first, int end) {
  Image strip;
  strip.width = image.width;
  strip.height = end - first;
  strip.channels = image.channels;
  strip.pixels.assign(image.at(0, first), image.at(0, first) + strip.height * image.width * image.channels);
  return strip;
}

Bytes shown_of(const fs::path& path, const Image& colour, Format format, const WriteOptions& options) {
  const bool words = format == Format::tiff;
  OIIO::ImageSpec spec(colour.width, colour.height, 3, words ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8);
  // For a TIFF that would become an EXIF directory, which OpenImageIO 2.4 links in the place of the picture.
  if (!words) spec.attribute("oiio:ColorSpace", "sRGB");
  if (format == Format::jpeg) spec.attribute("Compression", fmt::format("jpeg:{}", options.jpeg_quality));
  if (format == Format::tiff) spec.attribute("Compression", "zip");
  std::string description;
  for (const auto& [name, value] : options.metadata) description += name + ": " + value + "\n";
  if (!description.empty()) spec.attribute("ImageDescription", description);

  const double stops = options.exposure_stops ? *options.exposure_stops : automatic_exposure(colour);
  const auto shown = [&](int first, int end) { return tone_mapped(rows_of(colour, first, end), stops); };
  if (words) {
    return encoded(path, "tiff", spec, [&](int first, int end) { return srgb_words(shown(first, end)); });
  }
  return encoded(path, format == Format::png ? "png" : "jpeg", spec,
                 [&](int first, int end) { return srgb_bytes(shown(first, end)); });
}

}  // namespace

std::vector<fs::path> files_beside(const fs::path& path, const Frame& frame) {
  if (format_of(path) == Format::exr || !has_more_than_colour(frame)) return {};
  return {fs::path(path).replace_extension(".aov.exr")};
}

void check_writable(const fs::path& path, const WriteOptions& options) {
  format_of(path);
  base::NewFile(path, options.inputs);
}

void write(const fs::path& path, const Frame& frame, const WriteOptions& options) {
  const Format format = format_of(path);
  check(path, frame, options);
  base::NewFile picture(path, options.inputs);
  // Write all before any gets its name.
  const std::vector<fs::path> beside = files_beside(path, frame);
  const std::unique_ptr<base::NewFile> channels =
      beside.empty() ? nullptr : std::make_unique<base::NewFile>(beside[0], options.inputs);
  const auto put = [](base::NewFile& file, const Bytes& bytes) { file.write(std::as_bytes(std::span(bytes))); };
  if (channels) put(*channels, exr_of(beside[0], frame, options));
  put(picture, format == Format::exr ? exr_of(path, frame, options) : shown_of(path, frame.colour, format, options));
  if (channels) channels->commit();
  picture.commit();
}

}  // namespace silvavis::image
