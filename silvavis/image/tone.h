// Tone mapping: from light to what a screen shows.
//
// Exposure is in stops: the light is multiplied by 2^stops, so that 0 shows a grey card (0.18) in noon sun as a grey
// card. The curve keeps shadows near to linear, and rolls highlights off to white instead of clipping them.
// Promise: pure functions; the same bits on every machine and any thread count. NaN becomes black.
// Threads: any; tone_mapped() works in parallel inside. Cost: 2 million pixels in about 0.2 s on one core.
// Source: docs/light.md.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "silvavis/image/image.h"

namespace silvavis::image {

// Stops that show the picture well: the mean of the logarithms of luminance, without the darkest and the brightest
// pixels, becomes 0.25, a little lighter than a grey card, by day, dark woods a little less; the less light there is in cd/m2, the darker it stays, as for
// eyes that do not wholly get used to it (Krawczyk, Myszkowski and Seidel 2005, equation 11). Black and empty pictures give 0.
//
// For a flight ask once, for one frame or several of them, and give the answer to every frame: then nothing flickers.
double automatic_exposure(std::span<const Image> images);
double automatic_exposure(const Image& image);

// The pixels that do not show the sky, in a row; all where there are few others, or no depth to tell them by.
Image land_of(const Frame& frame);

// One colour, linear in and linear out, in [0, 1].
Rgb tone_mapped(const Rgb& light, float scale);

// 3 channels, linear, in [0, 1].
Image tone_mapped(const Image& light, double exposure_stops);

// IEC 61966-2-1. Encoding takes [0, 1]; what lies outside is clamped.
float srgb_encoded(float linear);
float srgb_decoded(float encoded);
std::vector<std::uint8_t> srgb_bytes(const Image& linear);   // rounded
std::vector<std::uint16_t> srgb_words(const Image& linear);  // rounded

}  // namespace silvavis::image
