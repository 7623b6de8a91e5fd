#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include "silvasim/base/file.h"
#include "silvasim/export/cover.h"
#include "silvasim/export/hexagons.h"
#include "silvasim/export/layout.h"
#include "silvasim/export/number.h"
#include "silvasim/export/picture.h"
#include "silvasim/export/png_bytes.h"

namespace silvasim::exports {

namespace {

constexpr int most_ground_px = 2400;  // of the embedded relief's longer side
constexpr int opacity_steps = 6, ramp_steps = 24;

std::string base64(std::string_view bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u; };
    const unsigned group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    text += digits[group >> 18];
    text += digits[(group >> 12) & 63];
    text += i + 1 < bytes.size() ? digits[(group >> 6) & 63] : '=';
    text += i + 2 < bytes.size() ? digits[group & 63] : '=';
  }
  return text;
}

// A number with at most two decimals, for attributes.
std::string n(double value) {
  std::string text;
  append_fixed(text, value, 2, true);
  return text;
}

struct Writer {
  std::string& svg;

  void operator()(const Text& text) const {
    svg += "<text x=\"" + n(text.x) + "\" y=\"" + n(text.y) + "\" font-size=\"" + n(text.font.size_px) + "\" fill=\"" +
           hex(text.colour) + "\"";
    if (text.font.bold) svg += " font-weight=\"bold\"";
    if (text.font.italic) svg += " font-style=\"italic\"";
    if (text.anchor != Anchor::start)
      svg += text.anchor == Anchor::middle ? " text-anchor=\"middle\"" : " text-anchor=\"end\"";
    if (text.upward) svg += " transform=\"rotate(-90 " + n(text.x) + " " + n(text.y) + ")\"";
    svg += ">" + xml_escaped(text.text) + "</text>\n";
  }
  void operator()(const Rectangle& box) const {
    svg += "<rect x=\"" + n(box.x) + "\" y=\"" + n(box.y) + "\" width=\"" + n(box.width) + "\" height=\"" +
           n(box.height) + "\" fill=\"" + (box.fill ? hex(*box.fill) : "none") + "\"";
    if (box.stroke) svg += " stroke=\"" + hex(*box.stroke) + "\" stroke-width=\"" + n(box.stroke_px) + "\"";
    if (box.dashed) svg += " stroke-dasharray=\"" + n(6 * box.stroke_px) + " " + n(4 * box.stroke_px) + "\"";
    svg += "/>\n";
  }
  void operator()(const Line& line) const {
    svg += "<path d=\"M" + n(line.x1) + " " + n(line.y1) + "L" + n(line.x2) + " " + n(line.y2) + "\" stroke=\"" +
           hex(line.colour) + "\" stroke-width=\"" + n(line.width_px) + "\"/>\n";
  }
  // Circles of the legend are ellipses, so that each <circle> in the file is a crown.
  void operator()(const Circle& circle) const {
    const std::string radius = n(circle.radius - circle.stroke_px / 2);
    svg += "<ellipse cx=\"" + n(circle.x) + "\" cy=\"" + n(circle.y) + "\" rx=\"" + radius + "\" ry=\"" + radius +
           "\" fill=\"" + hex(circle.fill) + "\" stroke=\"" + hex(circle.stroke) + "\" stroke-width=\"" +
           n(circle.stroke_px) + "\"/>\n";
  }
  void operator()(const Triangle& t) const {
    svg += "<path d=\"M" + n(t.x1) + " " + n(t.y1) + "L" + n(t.x2) + " " + n(t.y2) + "L" + n(t.x3) + " " + n(t.y3) +
           "z\" fill=\"" + hex(t.fill) + "\" stroke=\"" + hex(t.stroke) + "\" stroke-width=\"" + n(t.stroke_px) +
           "\"/>\n";
  }
};

// Ids that no other group has.
class Names {
 public:
  std::string unique(const std::string& wanted) {
    std::string name = wanted;
    for (int i = 2; !used_.insert(name).second; ++i) name = fmt::format("{}-{}", wanted, i);
    return name;
  }

