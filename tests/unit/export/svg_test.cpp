#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/parser.h>
#include <libxml/xpath.h>
#include <libxml/xpathInternals.h>

#include <cmath>
#include <set>

#include "files.h"
#include "made_land.h"
#include "silvasim/base/parallel.h"
#include "silvasim/export/picture.h"
#include "silvasim/export/text.h"

namespace silvasim::exports {
namespace {

using testing::content;
using testing::Folder;
using ::testing::HasSubstr;
using testing::MadeLand;
using testing::make_land;
using testing::recount;

// An SVG read by another library than wrote it.
class Document {
 public:
  explicit Document(const std::string& text)
      : document_(xmlReadMemory(text.data(), static_cast<int>(text.size()), "f.svg", nullptr,
                                XML_PARSE_NONET | XML_PARSE_HUGE)) {
    if (!document_) return;
    context_ = xmlXPathNewContext(document_);
    const auto name = [](const char* word) { return reinterpret_cast<const xmlChar*>(word); };
    xmlXPathRegisterNs(context_, name("s"), name("http://www.w3.org/2000/svg"));
    xmlXPathRegisterNs(context_, name("i"), name("http://www.inkscape.org/namespaces/inkscape"));
    xmlXPathRegisterNs(context_, name("x"), name("http://www.w3.org/1999/xlink"));
  }
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;
  ~Document() {
    xmlXPathFreeContext(context_);
    xmlFreeDoc(document_);
  }

  bool well_formed() const { return document_ != nullptr; }
  std::vector<std::string> texts(const std::string& path) const {
    std::vector<std::string> found;
    xmlXPathObject* result = xmlXPathEvalExpression(reinterpret_cast<const xmlChar*>(path.c_str()), context_);
    if (result && result->nodesetval) {
      for (int i = 0; i < result->nodesetval->nodeNr; ++i) {
        xmlChar* text = xmlNodeGetContent(result->nodesetval->nodeTab[i]);
        found.emplace_back(reinterpret_cast<const char*>(text));
        xmlFree(text);
      }
    }
    xmlXPathFreeObject(result);
    return found;
  }
  std::size_t count(const std::string& path) const { return texts(path).size(); }

