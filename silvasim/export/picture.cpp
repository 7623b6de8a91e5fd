#include "silvasim/export/picture.h"

#include <fmt/format.h>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/export/cover.h"
#include "silvasim/export/layout.h"
#include "silvasim/export/png_bytes.h"
#include "silvasim/export/text.h"

namespace silvasim::exports {

namespace {

std::string caption_of(const ecosystem::Ecosystem& ecosystem, const Census& census, const View& view,
                       const PreviewOptions& options) {
  if (options.subject == Subject::suitability) return heat_caption(ecosystem, census);
  std::string text;
  if (census.plants == 0) {
    text = "No plants stand in this view.";
  } else if (style_of(census, view) == Style::crowns) {
    text = "Crowns are drawn to scale.";
  } else {
    text = "Each pixel mixes the colours of the crowns that cover it; where few do, the ground shows through.";
  }
  if (options.subject == Subject::probability && census.plants > 0) {
    text += " Colour tells the growth probability of the plants that stand.";
  }
  if (!options.species.empty()) text += " Other species are not shown.";
  return text;
}

// Six numbers: the step of a pixel to the east, two turns, the step to the south, the first pixel's centre.
std::string world_file(const Layout& layout) {
  const View& view = layout.view;
  return fmt::format("{}\n0\n0\n{}\n{}\n{}\n", view.box.width() / view.width_px, -view.box.height() / view.height_px,
                     view.x_m(0.5 - layout.map_x), view.y_m(0.5 - layout.map_y));
}

// What GDAL keeps beside an image; written without a CRS too, so that none of an older picture stays.
std::string auxiliary_file(const std::string& crs_wkt) {
  const std::string crs = crs_wkt.empty() ? "" : "  <SRS>" + xml_escaped(crs_wkt) + "</SRS>\n";
  return "<PAMDataset>\n" + crs + "</PAMDataset>\n";
}

}  // namespace

void write_png(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options,
               const std::filesystem::path& path) {
  const base::Box box = box_of(ecosystem, options);
  const Census census = take_census(ecosystem, options, box);
  const Layout layout = make_layout(ecosystem, options, census, box,
                                    [&](const View& view) { return caption_of(ecosystem, census, view, options); });
  const Ground ground(ecosystem.terrain, layout.view);
  const Pixels map = options.subject == Subject::suitability
                         ? draw_heat(layout.view, ground, Heat(ecosystem, census))
                         : draw_map(ecosystem, census, layout.view, ground, options.subject);

  // Write all before any gets its name.
  const std::vector<std::filesystem::path> beside = files_beside(path);
  base::NewFile picture(path), world(beside[0]), crs(beside[1]);
  picture.write(png_of(layout, map));
  world.write(world_file(layout));
  crs.write(auxiliary_file(ecosystem.crs_wkt));
  world.commit();
  crs.commit();
  picture.commit();
}

std::vector<std::filesystem::path> files_beside(const std::filesystem::path& picture) {
  const std::string extension = picture.extension().string();
  if (extension != ".png" && extension != ".PNG") return {};
  std::filesystem::path world = picture, auxiliary = picture;
  return {world.replace_extension(".pgw"), auxiliary += ".aux.xml"};
}

void write_preview(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options,
                   const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".png" || extension == ".PNG") return write_png(ecosystem, options, path);
  if (extension == ".svg" || extension == ".SVG") return write_svg(ecosystem, options, path);
  throw base::ConfigError({"-o"},
                          fmt::format("a picture's name ends in .png or .svg, not \"{}\"", path.filename().string()));
}

}  // namespace silvasim::exports