 private:
  std::set<std::string> used_;
};

std::string group(const std::string& id, const std::string& label) {
  return "<g id=\"" + id + "\" inkscape:groupmode=\"layer\" inkscape:label=\"" + xml_escaped(label) + "\"";
}

int ramp_step(float probability) { return std::min(ramp_steps - 1, static_cast<int>(probability * ramp_steps)); }

Colour ramp_colour(int step) { return ramp((step + 0.5) / ramp_steps); }

struct Crown {
  float x = 0, y = 0, radius = 0;
  int step = 0;  // of the ramp
};

// A species' crowns as circles; on probability maps in groups of one colour each.
void write_crowns(std::string& svg, const std::vector<Crown>& crowns, Colour colour, Subject subject) {
  float mean = 0;
  for (const Crown& crown : crowns) mean += crown.radius / static_cast<float>(crowns.size());
  const float outline = mean < 1.2f ? 0.0f : outline_px(mean), stem = stem_radius_px(mean);
  const auto circle = [&](const Crown& crown) {
    svg += "<circle cx=\"";
    append_fixed(svg, static_cast<double>(crown.x), 2, true);
    svg += "\" cy=\"";
    append_fixed(svg, static_cast<double>(crown.y), 2, true);
    svg += "\" r=\"";
    append_fixed(svg, static_cast<double>(std::max(crown.radius - outline / 2, crown.radius / 2)), 2, true);
    svg += "\"/>\n";
  };
  const auto style = [&](Colour fill) {
    std::string text = " fill=\"" + hex(fill) + "\"";
    if (outline > 0)
      text += " stroke=\"" + hex(darker(fill)) + "\" stroke-width=\"" + n(static_cast<double>(outline)) + "\"";
    return text;
  };
  const auto stems = [&](Colour fill, int step) {
    if (stem <= 0) return;
    svg += "<path fill=\"none\" stroke=\"" + hex(darker(fill)) + "\" stroke-linecap=\"round\" stroke-width=\"" +
           n(2 * static_cast<double>(stem)) + "\" d=\"";
    for (const Crown& crown : crowns) {
      if (step >= 0 && crown.step != step) continue;
      svg += 'M' + n(static_cast<double>(crown.x)) + ' ' + n(static_cast<double>(crown.y)) + "h0";
    }
    svg += "\"/>\n";
  };
  if (crowns.empty()) {
    svg += " fill=\"" + hex(colour) + "\"/>\n";
  } else if (subject == Subject::species) {
    svg += style(colour) + ">\n";
    for (const Crown& crown : crowns) circle(crown);
    stems(colour, -1);
    svg += "</g>\n";
  } else {
    svg += ">\n";
    std::array<std::vector<Crown>, ramp_steps> steps;
    for (const Crown& crown : crowns) steps[static_cast<std::size_t>(crown.step)].push_back(crown);
    for (int step = 0; step < ramp_steps; ++step) {
      if (steps[static_cast<std::size_t>(step)].empty()) continue;
      svg += "<g" + style(ramp_colour(step)) + ">\n";
      for (const Crown& crown : steps[static_cast<std::size_t>(step)]) circle(crown);
      stems(ramp_colour(step), step);
      svg += "</g>\n";
    }
    svg += "</g>\n";
  }
}

