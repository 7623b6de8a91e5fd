#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "silvasim/base/error.h"
#include "silvavis/image/encode.h"

namespace silvavis::image {

namespace {

class Memory : public Imf::OStream {
 public:
  explicit Memory(Bytes& bytes) : Imf::OStream("picture"), bytes_(bytes) {}
  void write(const char* from, int count) override {
    const std::size_t end = at_ + static_cast<std::size_t>(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + at_, from, static_cast<std::size_t>(count));
    at_ = end;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }

 private:
  Bytes& bytes_;
  std::size_t at_ = 0;
};

struct Channel {
  std::string name;
  Imf::PixelType type;
  const float* values = nullptr;  // each `stride` floats one, or
  std::size_t stride = 1;
  const std::uint16_t* words = nullptr;
  const std::uint32_t* wholes = nullptr;

  std::size_t bytes() const { return type == Imf::HALF ? 2 : 4; }
};

std::vector<Channel> channels_of(const Frame& frame, bool whole_floats) {
  const Imf::PixelType fine = whole_floats ? Imf::FLOAT : Imf::HALF;
  std::vector<Channel> channels;
  const auto add_colour = [&](const Image& image, std::initializer_list<const char*> names) {
    std::size_t i = 0;
    for (const char* name : names) channels.push_back({name, fine, image.pixels.data() + i++, 3});
  };
  add_colour(frame.colour, {"R", "G", "B"});
  if (!frame.depth.empty()) channels.push_back({"Z", Imf::FLOAT, frame.depth.pixels.data()});
  if (!frame.normal.empty()) add_colour(frame.normal, {"N.X", "N.Y", "N.Z"});
  if (!frame.species.empty()) channels.push_back({"species", Imf::UINT, nullptr, 1, frame.species.data()});
  if (!frame.plants.empty()) channels.push_back({"plant", Imf::UINT, nullptr, 1, nullptr, frame.plants.data()});
  return channels;
}

// A half ends at 65504; the sun's disc must not become infinite.
Imath::half half_of(float value) {
  constexpr float most = 65504.0f;
  return Imath::half(std::isnan(value) ? value : std::clamp(value, -most, most));
}

// Channel after channel, as the file wants them.
Bytes packed(const std::vector<Channel>& channels, std::size_t first_pixel, std::size_t end_pixel) {
  Bytes bytes;
  for (const Channel& channel : channels) {
    std::size_t at = bytes.size();
    bytes.resize(at + (end_pixel - first_pixel) * channel.bytes());
    const auto put = [&](const auto& value) {
      std::memcpy(bytes.data() + at, &value, sizeof value);
      at += sizeof value;
    };
    for (std::size_t i = first_pixel; i < end_pixel; ++i) {
      if (channel.type == Imf::HALF) {
        put(half_of(channel.values[i * channel.stride]));
      } else if (channel.values) {
        put(channel.values[i * channel.stride]);
      } else {
        put(channel.words ? std::uint32_t{channel.words[i]} : channel.wholes[i]);
      }
    }
  }
  return bytes;
}

}  // namespace

Bytes exr_of(const Frame& frame, bool whole_floats, const std::map<std::string, std::string>& attributes) {
  const std::vector<Channel> channels = channels_of(frame, whole_floats);
  const int width = frame.colour.width, height = frame.colour.height;
  std::size_t pixel_bytes = 0;
  for (const Channel& channel : channels) pixel_bytes += channel.bytes();
  Bytes bytes;
  // Pages that stay empty cost nothing.
  bytes.reserve(pixel_bytes * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  try {
    Imf::Header header(width, height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const Channel& channel : channels) header.channels().insert(channel.name, Imf::Channel(channel.type));
    for (const auto& [name, value] : attributes) header.insert(name, Imf::StringAttribute(value));
    Memory memory(bytes);
    Imf::OutputFile file(memory, header, 0);
    for (int first = 0; first < height; first += strip_rows) {
      const int end = std::min(first + strip_rows, height);
      const auto row = static_cast<std::size_t>(width);
      Bytes strip = packed(channels, static_cast<std::size_t>(first) * row, static_cast<std::size_t>(end) * row);
      Imf::FrameBuffer buffer;
      char* at = reinterpret_cast<char*>(strip.data());
      const Imath::Box2i rows(Imath::V2i(0, first), Imath::V2i(width - 1, end - 1));
      for (const Channel& channel : channels) {
        buffer.insert(channel.name, Imf::Slice::Make(channel.type, at, rows, channel.bytes(), channel.bytes() * row));
        at += channel.bytes() * row * static_cast<std::size_t>(end - first);
      }
      file.setFrameBuffer(buffer);
      file.writePixels(end - first);
    }
  } catch (const std::exception& error) {
    throw silvasim::base::Error(error.what());
  }
  return bytes;
}

}  // namespace silvavis::image
