#include "silvasim/export/qgis_style.h"

#include <fmt/format.h>

#include <set>

#include "silvasim/export/colour.h"
#include "silvasim/export/text.h"

namespace silvasim::exports {

namespace {

std::string rgba(Colour colour) {
  return fmt::format("{},{},{},255", (colour >> 16) & 0xFF, (colour >> 8) & 0xFF, colour & 0xFF);
}

std::string option(const char* name, const std::string& value) {
  return fmt::format("<Option name=\"{}\" type=\"QString\" value=\"{}\"/>", name, value);
}

}  // namespace

std::string qgis_style(const ecosystem::Ecosystem& ecosystem) {
  std::string categories, symbols;
  std::set<std::string> seen;
  int index = 0;
  for (const ecosystem::Layer& layer : ecosystem.layers) {
    for (const ecosystem::Species& species : layer.species) {
      // A species that stands in two layers has one category, with its first colour.
      if (!seen.insert(species.name).second) continue;
      const std::string label =
          species.common_name.empty() ? species.name : species.common_name + " (" + species.name + ")";
      categories += fmt::format("<category symbol=\"{}\" value=\"{}\" label=\"{}\" type=\"string\" render=\"true\"/>\n",
                                index, xml_escaped(species.name), xml_escaped(label));
      // Sizes are map units, so that a crown keeps its width on the ground; the size comes from each plant.
      symbols += fmt::format(
          "<symbol name=\"{}\" type=\"marker\" alpha=\"1\" clip_to_extent=\"1\" force_rhr=\"0\">"
          "<layer class=\"SimpleMarker\" enabled=\"1\" pass=\"0\" locked=\"0\"><Option type=\"Map\">{}{}{}{}{}{}{}{}"
          "</Option><data_defined_properties><Option type=\"Map\">{}<Option name=\"properties\" type=\"Map\">"
          "<Option name=\"size\" type=\"Map\"><Option name=\"active\" type=\"bool\" value=\"true\"/>{}"
          "<Option name=\"type\" type=\"int\" value=\"3\"/></Option></Option>{}</Option></data_defined_properties>"
          "</layer></symbol>\n",
          index, option("name", "circle"), option("color", rgba(species.colour)),
          option("outline_color", rgba(darker(species.colour))), option("outline_style", "solid"),
          option("outline_width", "0.1"), option("outline_width_unit", "MM"),
          option("size", fmt::format("{:.3f}", 2 * species.model_radius_m)), option("size_unit", "MapUnit"),
          option("name", ""), option("expression", "2 * &quot;crown_radius_m&quot;"), option("type", "collection"));
      ++index;
    }
  }
  return "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
         "<qgis version=\"3.22.0\" styleCategories=\"Symbology\">\n"
         "<renderer-v2 type=\"categorizedSymbol\" attr=\"species\" symbollevels=\"0\" enableorderby=\"0\" "
         "forceraster=\"0\">\n<categories>\n" +
         categories + "</categories>\n<symbols>\n" + symbols +
         "</symbols>\n</renderer-v2>\n<blendMode>0</blendMode>\n<layerGeometryType>0</layerGeometryType>\n</qgis>\n";
}

}  // namespace silvasim::exports