// A species' hexagons: one path for each colour and opacity, because one path has no seams.
void write_hexagons(std::string& svg, const std::vector<Hexagon>& hexagons, Colour colour, Subject subject,
                    double across_px) {
  if (hexagons.empty()) {
    svg += " fill=\"" + hex(colour) + "\"/>\n";
    return;
  }
  svg += ">\n";
  // A little larger than they are, so that no ground shines through between species.
  const double w = across_px / 2 + 0.2, h = w * 1.1547005383792515;
  const std::string outline = "l" + n(w) + " " + n(h / 2) + "v" + n(h) + "l-" + n(w) + " " + n(h / 2) + "l-" + n(w) +
                              "-" + n(h / 2) + "v-" + n(h) + "z";
  const int boldness = subject == Subject::probability ? 2 * most_boldness : most_boldness;
  std::map<std::pair<int, int>, std::string> paths;
  for (const Hexagon& hexagon : hexagons) {
    const int step =
        std::clamp(static_cast<int>(std::ceil(opacity(hexagon.covered, boldness) * opacity_steps)), 1, opacity_steps);
    const int heat = subject == Subject::probability ? ramp_step(hexagon.probability) : 0;
    std::string& path = paths[{heat, step}];
    path += 'M';
    append_fixed(path, static_cast<double>(hexagon.x), 1, true);
    path += ' ';
    append_fixed(path, static_cast<double>(hexagon.y) - h, 1, true);
    path += outline;
  }
  for (const auto& [key, path] : paths) {
    const Colour fill = subject == Subject::probability ? ramp_colour(key.first) : colour;
    svg += "<path fill=\"" + hex(fill) + "\" fill-opacity=\"" + n(double(key.second) / opacity_steps) + "\" d=\"" +
           path + "\"/>\n";
  }
  svg += "</g>\n";
}

std::string size_of(const View& view) {
  return "width=\"" + n(view.width_px) + "\" height=\"" + n(view.height_px) + "\"";
}

// The view as embedded pictures show it: of fewer pixels where it is large.
View coarse(const View& view) {
  View coarse = view;
  const double shrink = std::max(1.0, std::max(view.width_px, view.height_px) / double(most_ground_px));
  coarse.width_px = std::max(1, static_cast<int>(view.width_px / shrink));
  coarse.height_px = std::max(1, static_cast<int>(view.height_px / shrink));
  return coarse;
}

void embed(std::string& svg, const Pixels& pixels, const View& view) {
  svg += "<image " + size_of(view) + " preserveAspectRatio=\"none\" xlink:href=\"data:image/png;base64," +
         base64(png_of(pixels)) + "\"/>\n";
}

void write_ground(std::string& svg, const Ground& ground, const View& view) {
  svg += group("ground", "Ground") + ">\n<rect " + size_of(view) + " fill=\"" + hex(paper_colour) + "\"/>\n";
  if (!ground.plain()) embed(svg, draw_ground(coarse(view), ground), view);
  svg += "</g>\n";
}

void write_heat(std::string& svg, const Ground& ground, const Heat& heat, const View& view) {
  svg += group("suitability", "Suitability") + ">\n";
  embed(svg, draw_heat(coarse(view), ground, heat), view);
  svg += "</g>\n";
}

double hexagon_across_px(const PreviewOptions& options) { return std::max(4.5, options.width_px / 320.0); }

std::string caption_of(const ecosystem::Ecosystem& ecosystem, const Census& census, const View& view,
                       const PreviewOptions& options, bool aggregated) {
  if (options.subject == Subject::suitability) return heat_caption(ecosystem, census);
  std::string text;
  if (census.plants == 0) {
    text = "No plants stand in this view.";
  } else if (!aggregated) {
    text = "Crowns are drawn to scale.";
  } else {
    text = fmt::format(
        "{} plants are too many to draw one by one, so they are aggregated: a hexagon, {} across, gathers the "
        "plants in it and shows one of their species, chosen in proportion to crown area; the paler, the "
        "fewer crowns cover the ground.",
        grouped(census.plants), length(hexagon_across_px(options) / view.px_per_m()));
  }
  if (options.subject == Subject::probability && census.plants > 0) {
    text += " Colour tells the growth probability of the plants that stand.";
  }
  if (!options.species.empty()) text += " Other species are not shown.";
  return text;
}

