#include "silvasim/export/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "silvasim/export/ground.h"

namespace silvasim::exports {

namespace {

constexpr std::size_t most_two_line_entries = 12;

std::string plants_text(std::uint64_t plants) { return grouped(plants) + (plants == 1 ? " plant" : " plants"); }

}  // namespace

Legend::Legend(const ecosystem::Ecosystem& ecosystem, const Census& census, Subject subject, double unit_px)
    : subject_(subject), unit_px_(unit_px) {
  std::size_t entries = 0;
  for (const auto& layer : census.layers) {
    entries += static_cast<std::size_t>(std::count_if(layer.begin(), layer.end(), [](auto& c) { return c.shown; }));
  }
  two_lines_ = entries <= most_two_line_entries;
  const bool of_place = subject == Subject::suitability;
  const auto put = [&](Row::Kind kind, std::string first, std::string second = {}) -> Row& {
    Row row;
    row.kind = kind;
    row.first = std::move(first);
    row.second = std::move(second);
    rows_.push_back(std::move(row));
    return rows_.back();
  };
  if (subject == Subject::probability) put(Row::Kind::ramp, "Growth probability");
  if (of_place) put(Row::Kind::ramp, "Suitability of the place");
  if (ecosystem.layers.size() != 1) put(Row::Kind::heading, of_place ? "Mean of the map" : plants_text(census.plants));
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    const ecosystem::Layer& layer = ecosystem.layers[l];
    std::vector<std::size_t> order;
    std::uint64_t plants = 0;
    for (std::size_t s = 0; s < layer.species.size(); ++s) {
      if (!census.layers[l][s].shown) continue;
      order.push_back(s);
      plants += census.layers[l][s].plants;
    }
    if (order.empty()) continue;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const SpeciesCount &first = census.layers[l][a], &second = census.layers[l][b];
      return of_place ? first.mean_suitability > second.mean_suitability : first.plants > second.plants;
    });
    const bool apart = !rows_.empty() && rows_.back().kind == Row::Kind::entry;
    if (ecosystem.layers.size() == 1) {
      put(Row::Kind::heading, of_place ? "Mean of the map" : plants_text(plants));
    } else {
      put(Row::Kind::heading, printable(layer.name), of_place ? "" : grouped(plants)).apart = apart;
    }
    for (const std::size_t s : order) {
      const SpeciesCount& count = census.layers[l][s];
      Row row;
      row.first = printable(layer.species[s].common_name);
      row.second = printable(layer.species[s].name);
      row.colour = layer.species[s].colour;
      row.plants = count.plants;
      row.number = of_place ? fmt::format("{:.2f}", count.mean_suitability) : grouped(count.plants);
      row.faint = of_place ? count.mean_suitability <= 0 : count.plants == 0;
      if (of_place) {
        // The mean says all.
      } else if (subject == Subject::probability) {
        row.aside = count.plants == 0 ? "" : fmt::format("mean {:.2f}", count.mean_probability);
      } else {
        row.aside =
            percent(census.plants == 0 ? 0 : static_cast<double>(count.plants) / static_cast<double>(census.plants));
      }
      rows_.push_back(row);
    }
  }

  // Measure what the entries need.
  const Font name{(two_lines_ ? 15 : 13) * unit_px}, small{13 * unit_px}, italic{13 * unit_px, false, true};
  double names = 0;
  for (const Row& row : rows_) {
    if (row.kind == Row::Kind::heading) {
      const Font heading{15 * unit_px, true};
      names = std::max(names, width_px(row.first, heading) - 40 * unit_px);
    }
    if (row.kind != Row::Kind::entry) continue;
    numbers_px_ = std::max(numbers_px_, width_px(row.number, name));
    asides_px_ = std::max(asides_px_, width_px(row.aside, small));
    const double first = width_px(row.first, name), second = width_px(row.second, italic);
    names =
        std::max(names, two_lines_ ? std::max(first, second) : first + second + (row.first.empty() ? 0 : 8 * unit_px));
  }
  const double numbers = two_lines_ ? std::max(numbers_px_, asides_px_) : numbers_px_ + asides_px_ + 12 * unit_px;
  natural_width_px_ = 28 * unit_px + names + 20 * unit_px + numbers + 1;
}

double Legend::height_px() const {
  double total = 0;
  for (const Row& row : rows_) total += height_px(row);
  return total;
}

