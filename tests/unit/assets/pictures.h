// Pictures made for tests, written by OpenImageIO.
#pragma once

#include <OpenImageIO/imageio.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace assets::test {

using Pixel = std::array<std::uint8_t, 4>;

inline void write_picture(const std::filesystem::path& file, int width, int height, int channels,
                          const std::function<Pixel(int, int)>& pixel) {
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Pixel p = pixel(x, y);
      if (channels == 2) {
        bytes.push_back(p[0]);
        bytes.push_back(p[3]);
      } else {
        bytes.insert(bytes.end(), p.begin(), p.begin() + channels);
      }
    }
  }
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  if (channels == 2) {
    spec.channelnames = {"Y", "A"};
    spec.alpha_channel = 1;
  }
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const auto out = OIIO::ImageOutput::create(file.string());
  if (!out || !out->open(file.string(), spec) || !out->write_image(OIIO::TypeDesc::UINT8, bytes.data()) ||
      !out->close()) {
    throw std::runtime_error("cannot write " + file.string());
  }
}

// A fixed scatter of 32 bits.
inline std::uint32_t scatter(std::uint32_t a, std::uint32_t b) {
  std::uint32_t h = a * 0x9E3779B1u ^ (b + 0x7F4A7C15u) * 0x85EBCA6Bu;
  h = (h ^ (h >> 15)) * 0xC2B2AE35u;
  return h ^ (h >> 16);
}

}  // namespace assets::test
