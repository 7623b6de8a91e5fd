#include "silvasim/export/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "silvasim/base/error.h"
#include "silvasim/export/heat.h"
#include "silvasim/export/legend.h"
#include "silvasim/export/place_text.h"

namespace silvasim::exports {

namespace {

constexpr int least_width_px = 16, least_decorated_px = 240, most_px = 20'000;
constexpr const char* separator = "\u2002·\u2002";

std::string title_of(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options, const Census& census) {
  if (!options.title.empty()) return printable(options.title);
  std::string title = ecosystem.name.empty() ? "Plant population" : ecosystem.name;
  if (options.subject == Subject::probability) {
    title += ": growth probability";
    if (options.species.size() == 1) title += " of " + options.species.front();
  }
  if (options.subject == Subject::suitability) title += ": " + heat_title(ecosystem, census, options);
  return printable(title);
}

// Lines of parts with separators between them, broken between parts where they can be.
std::vector<std::string> lines_of(const std::vector<std::string>& parts, const Font& font, double most_px_wide) {
  std::vector<std::string> lines;
  for (const std::string& part : parts) {
    const std::string longer = lines.empty() ? part : lines.back() + separator + part;
    if (!lines.empty() && width_px(longer, font) <= most_px_wide) {
      lines.back() = longer;
    } else {
      lines.push_back(fitted(part, font, most_px_wide));
    }
  }
  return lines;
}

// The least of 1, 2 and 5 times a power of ten that is not smaller than `least` (> 0).
double round_step(double least) {
  const double below = round_length(least);
  return below >= least ? below : round_length(below * 2.5);
}

// The frame with ticks at round coordinates, labels south and west of it.
Part frame_part(const ecosystem::Ecosystem& ecosystem, const Layout& layout, double u) {
  Part part{"frame", {}};
  const View& view = layout.view;
  const double x0 = layout.map_x, y0 = layout.map_y;
  // Where the view is larger than the planted land, show the land's border.
  const base::Box& land = ecosystem.extent;
  const double slack = 1 / view.px_per_m();
  if (view.box.west < land.west - slack || view.box.south < land.south - slack || view.box.east > land.east + slack ||
      view.box.north > land.north + slack) {
    const double left = std::max(0.0, view.x_px(land.west)), top = std::max(0.0, view.y_px(land.north));
    const double right = std::min<double>(view.width_px, view.x_px(land.east));
    const double bottom = std::min<double>(view.height_px, view.y_px(land.south));
    part.marks.push_back(Rectangle{x0 + left, y0 + top, right - left, bottom - top, {}, faint_colour, 1 * u, true});
  }
  part.marks.push_back(Rectangle{x0 - 0.5 * u, y0 - 0.5 * u, view.width_px + u, view.height_px + u, {}, ink_colour, u});

  const Font font{11.5 * u};
  const auto label = [](double value, double step) {
    return grouped(value, std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 6));
  };
  const auto ticks = [&](double from, double to, double px_per_m, auto&& draw) {
    // The longer of the outermost labels tells how dense the ticks may stand.
    const double span = to - from;
    const double widest = std::max(width_px(label(from, span / 5), font), width_px(label(to, span / 5), font));
    const double step = round_step(std::max(130 * u, 1.7 * widest) / px_per_m);
    const double first = std::ceil(from / step), last = std::floor(to / step);
    for (double k = first; k <= last; ++k) draw(k * step, label(k * step, step));
  };
  ticks(view.box.west, view.box.east, view.px_per_m(), [&](double value, const std::string& text) {
    const double x = x0 + view.x_px(value), bottom = y0 + view.height_px, half = width_px(text, font) / 2;
    part.marks.push_back(Line{x, bottom, x, bottom + 6 * u, ink_colour, u});
    part.marks.push_back(Line{x, y0, x, y0 - 6 * u, ink_colour, u});
    if (x - half < x0 - 40 * u || x + half > x0 + view.width_px + 16 * u) return;
    part.marks.push_back(Text{x, bottom + 20 * u, text, font, faint_colour, Anchor::middle});
  });
  ticks(view.box.south, view.box.north, view.height_px / view.box.height(), [&](double value, const std::string& text) {
    const double y = y0 + view.y_px(value), right = x0 + view.width_px, half = width_px(text, font) / 2;
    part.marks.push_back(Line{x0 - 6 * u, y, x0, y, ink_colour, u});
    part.marks.push_back(Line{right, y, right + 6 * u, y, ink_colour, u});
    if (y - half < y0 - 6 * u || y + half > y0 + view.height_px + 6 * u) return;
    part.marks.push_back(Text{x0 - 10 * u, y, text, font, faint_colour, Anchor::middle, true});
  });
  return part;
}

// A bar of two parts with round lengths.
Part scale_part(const View& view, double x, double y, double most_bar_px, double u) {
  Part part{"scale-bar", {}};
  // A single digit's length comes closest to the room there is.
  const double most_m = most_bar_px / view.px_per_m(), power = std::pow(10.0, std::floor(std::log10(most_m)));
  const double metres = std::min(std::floor(most_m / power + 1e-9), 5.0) * power;
  const double bar = metres * view.px_per_m(), tall = 7 * u;
  part.marks.push_back(Rectangle{x, y, bar / 2, tall, ink_colour, ink_colour, u});
  part.marks.push_back(Rectangle{x + bar / 2, y, bar / 2, tall, page_colour, ink_colour, u});
  const Font font{12 * u};
  // The half keeps the unit of the whole: 0, 0.5, 1 km.
  const std::string whole = length(metres);
  const double unit = whole.ends_with(" km") ? 1000 : whole.ends_with(" cm") ? 0.01 : 1;
  const std::string half = fmt::format("{:.4g}", metres / 2 / unit);
  part.marks.push_back(Text{x, y - 6 * u, "0", font, ink_colour});
  const double zero_px = width_px("0", font), half_px = width_px(half, font), whole_px = width_px(whole, font);
  if (bar / 2 > std::max(zero_px + half_px / 2, (half_px + whole_px) / 2) + 6 * u) {
    part.marks.push_back(Text{x + bar / 2, y - 6 * u, half, font, ink_colour, Anchor::middle});
  }
  if (bar > zero_px + whole_px / 2 + 6 * u) {
    part.marks.push_back(Text{x + bar, y - 6 * u, whole, font, ink_colour, Anchor::middle});
  }
  return part;
}

// Its foot at (x, y), as wide as 24 and as tall as 54 units.
Part north_part(double x, double y, double u) {
  Part part{"north-arrow", {}};
  const double top = y - 38 * u;
  part.marks.push_back(Triangle{x, top, x - 10 * u, y, x, y - 8 * u, ink_colour, ink_colour, u});
  part.marks.push_back(Triangle{x, top, x + 10 * u, y, x, y - 8 * u, page_colour, ink_colour, u});
  part.marks.push_back(Text{x, top - 5 * u, "N", Font{15 * u, true}, ink_colour, Anchor::middle});
  return part;
}

}  // namespace

