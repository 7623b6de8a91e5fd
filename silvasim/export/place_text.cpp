#include "silvasim/export/place_text.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "silvasim/base/error.h"
#include "silvasim/export/geographic.h"
#include "silvasim/export/text.h"

namespace silvasim::exports {

std::vector<std::string> place_of(const ecosystem::Ecosystem& ecosystem, const base::Box& box) {
  std::vector<std::string> parts;
  const std::string name = printable(crs_name(ecosystem.crs_wkt));
  // A CRS that nobody can read costs the picture its coordinates, not its existence.
  try {
    const Geographic geographic(ecosystem.crs_wkt, box);
    const base::Point centre = geographic.known()
                                   ? geographic.at({(box.west + box.east) / 2, (box.south + box.north) / 2})
                                   : base::Point{std::nan(""), 0};
    if (std::isfinite(centre.x) && std::isfinite(centre.y)) {
      parts.push_back(fmt::format("{:.4f}° {}, {:.4f}° {}", std::fabs(centre.y), centre.y < 0 ? "S" : "N",
                                  std::fabs(centre.x), centre.x < 0 ? "W" : "E"));
    }
  } catch (const base::Error&) {
  }
  parts.push_back(name);
  parts.push_back(length(box.width()) + " × " + length(box.height()));
  return parts;
}

std::vector<std::string> origin_of(const ecosystem::Ecosystem& ecosystem) {
  const auto json = nlohmann::json::parse(ecosystem.provenance_json, nullptr, false);
  const auto text = [&](const char* key) -> std::string {
    if (!json.is_object() || !json.contains(key)) return {};
    const auto& value = json[key];
    if (value.is_string()) return printable(value.get<std::string>());
    return value.is_number() ? value.dump() : std::string();
  };
  std::vector<std::string> parts;
  parts.push_back(text("version").empty() ? "Silva" : "Silva " + text("version"));
  if (!text("seed").empty()) parts.push_back("seed " + text("seed"));
  return parts;
}

}  // namespace silvasim::exports
