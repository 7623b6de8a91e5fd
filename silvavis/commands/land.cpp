#include "silvavis/commands/land.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "assets/srgb.h"
#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/config/value.h"
#include "silvasim/fields/picture.h"
#include "silvasim/fields/raster_field.h"
#include "silvasim/fields/vector_field.h"
#include "silvasim/terminal/terminal.h"

namespace silvavis::commands {

namespace {

namespace base = silvasim::base;
namespace config = silvasim::config;
namespace fields = silvasim::fields;

constexpr float brightness = 0.6f;
const Rgb grey(0.30f, 0.30f, 0.30f);

using silvasim::terminal::wrong_option;

// The land's box in the scene's frame: it may reach beyond what is planted.
base::Box land_box(const scene::Scene& scene) {
  const scene::Ground& ground = scene.ground;
  return {ground.west + scene.origin.x, ground.south + scene.origin.y, ground.east() + scene.origin.x,
          ground.north() + scene.origin.y};
}

base::Box planted_box(const scene::Scene& scene) {
  const base::Box& box = scene.extent;
  const base::Point& o = scene.origin;
  return {box.west + o.x, box.south + o.y, box.east + o.x, box.north + o.y};
}

double margin_of(const scene::Scene& scene) {
  const base::Box land = land_box(scene), planted = planted_box(scene);
  return std::max({0.0, planted.west - land.west, planted.south - land.south, land.east - planted.east,
                   land.north - planted.north});
}

config::FieldSettings settings_of(const std::string& option, const std::filesystem::path& file,
                                  const scene::Scene& scene) {
  config::FieldSettings field;
  field.name = option;
  field.place = {"command line", 0, 0};
  field.path = file;
  if (scene.crs_wkt.empty()) field.crs = "local";
  return field;
}

// A picture's grid, coarsened by a whole factor until it has no more than the most pixels.
struct Grid {
  int factor = 1, columns = 0, rows = 0;
};
Grid grid_of(double columns, double rows) {
  Grid grid;
  grid.factor = std::max(1, static_cast<int>(std::ceil(std::sqrt(columns * rows / most_drape_px))));
  grid.columns = static_cast<int>(columns) / grid.factor + (static_cast<int>(columns) % grid.factor > 0);
  grid.rows = static_cast<int>(rows) / grid.factor + (static_cast<int>(rows) % grid.factor > 0);
  return grid;
}

template <class Raster>
base::Box world_box(const Raster& raster, const Grid& grid, const scene::Scene& scene) {
  const double west = raster.west - scene.origin.x, north = raster.north - scene.origin.y;
  return {west, north - grid.rows * grid.factor * raster.cell_height,
          west + grid.columns * grid.factor * raster.cell_width, north};
}

// Fills the drape pixel by pixel; where `colour` knows none the land has its plain look.
template <class Colour>
void fill(shade::Land& land, const Grid& grid, const scene::Scene& scene, const Colour& colour) {
  land.drape = image::Image(grid.columns, grid.rows, 3);
  const shade::Land plain;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      Rgb light(0, 0, 0);
      if (!colour(column, row, light)) {
        const double x = land.drape_box.west + (column + 0.5) * land.drape_box.width() / grid.columns;
        const double y = land.drape_box.north - (row + 0.5) * land.drape_box.height() / grid.rows;
        light = shade::land_colour(plain, x, y, scene::ground_normal(scene.ground, x, y),
                                   scene::ground_at(scene.ground, x, y).height_m);
      }
      std::copy_n(&light.x, 3, land.drape.at(column, row));
    }
  }
}

Rgb linear(const std::uint8_t* rgb) {
  const std::array<float, 256>& light = assets::linear_of_bytes();
  return Rgb(light[rgb[0]], light[rgb[1]], light[rgb[2]]) * brightness;
}

