// Text on pictures: how wide it is, where it breaks, how numbers read.
//
// Threads: any.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "silvasim/base/words.h"

namespace silvasim::exports {

struct Font {
  double size_px = 12;
  bool bold = false;
  bool italic = false;
};

// The family asked for; fontconfig (PNG) or the viewer (SVG) fall back to another sans-serif. Verdana is as wide.
inline constexpr const char* font_family = "DejaVu Sans";
inline constexpr const char* font_families = "'DejaVu Sans',Verdana,sans-serif";

double width_px(const std::string& text, const Font& font);

// Cuts at a character and adds an ellipsis until the text fits.
std::string fitted(const std::string& text, const Font& font, double most_px);

// Breaks at spaces; a single word that is too long is cut.
std::vector<std::string> wrapped(const std::string& text, const Font& font, double most_px);

using base::printable;

std::string xml_escaped(const std::string& text);  // printable, with &, <, >, " and ' as entities

std::string grouped(std::uint64_t number);         // "1 234 567" with thin spaces
std::string grouped(double number, int decimals);  // "-1 234.50" with a true minus
std::string length(double metres);                 // "250 m", "1.5 km", "20 cm"; any double
std::string percent(double share);                 // "12.3 %", "< 0.1 %"

// The largest of 1, 2 and 5 times a power of ten that is not larger than `most` (> 0).
double round_length(double most);

// "picea-abies": ASCII letters, digits and hyphens; "species" where nothing is left.
std::string slug(const std::string& name);

}  // namespace silvasim::exports
