#include "silvasim/export/text.h"

#include <cairo.h>
#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace silvasim::exports {

namespace {

constexpr const char* thin_space = "\u2009";

struct Ruler {
  using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
  using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;
  Surface surface{cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1), &cairo_surface_destroy};
  Context context{cairo_create(surface.get()), &cairo_destroy};

  double measure(const std::string& text, const Font& font) {
    cairo_select_font_face(context.get(), font_family, font.italic ? CAIRO_FONT_SLANT_ITALIC : CAIRO_FONT_SLANT_NORMAL,
                           font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context.get(), font.size_px);
    // Unhinted advances grow in proportion to the size, and SVG viewers use them too.
    cairo_font_options_t* plain = cairo_font_options_create();
    cairo_font_options_set_hint_metrics(plain, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_hint_style(plain, CAIRO_HINT_STYLE_NONE);
    cairo_set_font_options(context.get(), plain);
    cairo_font_options_destroy(plain);
    cairo_text_extents_t extents{};
    cairo_text_extents(context.get(), text.c_str(), &extents);
    return extents.x_advance;
  }
};

}  // namespace

double width_px(const std::string& text, const Font& font) {
  thread_local Ruler ruler;
  return ruler.measure(text, font);
}

std::string fitted(const std::string& text, const Font& font, double most_px) {
  if (width_px(text, font) <= most_px) return text;
  // Bisect the number of characters that fit before the ellipsis.
  std::vector<std::size_t> ends = {0};
  while (ends.back() < text.size()) {
    ends.push_back(ends.back() + std::max<std::size_t>(1, base::character_length(text, ends.back())));
  }
  std::size_t fits = 0, too_long = ends.size();
  while (too_long - fits > 1) {
    const std::size_t middle = (fits + too_long) / 2;
    (width_px(text.substr(0, ends[middle]) + "…", font) <= most_px ? fits : too_long) = middle;
  }
  std::string cut = text.substr(0, ends[fits]);
  while (!cut.empty() && cut.back() == ' ') cut.pop_back();
  return cut + "…";
}

std::vector<std::string> wrapped(const std::string& text, const Font& font, double most_px) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = std::min(text.find(' ', i), text.size());
    const std::string word = text.substr(i, end - i);
    i = end + 1;
    if (word.empty()) continue;
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && width_px(longer, font) > most_px) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
  }
  if (!line.empty()) lines.push_back(line);
  for (std::string& each : lines) each = fitted(each, font, most_px);
  return lines;
}

std::string xml_escaped(const std::string& text) {
  std::string escaped;
  for (const char c : printable(text)) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string grouped(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += thin_space;
    text += digits[i];
  }
  return text;
}

std::string grouped(double number, int decimals) {
  if (!(std::fabs(number) < 1e15)) return fmt::format("{:.6g}", number);
  const std::string plain = fmt::format("{:.{}f}", std::fabs(number), decimals);
  const std::size_t point = std::min(plain.find('.'), plain.size());
  const std::string text = grouped(std::stoull(plain.substr(0, point))) + plain.substr(point);
  const bool zero = plain.find_first_of("123456789") == std::string::npos;
  return (number < 0 && !zero ? "\u2212" : "") + text;
}

std::string length(double metres) {
  // Three digits are plenty; trailing zeros go.
  const auto number = [](double value) {
    std::string digits = fmt::format("{:.{}f}", value, value >= 100 ? 0 : value >= 10 ? 1 : 2);
    if (digits.find('.') != std::string::npos) digits.erase(digits.find_last_not_of('0') + 1);
    if (!digits.empty() && digits.back() == '.') digits.pop_back();
    const std::size_t point = std::min(digits.find('.'), digits.size());
    return grouped(static_cast<std::uint64_t>(std::stoull(digits.substr(0, point)))) + digits.substr(point);
  };
  if (!(metres < 1e15)) return fmt::format("{:.3g} m", metres);
  if (metres >= 999.5) return number(metres / 1000) + " km";
  if (metres >= 0.995) return number(metres) + " m";
  if (metres >= 0.01) return number(metres * 100) + " cm";
  return fmt::format("{:.3g} m", metres);
}

std::string percent(double share) {
  if (!(share > 0)) return "0 %";
  if (share < 0.0005) return "< 0.1 %";
  return fmt::format("{:.1f} %", share * 100);
}

double round_length(double most) {
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= most * (1 + 1e-9)) return factor * power;
  }
  return power;
}

std::string slug(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const bool upper = c >= 'A' && c <= 'Z';
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (plain || upper) {
      text += upper ? static_cast<char>(c - 'A' + 'a') : c;
    } else if (!text.empty() && text.back() != '-') {
      text += '-';
    }
  }
  while (!text.empty() && text.back() == '-') text.pop_back();
  return text.empty() ? "species" : text;
}

}  // namespace silvasim::exports