void drape(const std::filesystem::path& file, const scene::Scene& scene, shade::Land& land) {
  const fields::Picture picture = fields::load_picture(settings_of("--drape", file, scene),
                                                       {scene.crs_wkt, "", planted_box(scene)}, margin_of(scene));
  const Grid grid = grid_of(picture.columns, picture.rows);
  land.drape_box = world_box(picture, grid, scene);
  fill(land, grid, scene, [&](int column, int row, Rgb& light) {
    int count = 0;
    for (int j = row * grid.factor; j < std::min(picture.rows, (row + 1) * grid.factor); ++j) {
      for (int i = column * grid.factor; i < std::min(picture.columns, (column + 1) * grid.factor); ++i) {
        const std::uint8_t* pixel =
            picture.rgba.data() +
            (static_cast<std::size_t>(j) * static_cast<std::size_t>(picture.columns) + static_cast<std::size_t>(i)) * 4;
        if (pixel[3] == 0) continue;
        light += linear(pixel);
        ++count;
      }
    }
    if (count > 0) light /= static_cast<float>(count);
    return count > 0;
  });
}

using Palette = std::map<int, Rgb>;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) cell = config::trimmed(cell);
  return cells;
}

// Lines of code,class,#rrggbb; the first may be a heading.
Palette read_colours(const std::filesystem::path& file) {
  constexpr std::size_t most_bytes = 1 << 20;
  const std::string text = base::read_file(file, most_bytes);
  Palette palette;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = config::trimmed(text.substr(at, end - at));
    at = end + 1;
    ++number;
    if (line.empty()) continue;
    const std::vector<std::string> cells = cells_of(line);
    const auto fail = [&](const std::string& what) {
      throw base::ConfigError({file.string(), number, 0},
                              what + "; a line is code,class,#rrggbb, like 3,meadow,#86a05a");
    };
    int code = 0;
    const auto [rest, error] = std::from_chars(cells[0].data(), cells[0].data() + cells[0].size(), code);
    const bool whole = error == std::errc() && rest == cells[0].data() + cells[0].size();
    if (!whole && number == 1) continue;
    if (cells.size() != 3) fail(fmt::format("{} cells", cells.size()));
    if (!whole) fail("\"" + cells[0] + "\" is no code");
    const config::ParsedValue colour = config::parse_value(cells[2], config::ValueType::colour, {}, 0, 0);
    if (!colour.problem.empty()) fail(colour.problem);
    const auto rgb = static_cast<std::uint32_t>(std::get<double>(colour.value));
    const std::array<std::uint8_t, 3> bytes = {static_cast<std::uint8_t>(rgb >> 16),
                                               static_cast<std::uint8_t>(rgb >> 8), static_cast<std::uint8_t>(rgb)};
    if (!palette.emplace(code, linear(bytes.data())).second) fail(fmt::format("code {} a second time", code));
  }
  if (palette.empty())
    throw base::ConfigError({file.string(), 0, 0}, "it holds no class; a line is code,class,#rrggbb");
  return palette;
}