 private:
  xmlDoc* document_ = nullptr;
  xmlXPathContext* context_ = nullptr;
};

std::string svg_of(const ecosystem::Ecosystem& land, const PreviewOptions& options = {}) {
  const Folder folder;
  write_svg(land, options, folder / "f.svg");
  return content(folder / "f.svg");
}

TEST(Svg, has_a_group_a_species_with_a_circle_a_plant) {
  MadeLand made;
  made.species = 5;
  made.columns = 3;
  made.rows = 2;
  ecosystem::Ecosystem land = make_land(made);
  add_shrubs(land, made);
  for (const Subject subject : {Subject::species, Subject::probability}) {
    PreviewOptions options;
    options.subject = subject;
    const Document document(svg_of(land, options));
    ASSERT_TRUE(document.well_formed());
    EXPECT_EQ(document.count("//s:g[starts-with(@id,'species-')]"), 7u);
    std::uint64_t all = 0;
    for (std::size_t l = 0; l < land.layers.size(); ++l) {
      for (std::size_t s = 0; s < land.layers[l].species.size(); ++s) {
        const std::string& name = land.layers[l].species[s].name;
        const std::string group =
            "//s:g[@id='species-" + slug(name) + "'][@i:groupmode='layer'][@i:label='" + name + "']";
        EXPECT_EQ(document.count(group), 1u) << name;
        EXPECT_EQ(document.count(group + "//s:circle"), recount(land, l, s, land.extent)) << name;
        all += recount(land, l, s, land.extent);
      }
    }
    EXPECT_EQ(document.count("//s:circle"), all);
    EXPECT_EQ(document.count("//s:g[@id='layer-trees']/s:g"), 5u);
    EXPECT_EQ(document.count("//s:g[@id='layer-shrubs-herbs'][@i:label='shrubs & herbs']/s:g"), 2u);
  }
}

TEST(Svg, a_circle_stands_where_its_plant_does) {
  MadeLand made;
  made.columns = 3;
  made.rows = 2;
  ecosystem::Ecosystem land = make_land(made);
  std::fill(land.layers[0].plants.begin(), land.layers[0].plants.end(), ecosystem::no_plant);
  land.layers[0].plants[77] = 1;
  base::Point at;
  double radius = 0;
  ecosystem::for_each_plant(land.layers[0], ecosystem::site_offsets(land.layers[0].tile_set, land.layers[0].tiling), 0,
                            2, [&](const ecosystem::Plant& plant) {
                              at = plant.at;
                              radius = static_cast<double>(plant.radius_m);
                            });
  PreviewOptions options;
  options.decorated = false;
  options.width_px = 1500;
  const Document document(svg_of(land, options));
  ASSERT_EQ(document.count("//s:circle"), 1u);
  const double scale = 1500 / land.extent.width();
  EXPECT_NEAR(std::stod(document.texts("//s:circle/@cx")[0]), (at.x - land.extent.west) * scale, 0.006);
  EXPECT_NEAR(std::stod(document.texts("//s:circle/@cy")[0]), (land.extent.north - at.y) * scale, 0.006);
  // The outline's outer rim is the crown.
  const double outline = std::stod(document.texts("//s:g[@id='species-fagus-sylvatica']/@stroke-width")[0]);
  EXPECT_NEAR(std::stod(document.texts("//s:circle/@r")[0]) + outline / 2, radius * scale, 0.02);
}

TEST(Svg, a_cut_shows_the_crowns_that_touch_it) {
  const ecosystem::Ecosystem land = make_land({});
  PreviewOptions options;
  options.bbox = base::Box{600150, 5190150, 600350, 5190290};
  std::size_t touching = 0;
  ecosystem::for_each_plant(land.layers[0], ecosystem::site_offsets(land.layers[0].tile_set, land.layers[0].tiling), 0,
                            land.layers[0].tiling.rows, [&](const ecosystem::Plant& plant) {
                              const double x = std::max({600150 - plant.at.x, plant.at.x - 600350, 0.0});
                              const double y = std::max({5190150 - plant.at.y, plant.at.y - 5190290, 0.0});
                              touching += std::hypot(x, y) <= static_cast<double>(plant.radius_m);
                            });
  EXPECT_EQ(Document(svg_of(land, options)).count("//s:circle"), touching);
}

TEST(Svg, aggregates_past_the_limit_and_says_so) {
  MadeLand made;
  made.columns = 20;
  made.rows = 15;
  const ecosystem::Ecosystem land = make_land(made);
  PreviewOptions options;
  options.most_circles = 10000;
  for (const Subject subject : {Subject::species, Subject::probability}) {
    options.subject = subject;
    const Document document(svg_of(land, options));
    ASSERT_TRUE(document.well_formed());
    EXPECT_EQ(document.count("//s:circle"), 0u);
    EXPECT_EQ(document.count("//s:g[starts-with(@id,'species-')]"), 3u);
    EXPECT_GE(document.count("//s:g[@id='species-larix-decidua']/s:path"), 1u);
    std::string caption;
    for (const std::string& line : document.texts("//s:g[@id='caption']/s:text")) caption += line + " ";
    EXPECT_THAT(caption, HasSubstr("aggregated"));
  }
  options.most_circles = 1'000'000;
  const Document whole(svg_of(land, options));
  std::string caption;
  for (const std::string& line : whole.texts("//s:g[@id='caption']/s:text")) caption += line + " ";
  EXPECT_THAT(caption, HasSubstr("to scale"));
  EXPECT_GT(whole.count("//s:circle"), 10000u);
}

TEST(Svg, names_with_xml_in_them_stay_names) {
  MadeLand made;
  made.species = 6;
  ecosystem::Ecosystem land = make_land(made);
  auto& species = land.layers[0].species;
  species[0].name = "</g><script>alert('x')</script>";
  species[1].name = "a & b \"c\" <d>";
  species[2].name = "A, B  C, D";
  species[2].common_name = "]]>";
  species[3].name = "Ünïcödé 木";
  species[4].name = std::string("nul\0and\x01", 8);
  species[5].name = "\xFF\xFE broken";
  land.layers[0].name = "\"<layer>\"";
  land.name = "<title> & \"quotes\"";
  const Document document(svg_of(land));
  ASSERT_TRUE(document.well_formed());
  EXPECT_EQ(document.count("//s:script"), 0u);
  const auto labels = document.texts("//s:g[starts-with(@id,'species-')]/@i:label");
  ASSERT_EQ(labels.size(), 6u);
  EXPECT_EQ(labels[0], species[0].name);
  EXPECT_EQ(labels[1], species[1].name);
  EXPECT_EQ(labels[3], species[3].name);
  EXPECT_EQ(document.texts("/s:svg/s:title")[0], "<title> & \"quotes\"");
}

TEST(Svg, ids_are_unique_also_where_names_are_alike) {
  MadeLand made;
  made.species = 4;
  ecosystem::Ecosystem land = make_land(made);
  land.layers[0].species[0].name = "Salix alba";
  land.layers[0].species[1].name = "Salix-alba";
  land.layers[0].species[2].name = "Salix alba 2";
  land.layers[0].species[3].name = "salix ALBA";
  land.layers.push_back(land.layers[0]);
  const Document document(svg_of(land));
  const auto ids = document.texts("//@id");
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
  EXPECT_EQ(document.count("//s:g[starts-with(@id,'species-')]"), 8u);
}

TEST(Svg, embeds_the_relief_and_nothing_from_elsewhere) {
  const ecosystem::Ecosystem land = make_land({});
  const Document document(svg_of(land));
  const auto links = document.texts("//@x:href");
  ASSERT_EQ(links.size(), 1u);
  EXPECT_THAT(links[0], ::testing::StartsWith("data:image/png;base64,iVBORw0KGgo"));
  ecosystem::Ecosystem flat = land;
  flat.terrain = {};
  EXPECT_EQ(Document(svg_of(flat)).count("//s:image"), 0u);
}

TEST(Svg, a_map_of_suitability_is_a_picture_of_its_own_over_the_relief) {
  ecosystem::Ecosystem land = make_land({});
  PreviewOptions options;
  options.subject = Subject::suitability;
  const Document document(svg_of(land, options));
  EXPECT_TRUE(document.well_formed());
  EXPECT_EQ(document.count("//s:g[@id='ground']/s:image"), 1u);
  EXPECT_EQ(document.count("//s:g[@id='suitability'][@i:groupmode='layer']/s:image"), 1u);
  EXPECT_EQ(document.count("//s:circle"), 0u);
  EXPECT_EQ(document.count("//s:g[starts-with(@id,'species-')]"), 0u);
  EXPECT_GT(document.count("//s:g[@id='legend']/s:rect"), 60u);
  EXPECT_EQ(document.count("//s:g[@id='legend']/s:text[.='Suitability of the place']"), 1u);
  for (const ecosystem::Species& species : land.layers[0].species) {
    EXPECT_EQ(document.count("//s:g[@id='legend']/s:text[.='" + species.name + "']"), 1u);
  }
}

TEST(Svg, has_the_same_bytes_with_any_number_of_threads) {
  MadeLand made;
  made.columns = 20;
  made.rows = 20;
  const ecosystem::Ecosystem land = make_land(made);
  for (const std::size_t most : {std::size_t{0}, std::size_t{1'000'000}}) {
    PreviewOptions options;
    options.most_circles = most;
    std::string first;
    for (const int threads : {1, 2, 3, 8}) {
      const base::ThreadLimit limit(threads);
      const std::string svg = svg_of(land, options);
      if (first.empty()) first = svg;
      EXPECT_TRUE(svg == first) << threads << " threads";
    }
  }
}

TEST(Svg, says_the_same_as_the_png) {
  // One layout serves both: every word of the SVG's parts is the layout's, and only the caption may differ.
  const ecosystem::Ecosystem land = make_land({});
  const Document document(svg_of(land));
  std::string legend;
  for (const std::string& text : document.texts("//s:g[@id='legend']/s:text")) legend += text + "|";
  for (std::size_t s = 0; s < 3; ++s) {
    EXPECT_THAT(legend, HasSubstr(land.layers[0].species[s].name));
    EXPECT_THAT(legend, HasSubstr(grouped(recount(land, 0, s, land.extent))));
  }
}

TEST(Svg, stays_small_with_very_many_plants) {
  // Half a million plants, and the bound of 15 MB that five million must keep: hexagons do not grow in number.
  MadeLand made;
  made.columns = 80;
  made.rows = 80;
  made.species = 12;
  const std::string svg = svg_of(make_land(made));
  EXPECT_LT(svg.size(), 15u << 20);
}

}  // namespace
}  // namespace silvasim::exports
