#include "silvasim/export/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "made_land.h"
#include "silvasim/base/error.h"
#include "silvasim/base/random.h"

namespace silvasim::exports {
namespace {

using testing::MadeLand;
using testing::make_land;
using testing::recount;

Layout layout_of(const ecosystem::Ecosystem& land, const PreviewOptions& options) {
  const base::Box box = box_of(land, options);
  return make_layout(land, options, take_census(land, options, box), box, [](const View&) {
    return "A caption that is long enough to need a second line on narrow pictures.";
  });
}

struct Box {
  double left, top, right, bottom;
  std::string what;
};

// Where a text's ink can lie.
Box box_of_text(const Text& text) {
  const double width = width_px(text.text, text.font), up = 0.76 * text.font.size_px, down = 0.2 * text.font.size_px;
  const double before = text.anchor == Anchor::start ? 0 : text.anchor == Anchor::middle ? width / 2 : width;
  if (text.upward) return {text.x - up, text.y + before - width, text.x + down, text.y + before, text.text};
  return {text.x - before, text.y - up, text.x - before + width, text.y + down, text.text};
}

std::vector<Text> texts_of(const Layout& layout, const std::string& part_id = {}) {
  std::vector<Text> texts;
  for (const Part& part : layout.parts) {
    if (!part_id.empty() && part.id != part_id) continue;
    for (const Mark& mark : part.marks) {
      if (const Text* text = std::get_if<Text>(&mark)) texts.push_back(*text);
    }
  }
  return texts;
}

bool overlap(const Box& a, const Box& b) {
  constexpr double slack = 0.5;
  return a.left + slack < b.right && b.left + slack < a.right && a.top + slack < b.bottom && b.top + slack < a.bottom;
}

// No text lies on another, on the map, on a swatch or beyond the page.
void expect_tidy(const Layout& layout, const std::string& when) {
  std::vector<Box> boxes;
  for (const Text& text : texts_of(layout)) boxes.push_back(box_of_text(text));
  const double map_right = layout.map_x + layout.view.width_px, map_bottom = layout.map_y + layout.view.height_px;
  boxes.push_back({double(layout.map_x), double(layout.map_y), map_right, map_bottom, "<map>"});
  for (const Part& part : layout.parts) {
    for (const Mark& mark : part.marks) {
      if (const Circle* c = std::get_if<Circle>(&mark)) {
        boxes.push_back({c->x - c->radius, c->y - c->radius, c->x + c->radius, c->y + c->radius, "<swatch>"});
      }
    }
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_GE(boxes[i].left, 0) << boxes[i].what << ", " << when;
    EXPECT_GE(boxes[i].top, 0) << boxes[i].what << ", " << when;
    EXPECT_LE(boxes[i].right, layout.width_px) << boxes[i].what << ", " << when;
    EXPECT_LE(boxes[i].bottom, layout.height_px) << boxes[i].what << ", " << when;
    for (std::size_t k = i + 1; k < boxes.size(); ++k) {
      EXPECT_FALSE(overlap(boxes[i], boxes[k])) << boxes[i].what << " on " << boxes[k].what << ", " << when;
    }
  }
}

std::string long_name(base::Stream& random) {
  static const char* const syllables[] = {"pi", "ce", "a", "lus", "ni", "gro", "ÄÖ", "sylva", "ti", "ca", "<&>", "🌲"};
  std::string name;
  const std::uint32_t words = 1 + random.next_below(9);
  for (std::uint32_t w = 0; w < words; ++w) {
    if (w > 0) name += ' ';
    const std::uint32_t parts = 1 + random.next_below(w == 0 ? 12 : 4);
    for (std::uint32_t i = 0; i < parts; ++i) name += syllables[random.next_below(12)];
  }
  return name;
}

TEST(Layout, nothing_overlaps_whatever_the_names_numbers_and_shapes) {
  constexpr std::uint64_t seed = 77;
  base::Stream random(seed, base::Purpose::selection);
  for (int round = 0; round < 150; ++round) {
    MadeLand made;
    made.seed = static_cast<std::uint64_t>(round);
    made.sites_per_tile = 5;
    made.columns = 1 + static_cast<int>(random.next_below(12));
    made.rows = 1 + static_cast<int>(random.next_below(12));
    made.species = 1 + static_cast<int>(random.next_below(40));
    made.side_m = 100;
    if (random.next_below(3) == 0) made.crs_wkt = testing::utm_10_north();
    if (random.next_below(3) == 0) made.south_west = {-12.5, -3000000.25};
    ecosystem::Ecosystem land = make_land(made);
    if (random.next_below(3) == 0) add_shrubs(land, made);
    if (random.next_below(2) == 0) {
      for (ecosystem::Layer& layer : land.layers) {
        for (ecosystem::Species& species : layer.species) {
          species.name = long_name(random);
          if (random.next_below(4) > 0) species.common_name = long_name(random);
          if (random.next_below(4) == 0) species.common_name.clear();
        }
        if (random.next_below(2) == 0) layer.name = long_name(random);
      }
      land.name = long_name(random) + long_name(random);
    }
    PreviewOptions options;
    options.width_px = 240 + static_cast<int>(random.next_below(2400));
    const Subject subjects[] = {Subject::species, Subject::probability, Subject::suitability};
    options.subject = subjects[random.next_below(3)];
    const Layout layout = layout_of(land, options);
    expect_tidy(layout, "seed " + std::to_string(seed) + " round " + std::to_string(round) + " width " +
                            std::to_string(options.width_px));
    EXPECT_EQ(layout.width_px, options.width_px);
    if (HasFailure()) return;
  }
}

TEST(Layout, legend_counts_equal_a_recount) {
  MadeLand made;
  ecosystem::Ecosystem land = make_land(made);
  add_shrubs(land, made);
  PreviewOptions options;
  options.bbox =
      base::Box{land.extent.west + 130, land.extent.south + 50, land.extent.west + 420, land.extent.south + 333};
  const auto texts = texts_of(layout_of(land, options), "legend");
  std::uint64_t all = 0;
  for (std::size_t l = 0; l < land.layers.size(); ++l) {
    for (std::size_t s = 0; s < land.layers[l].species.size(); ++s) {
      const std::uint64_t count = recount(land, l, s, *options.bbox);
      all += count;
      const auto name = std::find_if(texts.begin(), texts.end(), [&](const Text& text) {
        return text.text == land.layers[l].species[s].common_name;
      });
      ASSERT_NE(name, texts.end());
      const auto number = std::find_if(texts.begin(), texts.end(), [&](const Text& text) {
        return text.anchor == Anchor::end && text.y == name->y;
      });
      ASSERT_NE(number, texts.end());
      EXPECT_EQ(number->text, grouped(count)) << name->text;
    }
  }
  EXPECT_TRUE(
      std::any_of(texts.begin(), texts.end(), [&](const Text& text) { return text.text == grouped(all) + " plants"; }));
}

TEST(Layout, forty_species_find_room_and_a_hundred_are_summed_up) {
  for (const int species : {40, 250}) {
    MadeLand made;
    made.species = species;
    made.sites_per_tile = 40;
    const ecosystem::Ecosystem land = make_land(made);
    const auto texts = texts_of(layout_of(land, {}), "legend");
    std::uint64_t listed = 0, all = 0;
    int names = 0;
    bool more = false;
    for (const Text& text : texts) {
      names += text.font.italic;
      more = more || text.text.find(" more species") != std::string::npos;
    }
    for (std::size_t s = 0; s < land.layers[0].species.size(); ++s) all += recount(land, 0, s, land.extent);
    // Numbers alone, without the shares and the heading.
    for (const Text& text : texts) {
      if (text.anchor != Anchor::end || text.text.find('%') != std::string::npos) continue;
      std::string digits;
      for (const char c : text.text) {
        if (c >= '0' && c <= '9') digits += c;
      }
      listed += std::stoull(digits);
    }
    EXPECT_EQ(listed, all) << "the entries and the rest add up to all plants";
    EXPECT_EQ(more, species == 250);
    EXPECT_GE(names, 40);
    EXPECT_LE(names, species);
  }
}

TEST(Layout, the_scale_bar_is_as_long_as_it_says) {
  constexpr std::uint64_t seed = 3;
  base::Stream random(seed, base::Purpose::selection);
  for (int round = 0; round < 60; ++round) {
    ecosystem::Ecosystem land = make_land({});
    const double size = std::pow(10.0, -1 + 7 * random.next_double());
    land.extent = {100, 100, 100 + size, 100 + size * (0.3 + random.next_double())};
    const Layout layout = layout_of(land, {});
    const auto part =
        std::find_if(layout.parts.begin(), layout.parts.end(), [](const Part& p) { return p.id == "scale-bar"; });
    ASSERT_NE(part, layout.parts.end());
    double bar_px = 0;
    std::string said;
    for (const Mark& mark : part->marks) {
      if (const Rectangle* box = std::get_if<Rectangle>(&mark)) bar_px += box->width;
      if (const Text* text = std::get_if<Text>(&mark)) said = text->text;
    }
    std::string number;
    for (const char c : said) {
      if ((c >= '0' && c <= '9') || c == '.') number += c;
    }
    const double unit = said.ends_with(" km") ? 1000 : said.ends_with(" cm") ? 0.01 : 1;
    EXPECT_NEAR(bar_px / layout.view.width_px * land.extent.width(), std::stod(number) * unit, size * 1e-9)
        << said << " seed " << seed << " round " << round;
    EXPECT_GT(bar_px, 60) << said;
  }
}

TEST(Layout, ticks_stand_at_the_coordinates_they_name) {
  const ecosystem::Ecosystem land = make_land({});
  const Layout layout = layout_of(land, {});
  int labels = 0;
  for (const Text& text : texts_of(layout, "frame")) {
    std::string digits;
    for (const char c : text.text) {
      if (c >= '0' && c <= '9') digits += c;
    }
    const double value = std::stod(digits);
    const double said = text.upward
                            ? layout.map_y + (land.extent.north - value) / land.extent.height() * layout.view.height_px
                            : layout.map_x + (value - land.extent.west) / land.extent.width() * layout.view.width_px;
    EXPECT_NEAR(text.upward ? text.y : text.x, said, 1e-6);
    ++labels;
  }
  EXPECT_GE(labels, 4);
}

TEST(Layout, says_where_the_land_lies_and_where_the_picture_comes_from) {
  MadeLand made;
  made.crs_wkt = testing::utm_10_north();
  ecosystem::Ecosystem land = make_land(made);
  land.provenance_json = R"({"seed": 18446744073709551615, "version": "9.8.7"})";
  std::string all;
  for (const Text& text : texts_of(layout_of(land, {}))) all += text.text + "|";
  EXPECT_THAT(all, ::testing::HasSubstr("WGS 84 / UTM zone 10N (EPSG:32610)"));
  EXPECT_THAT(all, ::testing::HasSubstr("600 m × 500 m"));
  EXPECT_THAT(all, ::testing::HasSubstr("° N, 121."));
  EXPECT_THAT(all, ::testing::HasSubstr("Silva 9.8.7"));
  EXPECT_THAT(all, ::testing::HasSubstr("seed 18446744073709551615"));

  // Provenance and CRS that nobody can read cost the picture these words only.
  for (const char* const json : {"", "{", "[]", "{\"seed\": {}}", "null"}) {
    land.provenance_json = json;
    EXPECT_NO_THROW(layout_of(land, {})) << json;
  }
  land.crs_wkt = "nonsense";
  EXPECT_NO_THROW(layout_of(land, {}));
}

TEST(Layout, refuses_widths_and_shapes_it_cannot_draw) {
  ecosystem::Ecosystem land = make_land({});
  PreviewOptions options;
  for (const int width : {-5, 0, 100, 20001}) {
    options.width_px = width;
    EXPECT_THROW(layout_of(land, options), base::ConfigError) << width;
  }
  options.decorated = false;
  options.width_px = 15;
  EXPECT_THROW(layout_of(land, options), base::ConfigError);
  options.width_px = 1600;
  land.extent = {0, 0, 1, 1000};
  EXPECT_THROW(layout_of(land, options), base::ConfigError);
  options.decorated = true;
  expect_tidy(layout_of(land, options), "a thousand times as tall as wide");
  land.extent = {0, 0, 1000, 1};
  expect_tidy(layout_of(land, options), "a thousand times as wide as tall");
}

}  // namespace
}  // namespace silvasim::exports