Layout make_layout(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options, const Census& census,
                   const base::Box& box, const std::function<std::string(const View&)>& caption) {
  const int least = options.decorated ? least_decorated_px : least_width_px;
  if (options.width_px < least || options.width_px > most_px) {
    throw base::ConfigError({"--width"},
                            fmt::format("{} pixels are out of range; give {} to {}", options.width_px, least, most_px));
  }
  Layout layout;
  layout.width_px = options.width_px;
  layout.view.box = box;
  layout.title = title_of(ecosystem, options, census);
  const double width = options.width_px, aspect = box.width() / box.height();
  if (!options.decorated) {
    const double height = std::round(width / aspect);
    if (height > most_px) {
      throw base::ConfigError({"--width"}, fmt::format("the map would be {:.0f} pixels tall; at most {} pixels wide it "
                                                       "stays below {}",
                                                       height, std::floor(most_px * aspect), most_px));
    }
    layout.height_px = std::max(1, static_cast<int>(height));
    layout.view.width_px = options.width_px;
    layout.view.height_px = layout.height_px;
    return layout;
  }

  // Sizes follow the width, but text stays readable on small pictures.
  const double u = std::max(width / 1600, 0.72);
  const double margin = 44 * u, left = margin + 24 * u, gap = 36 * u;
  Part head{"title", {}};
  Font title{30 * u, true};
  const double text_px = width - margin - left;
  while (title.size_px > 17 * u && width_px(layout.title, title) > text_px) title.size_px -= 0.5 * u;
  double y = margin + 26 * u;
  head.marks.push_back(Text{left, y, fitted(layout.title, title, text_px), title, ink_colour});
  const Font sub{14 * u};
  for (const std::string& line : lines_of(place_of(ecosystem, box), sub, text_px)) {
    y += 24 * u;
    head.marks.push_back(Text{left, y, line, sub, faint_colour});
  }
  layout.map_x = static_cast<int>(std::lround(left));
  layout.map_y = static_cast<int>(std::lround(y + 26 * u));

  // The legend stands beside the map, or below it where the land is wide or the picture small.
  const Legend legend(ecosystem, census, options.subject, u);
  // A legend much taller than the map
  // would leave a hole in the page: it goes below, too.
  const double beside_column = std::clamp(legend.natural_width_px(), 270 * u, 0.34 * width);
  const double beside_height = std::min((width - left - gap - beside_column - margin) / aspect, 1.15 * width);
  const bool beside = width >= 760 && aspect < 2.4 && legend.height_px() + 90 * u < 1.3 * beside_height;
  double column = beside ? beside_column : std::clamp(legend.natural_width_px(), 270 * u, text_px);
  const double room = beside ? width - left - gap - column - margin : text_px;
  const double tallest = std::min(1.15 * width, double(most_px));
  double map_width = std::max(1.0, std::floor(room));
  if (map_width / aspect > tallest) map_width = std::max(1.0, std::floor(tallest * aspect));
  layout.view.width_px = static_cast<int>(map_width);
  layout.view.height_px = static_cast<int>(std::clamp(std::round(map_width / aspect), 1.0, tallest));
  const double map_right = layout.map_x + layout.view.width_px, map_bottom = layout.map_y + layout.view.height_px;

  Part entries{"legend", {}};
  double bottom = map_bottom + 24 * u;
  if (beside) {
    const double x = map_right + gap, block = 66 * u;
    // A narrow map leaves the legend more room than it needs.
    const double most = std::max<double>(layout.view.height_px - block - 20 * u, width - block);
    const double end = legend.draw(entries, x, layout.map_y, column, 1, 0, most);
    const double foot = std::max(map_bottom, end + block + 12 * u);
    layout.parts.push_back(scale_part(layout.view, x + 46 * u, foot - 8 * u, std::min(column - 74 * u, 240 * u), u));
    layout.parts.push_back(north_part(x + 12 * u, foot, u));
    bottom = std::max(bottom, foot);
  } else {
    const double foot = bottom + 70 * u;
    layout.parts.push_back(scale_part(layout.view, layout.map_x + 46 * u, foot - 8 * u,
                                      std::min(width - layout.map_x - margin - 90 * u, 300 * u), u));
    layout.parts.push_back(north_part(layout.map_x + 12 * u, foot, u));
    const double span = width - layout.map_x - margin;
    const int columns = std::max(1, static_cast<int>((span + gap) / (column + gap)));
    if (columns == 1) column = std::min(column, span);
    bottom = legend.draw(entries, layout.map_x, foot + 26 * u, column, columns, gap, 1.2 * width);
  }

  // Below all: how the map is drawn, and where it comes from.
  Part foot{"caption", {}};
  const Font small{11.5 * u};
  const double span = width - margin - layout.map_x;
  y = bottom + 12 * u;
  for (const std::string& line : wrapped(caption(layout.view), small, span)) {
    y += 17 * u;
    foot.marks.push_back(Text{double(layout.map_x), y, line, small, faint_colour});
  }
  for (const std::string& line : lines_of(origin_of(ecosystem), small, span)) {
    y += 17 * u;
    foot.marks.push_back(Text{double(layout.map_x), y, line, small, faint_colour});
  }
  layout.parts.push_back(frame_part(ecosystem, layout, u));
  layout.parts.push_back(std::move(head));
  layout.parts.push_back(std::move(entries));
  layout.parts.push_back(std::move(foot));
  layout.height_px = static_cast<int>(std::ceil(y + margin));
  return layout;
}

}  // namespace silvasim::exports
