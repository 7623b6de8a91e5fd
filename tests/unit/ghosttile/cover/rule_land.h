// A dialect of rules alone, and XML read by it.
#pragma once

#include "ghosttile/cover/rule_xml.h"
#include "land.h"
#include "silvasim/config/xml.h"

namespace ghosttile::cover::test {

inline const silvasim::config::Dialect& rule_dialect() {
  static const silvasim::config::Dialect dialect = [] {
    silvasim::config::Dialect made;
    made.rules = cover_rules();
    for (auto& rule : property_rules()) made.rules.push_back(std::move(rule));
    return made;
  }();
  return dialect;
}

inline silvasim::config::Node parsed(const std::string& xml, std::vector<silvasim::base::Diagnostic>& errors,
                                     const std::string& root = "Where") {
  auto node = silvasim::config::parse_xml(xml, "rule.xml", rule_dialect(), root, errors);
  EXPECT_TRUE(node) << xml;
  return node ? std::move(*node) : silvasim::config::Node{};
}

// All messages, a line each.
inline std::string text_of(const std::vector<silvasim::base::Diagnostic>& errors) {
  std::string text;
  for (const auto& error : errors) text += silvasim::base::to_string(error) + "\n";
  return text;
}

// One field of values with a hole, one of classes, one without any data policy to speak of.
inline std::shared_ptr<const silvasim::fields::FieldSet> random_fields(Random& random, const Box& extent) {
  auto set = std::make_shared<silvasim::fields::FieldSet>();
  set->frame.extent = extent;
  for (const char* name : {"to_water", "soil", "moisture", "reaction"}) {
    silvasim::fields::Field field;
    field.name = name;
    auto& raster = field.raster;
    raster.columns = 75;
    raster.rows = 60;
    raster.west = extent.west;
    raster.north = extent.north;
    raster.cell_width = 2;
    raster.cell_height = 2;
    for (int i = 0; i < 75 * 60; ++i) {
      const bool hole = field.name != "to_water" && i % 75 > 20 && i % 75 < 40 && i / 75 > 30;
      raster.values.push_back(hole ? std::nanf("") : static_cast<float>(between(random, 0, 10)));
    }
    if (field.name == "soil") {
      field.kind = silvasim::config::FieldKind::class_code;
      for (float& value : raster.values) value = std::floor(value);
    }
    if (field.name == "moisture") field.no_data = silvasim::config::NoDataPolicy::ignore;
    if (field.name == "reaction") {
      field.no_data = silvasim::config::NoDataPolicy::fill;
      field.no_data_fill = 42;
    }
    set->fields.push_back(std::move(field));
  }
  return set;
}

struct TestLand {
  std::shared_ptr<const Plants> plants;
  std::shared_ptr<const silvasim::fields::FieldSet> fields;
  Land land;
};
inline TestLand random_land(Random& random, const LandOptions& options = {}) {
  const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
  const auto fields = random_fields(random, plants->ecosystem().extent);
  return {plants, fields, Land(plants, fields, options)};
}

}  // namespace ghosttile::cover::test