// The crowns of one layer that touch the view, a species each.
std::vector<std::vector<Crown>> crowns_of(const ecosystem::Layer& layer, const std::vector<SpeciesCount>& counts,
                                          const std::vector<std::uint64_t>& offsets, const View& view) {
  std::vector<std::vector<Crown>> crowns(layer.species.size());
  const base::Box near = base::grown(view.box, layer.tile_set.most_radius_m);
  for_each_plant_near(layer, offsets, near, [&](const ecosystem::Plant& plant) {
    if (!counts[plant.species].shown) return;
    const double radius = static_cast<double>(plant.radius_m);
    const double dx = plant.at.x - std::clamp(plant.at.x, view.box.west, view.box.east);
    const double dy = plant.at.y - std::clamp(plant.at.y, view.box.south, view.box.north);
    if (dx * dx + dy * dy > radius * radius) return;
    crowns[plant.species].push_back({static_cast<float>(view.x_px(plant.at.x)),
                                     static_cast<float>(view.y_px(plant.at.y)),
                                     static_cast<float>(radius * view.px_per_m()), ramp_step(plant.probability)});
  });
  return crowns;
}

// All plants: a group a layer, in it a group a species.
void write_plants(std::string& svg, const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options,
                  const Census& census, const View& view, bool aggregated) {
  Names names;
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    const ecosystem::Layer& layer = ecosystem.layers[l];
    svg += group(names.unique("layer-" + slug(layer.name)), layer.name) + ">\n";
    std::vector<std::vector<Crown>> crowns(layer.species.size());
    HexagonLayer hexagons;
    if (aggregated) {
      hexagons = gather(layer, census.layers[l], census.offsets[l], view, hexagon_across_px(options));
    } else {
      crowns = crowns_of(layer, census.layers[l], census.offsets[l], view);
    }
    for (std::size_t s = 0; s < layer.species.size(); ++s) {
      if (!census.layers[l][s].shown) continue;
      svg += group(names.unique("species-" + slug(layer.species[s].name)), layer.species[s].name);
      if (aggregated) {
        write_hexagons(svg, hexagons.species[s], layer.species[s].colour, options.subject, hexagon_across_px(options));
      } else {
        write_crowns(svg, crowns[s], layer.species[s].colour, options.subject);
      }
    }
    svg += "</g>\n";
  }
}

}  // namespace

void write_svg(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options,
               const std::filesystem::path& path) {
  const base::Box box = box_of(ecosystem, options);
  const Census census = take_census(ecosystem, options, box);
  const bool aggregated = census.plants > options.most_circles;
  const Layout layout = make_layout(ecosystem, options, census, box, [&](const View& view) {
    return caption_of(ecosystem, census, view, options, aggregated);
  });
  const View& view = layout.view;

  std::string svg = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
      "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\" "
      "font-family=\"{2}\">\n<title>{3}</title>\n<defs><clipPath id=\"map-area\"><rect width=\"{4}\" "
      "height=\"{5}\"/></clipPath></defs>\n",
      layout.width_px, layout.height_px, font_families, xml_escaped(layout.title), view.width_px, view.height_px);
  if (options.decorated) svg += "<rect width=\"100%\" height=\"100%\" fill=\"" + hex(page_colour) + "\"/>\n";
  svg += fmt::format("<g id=\"map\" transform=\"translate({} {})\" clip-path=\"url(#map-area)\">\n", layout.map_x,
                     layout.map_y);
  const Ground ground(ecosystem.terrain, coarse(view));
  write_ground(svg, ground, view);
  if (options.subject == Subject::suitability) {
    write_heat(svg, ground, Heat(ecosystem, census), view);
  } else {
    write_plants(svg, ecosystem, options, census, view, aggregated);
  }
  svg += "</g>\n";
  for (const Part& part : layout.parts) {
    svg += "<g id=\"" + part.id + "\">\n";
    for (const Mark& mark : part.marks) std::visit(Writer{svg}, mark);
    svg += "</g>\n";
  }
  svg += "</svg>\n";
  base::NewFile file(path);
  file.write(svg);
  file.commit();
}

}  // namespace silvasim::exports