void colour_classes(const LandOptions& options, const scene::Scene& scene, shade::Land& land,
                    std::vector<std::string>& warnings) {
  config::FieldSettings field = settings_of("--classes", *options.classes, scene);
  field.kind = config::FieldKind::class_code;
  Palette palette;
  if (options.class_colours) {
    palette = read_colours(*options.class_colours);
  } else {
    for (const fields::PaletteEntry& entry : fields::load_palette(field))
      palette.emplace(entry.code, linear(entry.rgb.data()));
    if (palette.empty())
      wrong_option("\"" + options.classes->string() +
                   "\" has no palette; --class-colours FILE.csv says code,class,#rrggbb");
  }
  const fields::Raster raster =
      fields::load_raster_field(field, {scene.crs_wkt, "", planted_box(scene)}, margin_of(scene)).raster;
  const Grid grid = grid_of(raster.columns, raster.rows);
  land.drape_box = world_box(raster, grid, scene);
  land.smooth = false;
  std::set<int> unknown;
  fill(land, grid, scene, [&](int column, int row, Rgb& light) {
    const int i = std::min(column * grid.factor + grid.factor / 2, raster.columns - 1);
    const int j = std::min(row * grid.factor + grid.factor / 2, raster.rows - 1);
    const float code = raster.at(i, j);
    if (std::isnan(code)) return false;
    const auto found = palette.find(static_cast<int>(code));
    if (found == palette.end() || static_cast<float>(found->first) != code) {
      constexpr std::size_t most_told = 20;
      if (unknown.size() < most_told) unknown.insert(static_cast<int>(code));
      return false;
    }
    light = found->second;
    return true;
  });
  if (!unknown.empty()) {
    warnings.push_back(fmt::format("classes without a colour are shown as plain land: {} in \"{}\"",
                                   fmt::join(unknown, ", "), options.classes->string()));
  }
}

std::pair<std::filesystem::path, std::string> split_layer(const std::string& text) {
  const std::size_t hash = text.rfind('#');
  if (hash == std::string::npos || std::filesystem::exists(text)) return {text, ""};
  return {text.substr(0, hash), text.substr(hash + 1)};
}

// Burns all waters into one grid of cells as fine as it may be.
void lay_water(const LandOptions& options, const scene::Scene& scene, shade::Land& land) {
  const base::Box box = land_box(scene);
  constexpr double least_cell_m = 0.1;
  constexpr int rim = 6;  // the room adds some cells around
  for (const std::string& text : options.water) {
    const auto [file, layer] = split_layer(text);
    config::FieldSettings field = settings_of("--water", file, scene);
    field.source = config::Source::vector;
    field.layer = layer;
    field.resolution_m = std::max(std::max(box.width(), box.height()) / (most_water_side - rim), least_cell_m);
    field.line_width_m = options.water_width_m;
    const fields::Raster raster = fields::load_vector_field(field, {scene.crs_wkt, "", box}).raster;
    if (land.water.empty()) {
      land.water.resize(raster.values.size());
      land.water_columns = raster.columns;
      land.water_rows = raster.rows;
      land.water_box = world_box(raster, {1, raster.columns, raster.rows}, scene);
    }
    for (std::size_t i = 0; i < raster.values.size(); ++i) land.water[i] |= raster.values[i] > 0;
  }
}

}  // namespace

shade::Land land_of(const LandOptions& options, const scene::Scene& scene, std::vector<std::string>& warnings) {
  if (options.drape.has_value() + options.classes.has_value() + options.hillshade > 1)
    wrong_option("--drape, --classes and --hillshade exclude each other: the land has one look");
  if (options.class_colours && !options.classes) wrong_option("--class-colours goes with --classes");
  constexpr double widest_m = 1e4;
  if (!(options.water_width_m > 0 && options.water_width_m <= widest_m))
    wrong_option(fmt::format("--water-width {} should be above 0 m, at most {}", options.water_width_m, widest_m));
  shade::Land land;
  if (options.drape) drape(*options.drape, scene, land);
  if (options.classes) colour_classes(options, scene, land, warnings);
  if (options.hillshade) {
    land.drape = image::Image(1, 1, 3);
    std::copy_n(&grey.x, 3, land.drape.at(0, 0));
    const scene::Ground& ground = scene.ground;
    land.drape_box = base::grown({ground.west, ground.south, ground.east(), ground.north()}, 1);
  }
  lay_water(options, scene, land);
  return land;
}

std::vector<std::filesystem::path> files_of(const LandOptions& options) {
  std::vector<std::filesystem::path> files;
  for (const auto& file : {options.drape, options.classes, options.class_colours}) {
    if (file) files.push_back(*file);
  }
  for (const std::string& text : options.water) files.push_back(split_layer(text).first);
  return files;
}

}  // namespace silvavis::commands
