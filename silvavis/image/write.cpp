#include <fmt/format.h>

#include <memory>
#include <span>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvavis/image/encode.h"
#include "silvavis/image/file.h"
#include "silvavis/image/format.h"
#include "silvavis/image/tone.h"

namespace silvavis::image {

namespace fs = std::filesystem;
namespace base = silvasim::base;

namespace {

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

Image rows_of(const Image& image, int first, int end) {
  Image strip;
  strip.width = image.width;
  strip.height = end - first;
  strip.channels = image.channels;
  strip.pixels.assign(image.at(0, first), image.at(0, first) + strip.height * image.width * image.channels);
  return strip;
}

Bytes shown_of(const Image& colour, Format format, const WriteOptions& options) {
  Shown shown{colour.width, colour.height, {}};
  for (const auto& [name, value] : options.metadata) shown.description += name + ": " + value + "\n";
  const double stops = options.exposure_stops ? *options.exposure_stops : automatic_exposure(colour);
  const auto rows = [&](int first, int end) { return tone_mapped(rows_of(colour, first, end), stops); };
  const auto bytes = [&](int first, int end) { return srgb_bytes(rows(first, end)); };
  if (format == Format::png) return png_of(shown, bytes);
  if (format == Format::jpeg) return jpeg_of(shown, options.jpeg_quality, bytes);
  return tiff_of(shown, [&](int first, int end) { return srgb_words(rows(first, end)); });
}

Bytes bytes_of(const fs::path& path, const Frame& frame, const WriteOptions& options) {
  try {
    const Format format = format_of(path);
    if (format != Format::exr) return shown_of(frame.colour, format, options);
    std::map<std::string, std::string> attributes;
    for (const auto& [name, value] : options.metadata) attributes["silva:" + name] = value;
    return exr_of(frame, options.whole_floats, attributes);
  } catch (const base::Error& error) {
    fail(path, error.what());
  }
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
  check(path, frame, options);
  base::NewFile picture(path, options.inputs);
  // Write all before any gets its name.
  const std::vector<fs::path> beside = files_beside(path, frame);
  const std::unique_ptr<base::NewFile> channels =
      beside.empty() ? nullptr : std::make_unique<base::NewFile>(beside[0], options.inputs);
  const auto put = [](base::NewFile& file, const Bytes& bytes) { file.write(std::as_bytes(std::span(bytes))); };
  if (channels) put(*channels, bytes_of(beside[0], frame, options));
  put(picture, bytes_of(path, frame, options));
  if (channels) channels->commit();
  picture.commit();
}

}  // namespace silvavis::image