double Legend::height_px(const Row& row) const {
  switch (row.kind) {
    case Row::Kind::heading:
      return ((two_lines_ ? 36 : 30) + (row.apart ? 12 : 0)) * unit_px_;
    case Row::Kind::ramp:
      return (subject_ == Subject::suitability ? 100 : 74) * unit_px_;
    default:
      return (two_lines_ ? 45 : 23) * unit_px_;
  }
}

double Legend::draw(Part& part, double x, double y, double column_px, int columns, double gap_px,
                    double most_height_px) const {
  // Side by side, columns share the first heading.
  std::size_t begin = 0;
  if (columns > 1) {
    const double span = columns * (column_px + gap_px) - gap_px;
    const double used = std::min(span, rows_.size() > 4 ? span : column_px);
    for (bool heading = false; begin < rows_.size() && !heading;) {
      const Row& row = rows_[begin++];
      heading = row.kind == Row::Kind::heading;
      draw_row(part, row, x, y, heading ? used : column_px);
      y += height_px(row);
      most_height_px -= height_px(row);
    }
  }
  // Use the least height at which all rows fit into the columns, so that columns come out even.
  const auto pour = [&](double height, auto&& place) {
    int column = 0;
    double used = 0;
    for (std::size_t i = begin; i < rows_.size(); ++i) {
      // A heading goes with its first entry.
      const bool leads = rows_[i].kind == Row::Kind::heading && i + 1 < rows_.size();
      const double needed = height_px(rows_[i]) + (leads ? height_px(rows_[i + 1]) : 0);
      if (used > 0 && used + needed > height) {
        ++column;
        used = 0;
      }
      if (column >= columns) return i;
      place(i, column, used);
      used += height_px(rows_[i]);
    }
    return rows_.size();
  };
  const auto nowhere = [](std::size_t, int, double) {};
  double total = 0;
  for (std::size_t i = begin; i < rows_.size(); ++i) total += height_px(rows_[i]);
  const bool leads = begin < rows_.size() && rows_[begin].kind == Row::Kind::heading;
  double height = std::max(total / columns, height_px(Row{}) + (leads ? height_px(rows_[begin]) : 0));
  while (height < most_height_px && pour(height, nowhere) < rows_.size()) height += 4 * unit_px_;
  height = std::min(height, most_height_px);

  // Where not all fit, the last place tells how many are missing.
  std::size_t fits = pour(height, nowhere);
  Row more;
  more.kind = Row::Kind::more;
  if (fits < rows_.size()) {
    fits = fits > begin ? fits - 1 : begin;
    std::size_t species = 0;
    std::uint64_t plants = 0;
    for (std::size_t i = fits; i < rows_.size(); ++i) {
      if (rows_[i].kind != Row::Kind::entry) continue;
      ++species;
      plants += rows_[i].plants;
    }
    more.first = fmt::format("and {} more species", species);
    if (subject_ != Subject::suitability) more.number = grouped(plants);
  }
  double bottom = y;
  pour(height, [&](std::size_t i, int column, double used) {
    if (i > fits) return;
    const Row& row = i < fits ? rows_[i] : more;
    draw_row(part, row, x + column * (column_px + gap_px), y + used, column_px);
    bottom = std::max(bottom, y + used + height_px(row));
  });
  return bottom;
}

void Legend::draw_row(Part& part, const Row& row, double x, double y, double width) const {
  const double u = unit_px_;
  switch (row.kind) {
    case Row::Kind::heading: {
      const Font font{15 * u, true};
      if (row.apart) y += 12 * u;
      const double aside = row.second.empty() ? 0 : width_px(row.second, font);
      part.marks.push_back(Text{x, y + 16 * u, fitted(row.first, font, width - aside - 10 * u), font, ink_colour});
      if (aside > 0) part.marks.push_back(Text{x + width, y + 16 * u, row.second, font, ink_colour, Anchor::end});
      part.marks.push_back(Line{x, y + 24 * u, x + width, y + 24 * u, rule_colour, 0.8 * u});
      return;
    }
    case Row::Kind::ramp: {
      const Font font{15 * u, true}, label{12 * u};
      part.marks.push_back(Text{x, y + 16 * u, fitted(row.first, font, width), font, ink_colour});
      // Whole pixels, because soft rims between the steps would show as stripes.
      const double left = std::round(x), top = std::round(y + 25 * u), tall = std::round(14 * u);
      const int across = std::max(1, static_cast<int>(std::min(width, 300 * u)));
      const int steps = std::min(across, 128);
      for (int i = 0; i < steps; ++i) {
        const double from = std::round(double(i) * across / steps), to = std::round(double(i + 1) * across / steps);
        part.marks.push_back(Rectangle{left + from, top, to - from, tall, ramp((i + 0.5) / steps), {}});
      }
      part.marks.push_back(Rectangle{left, top, double(across), tall, {}, faint_colour, 0.8 * u});
      for (int i = 0; i <= 2; ++i) {
        const Anchor anchor = i == 0 ? Anchor::start : i == 1 ? Anchor::middle : Anchor::end;
        part.marks.push_back(Text{left + across * i / 2.0, top + tall + 15 * u, fmt::format("{:g}", i / 2.0), label,
                                  faint_colour, anchor});
      }
      if (subject_ == Subject::suitability) {
        const double y2 = top + tall + 27 * u;
        part.marks.push_back(Rectangle{left, y2, 22 * u, tall, paper_colour, faint_colour, 0.8 * u});
        part.marks.push_back(Text{left + 30 * u, y2 + 12 * u, fitted("bare ground: cannot grow", label, width - 30 * u),
                                  label, faint_colour});
      }
      return;
    }
    case Row::Kind::more: {
      const Font font{13 * u};
      const double numbers = width_px(row.number, font);
      const double right = x + width - (two_lines_ || asides_px_ == 0 ? 0 : asides_px_ + 12 * u);
      part.marks.push_back(
          Text{x + 28 * u, y + 15 * u, fitted(row.first, font, right - numbers - x - 40 * u), font, faint_colour});
      part.marks.push_back(Text{right, y + 15 * u, row.number, font, faint_colour, Anchor::end});
      return;
    }
    case Row::Kind::entry:
      draw_entry(part, row, x, y, width);
      return;
  }
}

void Legend::draw_entry(Part& part, const Row& row, double x, double y, double width) const {
  const double u = unit_px_;
  const Colour ink = row.faint ? faint_colour : ink_colour;
  const Font name{(two_lines_ ? 15 : 13) * u}, italic{13 * u, false, true}, small{13 * u};
  const double radius = (two_lines_ ? 8.5 : 6.5) * u;
  if (subject_ == Subject::species) {
    part.marks.push_back(
        Circle{x + 9 * u, y + (two_lines_ ? 21 : 10.5) * u, radius, row.colour, darker(row.colour), 1.2 * u});
  }
  const double left = x + (subject_ == Subject::species ? 28 * u : 0);
  if (two_lines_) {
    const double room = x + width - left - 16 * u;
    const double first = room - width_px(row.number, name), second = room - width_px(row.aside, small);
    // A species without a common name moves its scientific one up.
    if (row.first.empty()) {
      const Font large{15 * u, false, true};
      part.marks.push_back(Text{left, y + 15 * u, fitted(row.second, large, first), large, ink});
    } else {
      part.marks.push_back(Text{left, y + 15 * u, fitted(row.first, name, first), name, ink});
      part.marks.push_back(Text{left, y + 33 * u, fitted(row.second, italic, second), italic, faint_colour});
    }
    part.marks.push_back(Text{x + width, y + 15 * u, row.number, name, ink, Anchor::end});
    if (!row.aside.empty())
      part.marks.push_back(Text{x + width, y + 33 * u, row.aside, small, faint_colour, Anchor::end});
    return;
  }
  const double right = x + width - (asides_px_ == 0 ? 0 : asides_px_ + 12 * u);
  double room = right - numbers_px_ - 12 * u - left;
  double at = left;
  // The scientific name is the one that is unique: it keeps its place, the common one gives way.
  const double scientific = std::min(room, width_px(row.second, italic));
  const double common_room = room - scientific - 8 * u;
  if (!row.first.empty() && common_room > 34 * u) {
    const std::string common = fitted(row.first, name, common_room);
    part.marks.push_back(Text{at, y + 15 * u, common, name, ink});
    at += width_px(common, name) + 8 * u;
  }
  const bool alone = at == left;
  part.marks.push_back(
      Text{at, y + 15 * u, fitted(row.second, italic, scientific), italic, alone ? ink : faint_colour});
  part.marks.push_back(Text{right, y + 15 * u, row.number, name, ink, Anchor::end});
  if (!row.aside.empty())
    part.marks.push_back(Text{x + width, y + 15 * u, row.aside, small, faint_colour, Anchor::end});
}

}  // namespace silvasim::exports
